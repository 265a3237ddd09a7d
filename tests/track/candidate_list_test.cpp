// CandidateList: the events of the boxes themselves, whatever happens while they are enlarged, and what that
// saves.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/executor.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "lab/measure/memory.hpp"
#include "tests/laws/drawn_frames.hpp"
#include "tests/support/rng.hpp"
#include "tests/support/trackers.hpp"

namespace broadside {
namespace {

/// Boxes at rest that tremble, some 4 neighbours each.
class TremblingBoxes {
 public:
  TremblingBoxes(std::size_t count, std::uint64_t seed) : random(seed) {
    for (std::size_t i = 0; i < count; ++i) add();
    tremble();
  }

  void add() {
    rest.push_back(anywhere());
    boxes.push_back(absent_box<2>());
  }

  Box2 anywhere() {
    constexpr int side = 24;
    Box2 box;
    for (int axis = 0; axis < 2; ++axis) {
      // Neighbours that touch at rest meet and part as they tremble.
      box.min[axis] = static_cast<float>(random.whole(0, 2 * side)) / 2;
      box.max[axis] = box.min[axis] + 1;
    }
    return box;
  }

  /// Moves all boxes that are present by up to `part` of their sides.
  void tremble(float part = 0.005F) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      boxes[i] = rest[i];
      if (!is_present(rest[i])) continue;
      for (int axis = 0; axis < 2; ++axis) {
        const float by = random.between(-part, part);
        boxes[i].min[axis] += by;
        boxes[i].max[axis] += by;
      }
    }
  }

  std::vector<BoxId> all() const {
    std::vector<BoxId> ids;
    for (std::size_t i = 0; i < boxes.size(); ++i) ids.push_back(BoxId(i));
    return ids;
  }

  Rng random;
  std::vector<Box2> rest;
  std::vector<Box2> boxes;
};

bool is_enlarged(const std::string& explanation) { return explanation.find("enlarged") != std::string::npos; }

/// A life in which all may happen that a caller can do. Most boxes tremble in all frames.
template <int D, typename Real>
void live(const std::string& spec, std::size_t threads) {
  Rng choices(5);
  Tracker<D, Real> tracker(spec);
  tracker.set_workers({.threads = threads, .executor = standard_executor(), .boxes_per_thread = 1});
  const std::vector<laws::WholeFrame<D, Real>> frames =
      laws::draw_frames<D, Real>(choices, {.frames = 120,
                                           .boxes = 700,
                                           .changes = 20,
                                           .resize_one_in = 30,
                                           .sweep_one_in = 40,
                                           .coordinates = laws::Coordinates::halves,
                                           .trembles = true,
                                           .has_filters = true});
  int enlarged = 0;
  const auto run = [&](const std::function<void()>& update) {
    update();
    enlarged += static_cast<int>(is_enlarged(tracker.explanation()));
    return true;
  };
  EXPECT_EQ((laws::divergence<D, Real>(tracker, frames, run)), "") << spec;
  EXPECT_GT(enlarged, 20) << spec;
}

TEST(CandidateList, TellsTheEventsOfTheBoxesThemselves) {
  for (const std::string spec : {"auto", "grid", "sweep_and_prune", "quadtree", "bvh"}) {
    live<2, float>(spec, 1);
    live<3, float>(spec, 1);
  }
  live<2, double>("auto", 1);
  live<3, double>("auto", 1);
}

TEST(CandidateList, TellsTheSameWithThreads) {
  if (standard_executor() == nullptr) GTEST_SKIP() << "this build has no threads";
  live<2, float>("auto", 4);
}

TEST(CandidateList, TestsLittleMoreThanThePairsOfAPileAtRest) {
  TremblingBoxes world(5000, 3);
  for (Box2& box : world.rest) {  // at random places of their own
    for (int axis = 0; axis < 2; ++axis) {
      box.min[axis] = world.random.between(0, 60);
      box.max[axis] = box.min[axis] + 1;
    }
  }
  Tracker<2> tracker("auto");
  std::int64_t pairs = 0;
  std::optional<Statistics> statistics;
  for (int frame = 0; frame < 20; ++frame) {
    world.tremble();
    PairCounter begun;
    PairCounter ended;
    statistics = tracker.update({world.boxes, world.all()}, begun, ended);
    pairs += static_cast<std::int64_t>(begun.count()) - static_cast<std::int64_t>(ended.count());
  }
  ASSERT_TRUE(is_enlarged(tracker.explanation())) << tracker.explanation();
  EXPECT_LT(statistics->tests, static_cast<std::uint64_t>(pairs) * 2);
  EXPECT_EQ(tracker.box_index(), nullptr) << "an index of enlarged boxes is none of the boxes";
}

TEST(CandidateList, LeavesBoxesAsTheyAreWhereTheyMoveFarOrAreFewOrRest) {
  const auto is_ever_enlarged = [](std::size_t count, float part, std::size_t every) {
    TremblingBoxes world(count, 1);
    Tracker<2> tracker("auto");
    bool is = false;
    for (int frame = 0; frame < 12; ++frame) {
      std::vector<BoxId> changed;
      const std::vector<Box2> before = world.boxes;
      world.tremble(part);
      for (std::size_t i = 0; i < count; ++i) {
        if (i % every == 0)
          changed.push_back(BoxId(i));
        else
          world.boxes[i] = before[i];
      }
      PairCounter none;
      tracker.update({world.boxes, changed}, none, none);
      is |= is_enlarged(tracker.explanation());
    }
    return is;
  };
  EXPECT_TRUE(is_ever_enlarged(2000, 0.005F, 1));
  EXPECT_FALSE(is_ever_enlarged(2000, 0, 1)) << "listed, and at rest";
  EXPECT_FALSE(is_ever_enlarged(2000, 0.1F, 1));
  EXPECT_FALSE(is_ever_enlarged(30, 0.005F, 1));
  EXPECT_FALSE(is_ever_enlarged(2000, 0.005F, 100));
}

/// The second frame moves boxes in some way, or none; the frames after it let all tremble by up to `part` of
/// their sides, until margins have shrunk.
void expect_the_same_events(const std::string& spec, const std::function<void(TremblingBoxes&)>& second,
                            bool is_enlarged_at_once, float part = 0.005F) {
  TremblingBoxes world(1000, 7);
  Tracker<2> tracker(spec);
  Tracker<2> expected("grid:update=follow");
  for (int frame = 0; frame < 100; ++frame) {
    const std::vector<Box2> before = world.boxes;
    if (frame == 1)
      second(world);
    else
      world.tremble(part);
    std::vector<BoxId> changed;
    for (std::size_t i = 0; i < world.boxes.size(); ++i) {
      if (i >= before.size() || before[i] != world.boxes[i]) changed.push_back(BoxId(i));
    }
    EXPECT_EQ(update(tracker, world.boxes, changed), update(expected, world.boxes, changed)) << frame;
    if (frame == 1) {
      EXPECT_EQ(is_enlarged(tracker.explanation()), is_enlarged_at_once);
    }
  }
  EXPECT_TRUE(is_enlarged(tracker.explanation())) << tracker.explanation();
}

TEST(CandidateList, TellsTheSameWhateverTheSecondFrameDoes) {
  for (const std::string spec : {"auto", "sweep_and_prune", "quadtree", "bvh"}) {
    SCOPED_TRACE(spec);
    expect_the_same_events(
        spec, [](TremblingBoxes& world) { world.tremble(0.0005F); }, true, 0.0005F);
    expect_the_same_events(
        spec, [](TremblingBoxes& world) { world.tremble(); }, true);
    expect_the_same_events(
        spec, [](TremblingBoxes& /*world*/) {}, false);
    expect_the_same_events(
        spec, [](TremblingBoxes& world) { world.tremble(0.2F); }, false);
    expect_the_same_events(
        spec, [](TremblingBoxes& world) { world.boxes[3] = world.anywhere(); }, false);
    expect_the_same_events(
        spec,
        [](TremblingBoxes& world) {
          world.tremble();
          for (int i = 0; i < 50; ++i) world.add();
          for (std::size_t i = 1000; i < 1050; ++i) world.boxes[i] = world.rest[i];
          for (std::size_t i = 0; i < 20; ++i) world.boxes[i] = absent_box<2>();
        },
        true);
  }
}

/// Expects that no box changes unlisted, and passes all on to another follower.
class StrictFollower final : public Follower<2> {
 public:
  explicit StrictFollower(std::unique_ptr<Follower<2>> other) : other_(std::move(other)) {}

  std::optional<Statistics> follow(const Change<2>& change, PairSink& begun, PairSink& ended) override {
    boxes_.resize(change.now.size(), absent_box<2>());
    if (change.rebuild) boxes_.assign(change.before.begin(), change.before.end());
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      wrong += static_cast<std::size_t>(change.before[i] != boxes_[i]);
      wrong += static_cast<std::size_t>(change.flags[i] == 0 && change.now[i] != boxes_[i]);
    }
    EXPECT_EQ(wrong, 0U);
    boxes_.assign(change.now.begin(), change.now.end());
    return other_->follow(change, begun, ended);
  }

 private:
  std::unique_ptr<Follower<2>> other_;
  std::vector<Box2> boxes_;
};

TEST(CandidateList, ListsForItsFollowerEachBoxThatChanges) {
  Algorithm strict = *find_algorithm("quadtree");
  for (FollowerChoice<2>& choice : strict.in_2d.followers) {
    choice.make = [make = choice.make](const Settings& settings) {
      return std::make_unique<StrictFollower>(make(settings));
    };
  }
  for (const bool drifts : {false, true}) {
    TremblingBoxes world(1000, 6);
    Tracker<2> tracker(strict, Spec("quadtree"));
    int enlarged = 0;
    for (int frame = 0; frame < 100; ++frame) {
      for (std::size_t i = 0; i < 100 && drifts; ++i) {
        world.rest[i].min[0] += 0.005F;
        world.rest[i].max[0] += 0.005F;
      }
      world.tremble();
      PairCounter none;
      tracker.update({world.boxes, world.all()}, none, none);
      enlarged += static_cast<int>(is_enlarged(tracker.explanation()));
    }
    EXPECT_GT(enlarged, 90);
  }
}

TEST(CandidateList, ForgetsBoxesBehindTheEndOfTheArray) {
  TremblingBoxes world(1000, 8);
  Tracker<2> tracker("auto");
  Tracker<2> expected("grid:update=follow");
  const Ids all = world.all();
  const auto expect_the_same = [&](std::size_t count, std::span<const Filter> filters) {
    world.tremble();
    const Frame<2> frame{std::span(world.boxes).first(count), std::span(all).first(count), filters};
    EXPECT_EQ(update(tracker, frame), update(expected, frame)) << count;
  };
  for (int i = 0; i < 5; ++i) expect_the_same(1000, {});
  ASSERT_TRUE(is_enlarged(tracker.explanation()));
  for (int i = 0; i < 2; ++i) expect_the_same(900, {});
  // The last ones come back, and meet nothing.
  std::vector<Filter> filters(1000);
  for (std::size_t i = 900; i < 1000; ++i) filters[i].mask = 0;
  for (int i = 0; i < 3; ++i) expect_the_same(1000, filters);
}

TEST(CandidateList, MakesNoFrameOfASteadyMotionMuchLongerThanTheOthers) {
  // Tests stand for time. A search makes some 20 to a box, one for each candidate is 3.
  for (const bool drifts : {false, true}) {
    TremblingBoxes world(5000, 12);
    std::vector<Box2> boxes;
    for (std::size_t i = 0; i < 5000; ++i) {
      const float x = world.random.between(0, 60);
      const float y = world.random.between(0, 60);
      boxes.push_back({{x, y}, {x + 1, y + 1}});
    }
    world.rest = boxes;
    Tracker<2> tracker("auto");
    std::vector<std::uint64_t> tests;
    for (int frame = 0; frame < 300; ++frame) {
      for (std::size_t i = 0; i < 5000 && drifts; ++i) {
        const float way = i % 2 == 0 ? 0.002F : -0.002F;
        world.boxes[i].min[0] = boxes[i].min[0] + way * static_cast<float>(frame);
        world.boxes[i].max[0] = world.boxes[i].min[0] + 1;
        world.boxes[i].min[1] = boxes[i].min[1];
        world.boxes[i].max[1] = boxes[i].max[1];
      }
      if (!drifts) world.tremble();
      PairCounter none;
      const auto statistics = tracker.update({world.boxes, world.all()}, none, none);
      if (frame > 0) tests.push_back(statistics->tests);
    }
    const std::uint64_t worst = *std::ranges::max_element(tests);
    const auto median = tests.begin() + 150;
    std::ranges::nth_element(tests, median);
    EXPECT_LE(worst, 4 * *median) << drifts;
  }
}

TEST(CandidateList, DoesNotLetLargeBoxesMeetAllSmallOnesAroundThem) {
  // Small boxes tremble beside large ones on top of each other, which rest.
  TremblingBoxes world(2000, 4);
  for (std::size_t i = 0; i < 50; ++i) world.rest[i] = {{-1000, -500}, {-1, 500}};
  Tracker<2> tracker("auto");
  std::int64_t pairs = 0;
  std::optional<Statistics> statistics;
  for (int frame = 0; frame < 20; ++frame) {
    world.tremble();
    for (std::size_t i = 0; i < 50; ++i) world.boxes[i] = world.rest[i];
    PairCounter begun;
    PairCounter ended;
    statistics = tracker.update({world.boxes, world.all()}, begun, ended);
    pairs += static_cast<std::int64_t>(begun.count()) - static_cast<std::int64_t>(ended.count());
  }
  ASSERT_TRUE(is_enlarged(tracker.explanation())) << tracker.explanation();
  EXPECT_LT(statistics->tests, 2 * (static_cast<std::uint64_t>(pairs) + world.boxes.size()));
}

TEST(CandidateList, EnlargesThinBoxesByTheirThicknessOnly) {
  std::vector<Box2> boxes;
  std::vector<BoxId> all;
  for (int i = 0; i < 2000; ++i) {
    const float x = static_cast<float>(i % 2) * 150;
    const float y = static_cast<float>(i / 2) * 2;
    boxes.push_back({{x, y}, {x + 100, y + 1}});
    all.push_back(BoxId(std::size_t(i)));
  }
  Tracker<2> tracker("auto");
  PairCounter none;
  for (const float way : {0.005F, 0.3F}) {  // little over their length, either way
    for (int frame = 0; frame < 20; ++frame) {
      for (Box2& box : boxes) {
        box.min[1] += way;
        box.max[1] += way;
      }
      const auto statistics = tracker.update({boxes, all}, none, none);
      if (frame < 5) continue;  // it takes some to begin and to stop
      EXPECT_EQ(is_enlarged(tracker.explanation()), way < 0.1F) << way << ", frame " << frame;
      EXPECT_LT(statistics->tests, 20 * boxes.size()) << way << ", frame " << frame;
    }
  }
}

TEST(CandidateList, TriesLessOftenWhereBoxesKeepLeaving) {
  TremblingBoxes world(2000, 9);
  Tracker<2> tracker("auto");
  std::size_t starts = 0;
  bool was = false;
  for (int frame = 0; frame < 600; ++frame) {
    // Quiet for as long as it takes to begin, then wild.
    world.tremble(was ? 0.4F : 0.005F);
    PairCounter none;
    tracker.update({world.boxes, world.all()}, none, none);
    const bool is = is_enlarged(tracker.explanation());
    starts += static_cast<std::size_t>(is && !was);
    was = is;
  }
  EXPECT_GE(starts, 2U);
  EXPECT_LE(starts, 8U);
}

TEST(CandidateList, AllocatesNothingInASteadyState) {
  if (!lab::AllocationMeter().read()) GTEST_SKIP() << "this build does not count allocations";
  TremblingBoxes world(2000, 2);
  Tracker<2> tracker("auto");
  const std::vector<BoxId> all = world.all();
  const auto follow = [&](int frames) {
    for (int frame = 0; frame < frames; ++frame) {
      world.tremble();
      PairCounter none;
      tracker.update({world.boxes, all}, none, none);
    }
  };
  follow(300);  // by then the margins have shrunk
  ASSERT_TRUE(is_enlarged(tracker.explanation()));
  const lab::AllocationMeter meter;
  follow(30);
  EXPECT_EQ(meter.read()->peak, 0);
}

}  // namespace
}  // namespace broadside

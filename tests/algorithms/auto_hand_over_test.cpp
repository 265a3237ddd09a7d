// auto notices that its choice was wrong: searches and trackers that take far more tests than boxes and pairs
// account for are handed over.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "algorithms/auto/auto_thresholds.hpp"
#include "core/sample.hpp"
#include "lab/worst/family.hpp"
#include "tests/support/found.hpp"
#include "tests/support/model.hpp"
#include "tests/support/rng.hpp"

namespace broadside {
namespace {

using Random = Rng;

float uniform(Random& random, float below) { return random.unit() * below; }

Box3 box_at(const std::array<float, 3>& min, const std::array<float, 3>& side) {
  return {min, {min[0] + side[0], min[1] + side[1], min[2] + side[2]}};
}

Box3 small_box(Random& random) {
  return box_at({uniform(random, 1000), uniform(random, 1000), uniform(random, 1000)}, {10, 10, 10});
}

/// A plate of one of two stacks that stand beside each other, one along x and one along y.
Box3 plate(Random& random, std::size_t count) {
  const bool second = random.one_in(2);
  const float thickness = 400 / static_cast<float>(count);
  const float along = uniform(random, 1000);
  const float across = uniform(random, 100);
  const float height = uniform(random, 100);
  if (second) return box_at({1100 + across, along, height}, {900, thickness, 900});
  return box_at({along, across, height}, {thickness, 900, 900});
}

/// A line along one of the three axes.
Box3 line(Random& random) {
  std::array<float, 3> min;
  std::array<float, 3> side{};
  const std::size_t axis = random.below(3);
  for (std::size_t i = 0; i < 3; ++i) min[i] = uniform(random, i == axis ? 100 : 1000);
  side[axis] = 900;
  return box_at(min, side);
}

enum class Kind { uniform, plates, lines, row };

/// One of `count` boxes.
Box3 box_of(Kind kind, std::size_t count, Random& random) {
  switch (kind) {
    case Kind::plates:
      return plate(random, count);
    case Kind::lines:
      return line(random);
    case Kind::row:
      return box_at({uniform(random, 1000), 0, 0}, {1.0F / 64, 1, 1});
    default:
      return small_box(random);
  }
}

std::vector<Box3> boxes_of(Kind kind, std::size_t count, Random& random) {
  std::vector<Box3> boxes(count);
  for (Box3& box : boxes) box = box_of(kind, count, random);
  return boxes;
}

/// Benign boxes where auto and what it chooses look, and others everywhere else. What auto looks at depends
/// on the first places alone, which keep their boxes.
std::vector<Box3> fooling(Kind benign, Kind other, std::size_t count, Random& random) {
  std::vector<Box3> boxes = boxes_of(other, count, random);
  const std::vector<Box3> seen = boxes_of(benign, 1024, random);
  for (std::size_t i = 0; i < seen.size(); ++i) boxes[core::sampled_place(i, count)] = seen[i];
  const std::span<const Box3> all = boxes;
  const std::uint32_t shift = core::sample_shift(all, algorithm::AutoThresholds<3>::hashed_boxes);
  std::vector<std::uint8_t> is_kept(count);
  for (std::size_t i = 0; i < seen.size(); ++i) is_kept[core::sampled_place(i, count)] = 1;
  for (std::size_t i = 0; i < algorithm::AutoThresholds<3>::sampled_boxes; ++i) {
    const std::size_t place = core::sampled_place(i + shift, count);
    if (is_kept[place] == 0) boxes[place] = seen[i];
  }
  return boxes;
}

constexpr std::array<std::pair<Kind, Kind>, 5> deceptions = {{{Kind::uniform, Kind::plates},
                                                              {Kind::uniform, Kind::lines},
                                                              {Kind::row, Kind::plates},
                                                              {Kind::plates, Kind::plates},
                                                              {Kind::lines, Kind::lines}}};

TEST(AutoHandOver, BoundsTheTestsWhateverTheSampleShows) {
  constexpr std::size_t count = 20'000;
  for (const auto& [benign, other] : deceptions) {
    Random random(1);
    std::vector<Box3> boxes = fooling(benign, other, count, random);
    Finder<3> finder("auto");
    for (const bool has_floor : {false, true}) {
      // A box that overlaps all others is one that most of its tests find.
      if (has_floor) boxes[1] = {{-2000, -2000, -2000}, {4000, 4000, 4000}};
      PairCounter pairs;
      const auto statistics = finder.find(boxes, pairs);
      EXPECT_LE(statistics->tests, 600 * count + 64 * pairs.count()) << finder.explanation();
      EXPECT_THAT(finder.explanation(), testing::HasSubstr("gave up"));
    }
  }
}

/// The tests of a search in two stacks of plates side by side, over the number of boxes.
template <int D>
double tests_per_plate(std::size_t count) {
  lab::Random random(6);
  Finder<D, double> finder("auto");
  PairCounter pairs;
  const auto statistics = finder.find(lab::make_family<D>(Spec("plates"), count, random), pairs);
  return static_cast<double>(statistics->tests) / static_cast<double>(count);
}

TEST(AutoHandOver, IsNotNeededForSomeThousandPlates) {
  EXPECT_LE(tests_per_plate<2>(5'000), 30);
  EXPECT_LE(tests_per_plate<2>(10'000), 30);
  EXPECT_LE(tests_per_plate<3>(10'000), 30);
}

TEST(AutoHandOver, FindsEachPairOnce) {
  constexpr std::size_t count = 8'000;
  Finder<3> definition("brute_force");
  for (const auto& [benign, other] : deceptions) {
    Random random(2);
    const std::vector<Box3> boxes = fooling(benign, other, count, random);
    for (const std::size_t left_count : {std::size_t{0}, count / 3}) {
      Finder<3> finder("auto");
      const std::vector<Pair> pairs = laws::found(finder, boxes, left_count);
      EXPECT_THAT(finder.explanation(), testing::HasSubstr("gave up"));
      std::vector<Pair> sorted = pairs;
      std::ranges::sort(sorted);
      std::vector<Pair> expected = laws::found(definition, boxes, left_count);
      std::ranges::sort(expected);
      EXPECT_TRUE(sorted == expected)
          << finder.explanation() << ": " << sorted.size() << " pairs; expected " << expected.size();
      finder.set_workers({.threads = 3, .boxes_per_thread = 100});
      EXPECT_TRUE(laws::found(finder, boxes, left_count) == pairs) << "the order with three threads differs";
    }
  }
}

/// Corners on a lattice, so that many boxes touch.
Box3 on_lattice(Box3 box) {
  for (int axis = 0; axis < 3; ++axis) {
    box.min[axis] = std::floor(box.min[axis] * 4) / 4;
    box.max[axis] = std::ceil(box.max[axis] * 4) / 4;
  }
  return box;
}

TEST(AutoHandOver, FindsEachPairOfDoublesOnceInTheSameOrderOnEachInstructionSet) {
  constexpr std::size_t count = 8'000;
  Finder<3, double> definition("brute_force");
  for (const auto& [benign, other] : deceptions) {
    Random random(3);
    std::size_t handed_over = 0;
    std::vector<DoubleBox3> boxes;
    for (const Box3& box : fooling(benign, other, count, random))
      boxes.push_back(near_double(random, on_lattice(box)));
    for (const std::size_t left_count : {std::size_t{0}, count / 3}) {
      std::vector<Pair> expected = laws::found(definition, boxes, left_count);
      std::ranges::sort(expected);
      std::vector<Pair> first;
      for (const std::string& name : instruction_sets()) {
        const OnInstructionSet chosen(name);
        Finder<3, double> finder("auto");
        std::vector<Pair> pairs = laws::found(finder, boxes, left_count);
        handed_over += finder.explanation().find("gave up") != std::string::npos;
        if (first.empty()) first = pairs;
        EXPECT_TRUE(pairs == first) << "another order with " << name;
        std::ranges::sort(pairs);
        EXPECT_TRUE(pairs == expected) << name << ", " << finder.explanation();
      }
    }
    EXPECT_GT(handed_over, 0U);
  }
}

/// Two trackers of the same boxes, whose events are compared.
template <typename Real = float>
class Followed {
 public:
  explicit Followed(std::vector<Box3> boxes, std::string_view spec = "auto", bool is_checked = true)
      : boxes_(std::move(boxes)), tracker_(spec) {
    for (const Box3& box : boxes_) given_.push_back(given(box));
    if (is_checked) expected_.emplace("brute_force:update=follow");
    update({});
  }

  /// Replaces or shifts boxes, and checks the events.
  template <typename Move>
  void move(std::size_t movers, Random& random, Move move) {
    std::vector<BoxId> changed;
    for (std::size_t i = 0; i < movers; ++i) {
      const std::size_t place = movers == boxes_.size() ? i : random.below(boxes_.size());
      boxes_[place] = move(boxes_[place]);
      given_[place] = given(boxes_[place]);
      changed.push_back(BoxId(place));
    }
    update(changed);
  }

  const Tracker<3, Real>& tracker() const { return tracker_; }

  /// Of the last frame.
  std::uint64_t tests() const { return statistics_->tests; }

 private:
  /// Of doubles, many are apart that touch as floats.
  Box<3, Real> given(const Box3& box) {
    if constexpr (std::is_same_v<Real, float>)
      return on_lattice(box);
    else
      return near_double(random_, on_lattice(box));
  }

  void update(std::span<const BoxId> changed) {
    std::array<std::vector<Pair>, 4> events;
    PairCollector begun(events[0]);
    PairCollector ended(events[1]);
    PairCollector expected_begun(events[2]);
    PairCollector expected_ended(events[3]);
    statistics_ = tracker_.update({given_, changed}, begun, ended);
    if (!expected_) return;
    expected_->update({given_, changed}, expected_begun, expected_ended);
    EXPECT_TRUE(events[0] == events[2]) << tracker_.explanation();
    EXPECT_TRUE(events[1] == events[3]) << tracker_.explanation();
  }

  std::vector<Box3> boxes_;
  std::vector<Box<3, Real>> given_;  // as the trackers see them
  Random random_{5};
  Tracker<3, Real> tracker_;
  std::optional<Tracker<3, Real>> expected_;
  std::optional<Statistics> statistics_;
};

Box3 shifted(Box3 box, Random& random) {
  for (int axis = 0; axis < 3; ++axis) {
    const float side = box.max[axis] - box.min[axis];
    const float by = (uniform(random, 1) - 0.5F) * side;
    box.min[axis] += by;
    box.max[axis] = box.min[axis] + side;
  }
  return box;
}

/// The tests of a frame in which few boxes move, after some others.
template <typename Real>
std::uint64_t tests_of_few_movers(Kind kind, std::string_view spec) {
  constexpr std::size_t count = 30'000;
  Random random(3);
  Followed<Real> followed(boxes_of(kind, count, random), spec, false);
  for (int frame = 0; frame < 10; ++frame)
    followed.move(100, random, [&](const Box3& box) { return shifted(box, random); });
  return followed.tests();
}

TEST(AutoTrackerHandOver, TestsLessThanItsFirstFollowerInPlatesAndLines) {
  for (const Kind kind : {Kind::plates, Kind::lines}) {
    const std::uint64_t tests = tests_of_few_movers<float>(kind, "auto");
    EXPECT_LT(tests, tests_of_few_movers<float>(kind, "grid:update=follow") * 3 / 4);
    EXPECT_LT(tests_of_few_movers<double>(kind, "auto"), 2 * tests) << "doubles";
  }
}

TEST(AutoTrackerHandOver, BoundsTheTestsOfTheFirstFramesWhereOnlyTheMoversAreCrowded) {
  constexpr std::size_t count = 30'000;
  constexpr std::size_t crowded = 3'000;  // few enough that the boxes tried in the first frame say little
  Random random(7);
  std::vector<Box3> boxes = boxes_of(Kind::uniform, count, random);
  std::vector<BoxId> movers;
  for (std::size_t i = 0; i < crowded; ++i) {
    boxes[i] = box_at({500 + uniform(random, 1), 500 + uniform(random, 1), 500 + uniform(random, 1)},
                      {1.0F / 64, 1.0F / 64, 1.0F / 64});
    movers.push_back(BoxId(i));
  }
  const auto events_of = [&](Tracker<3>& tracker, std::span<const BoxId> changed, std::uint64_t& tests) {
    return written_pairs([&](PairSink& events) {
      tests = tracker.update({boxes, changed}, events, events).value_or(Statistics{}).tests;
    });
  };
  Tracker<3> tracker("auto");
  Tracker<3> definition("bvh:update=follow");
  std::uint64_t tests = 0;
  std::uint64_t few_tests = 0;
  EXPECT_TRUE(events_of(tracker, {}, tests) == events_of(definition, {}, few_tests));
  for (const BoxId id : movers) boxes[id] = shifted(boxes[id], random);
  EXPECT_TRUE(events_of(tracker, movers, tests) == events_of(definition, movers, few_tests));
  EXPECT_THAT(tracker.explanation(), testing::HasSubstr("followed by bvh"));
  EXPECT_LT(tests, crowded * crowded * 2 / 3) << "the grid alone makes crowded * crowded tests";
}

template <typename Real>
void miss_no_event_where_boxes_change_their_character() {
  constexpr std::size_t count = 4'000;
  Random random(4);
  Followed<Real> followed(boxes_of(Kind::uniform, count, random));
  std::string followers;
  for (const Kind kind : {Kind::plates, Kind::uniform, Kind::lines, Kind::plates}) {
    followed.move(count, random, [&](const Box3&) { return box_of(kind, count, random); });
    for (int frame = 0; frame < 25; ++frame) {
      followed.move(80, random, [&](const Box3& box) { return shifted(box, random); });
      followers += followed.tracker().explanation() + "\n";
    }
  }
  EXPECT_THAT(followers, testing::HasSubstr("followed by grid"));
  EXPECT_THAT(followers, testing::AnyOf(testing::HasSubstr("followed by quadtree"),
                                        testing::HasSubstr("followed by bvh")));
}

TEST(AutoTrackerHandOver, MissesNoEventWhereBoxesChangeTheirCharacter) {
  miss_no_event_where_boxes_change_their_character<float>();
}

TEST(AutoTrackerHandOver, MissesNoEventWhereBoxesOfDoublesChangeTheirCharacter) {
  miss_no_event_where_boxes_change_their_character<double>();
}

}  // namespace
}  // namespace broadside

// Limits of enlarged boxes: candidates, tests and memory stay within them in every frame, also in the one in
// which boxes would pass them; and how margins are chosen.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/executor.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"
#include "broadside/world.hpp"

#include "lab/measure/memory.hpp"
#include "tests/support/rng.hpp"
#include "track/candidate_list.hpp"

namespace broadside {
namespace {

/// Large boxes that rest on top of each other end at a wall; beyond it stand small ones in a column, some two
/// large ones' pairs to a box. A small box and a large one overlap nowhere, and all do once they are
/// enlarged.
template <typename Real>
class BoxesBesideAWall {
 public:
  explicit BoxesBesideAWall(std::size_t count, double unit = 1) : unit_(unit), gaps(count), boxes(count) {
    while (large * (large - 1) / 2 < 2 * count) ++large;
    for (std::size_t i = 0; i < count; ++i) {
      gaps[i] = random.between(0.06F, 0.08F);
      if (i >= large) changed.push_back(BoxId(i));
    }
    move([](std::size_t) { return 0; });
  }

  /// Moves each small box to its gap and `by(i)` from the wall, all in parts of its side.
  template <typename By>
  void move(By by) {
    const auto height = static_cast<double>(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const auto at = static_cast<double>(i);
      if (i < large)
        boxes[i] = box(-100 - at, -1, 0, 1.5 * height);
      else
        boxes[i] = box(gaps[i] + by(i), 1.5 * at, gaps[i] + by(i) + 1, 1.5 * at + 1);
    }
  }
  void tremble() {
    move([this](std::size_t) { return random.between(-0.003F, 0.003F); });
  }

  Box<2, Real> box(double left, double bottom, double right, double top) const {
    return {{static_cast<Real>(unit_ * left), static_cast<Real>(unit_ * bottom)},
            {static_cast<Real>(unit_ * right), static_cast<Real>(unit_ * top)}};
  }

 private:
  double unit_;

 public:
  Rng random{1};
  std::size_t large = 1;
  std::vector<double> gaps;
  std::vector<Box<2, Real>> boxes;
  std::vector<BoxId> changed;
};

bool mentions_enlarged(const std::string& explanation) {
  return explanation.find("enlarged") != std::string::npos;
}

/// What the frames of a tracker took at most.
struct Most {
  std::uint64_t tests = 0;     // in a frame
  std::size_t bytes = 0;       // that are kept
  std::int64_t allocated = 0;  // in a frame, above what is kept; 0 where that is not counted
  std::size_t enlarged = 0;    // frames
  std::uint64_t last_tests = 0;
  std::size_t last_bytes = 0;
};

/// A frame of both; the events must be the same.
template <typename Real>
void follow(Tracker<2, Real>& tracker, Tracker<2, Real>& expected, const Frame<2, Real>& frame, Most& most) {
  PairHasher begun;
  PairHasher ended;
  std::optional<Statistics> statistics;
  {
    const lab::AllocationMeter meter;
    statistics = tracker.update(frame, begun, ended);
    if (const auto allocation = meter.read()) most.allocated = std::max(most.allocated, allocation->peak);
  }
  PairHasher expected_begun;
  PairHasher expected_ended;
  expected.update(frame, expected_begun, expected_ended);
  ASSERT_EQ(begun.hash(), expected_begun.hash());
  ASSERT_EQ(ended.hash(), expected_ended.hash());
  most.tests = std::max(most.tests, statistics->tests);
  most.last_tests = statistics->tests;
  most.bytes = std::max(most.bytes, tracker.bytes());
  most.last_bytes = tracker.bytes();
  most.enlarged += static_cast<std::size_t>(mentions_enlarged(tracker.explanation()));
}

constexpr std::size_t boxes_beside_the_wall = 8000;

/// Several threads are allowed more: how many of their pairs wait for each other depends on how the threads
/// are scheduled.
std::int64_t allowed_bytes(std::size_t per_box) {
  return static_cast<std::int64_t>(per_box * boxes_beside_the_wall);
}

template <typename Real>
void tremble_beside_a_wall(const std::string& spec, std::size_t threads, double unit = 1) {
  SCOPED_TRACE(spec + ", " + std::to_string(threads) + " threads");
  BoxesBesideAWall<Real> wall(boxes_beside_the_wall, unit);
  Tracker<2, Real> tracker(spec);
  tracker.set_workers({.threads = threads, .executor = nullptr, .boxes_per_thread = 1});
  Tracker<2, Real> expected("grid:update=follow");
  Most first;  // frames in which nothing is tried yet
  Most most;
  for (int frame = 0; frame < 8; ++frame) {
    wall.tremble();
    follow<Real>(tracker, expected, {wall.boxes, wall.changed}, frame < 2 ? first : most);
  }
  EXPECT_EQ(most.enlarged, 0U);
  EXPECT_LT(most.tests, 2 * first.tests + 64 * wall.boxes.size());
  EXPECT_LT(most.allocated, allowed_bytes(threads > 1 ? 3000 : 1000));
  EXPECT_LT(most.last_bytes, first.bytes + 100 * wall.boxes.size()) << "not given back";
}

TEST(CandidateLimits, AreTestedWhileCandidatesAreFound) {
  for (const std::string spec : {"auto", "grid", "quadtree", "bvh", "sweep_and_prune"})
    tremble_beside_a_wall<float>(spec, 1);
  tremble_beside_a_wall<double>("auto", 1);
  tremble_beside_a_wall<float>("auto", 1, 1e-30);
  tremble_beside_a_wall<double>("auto", 1, 1e200);
  if (standard_executor() != nullptr) tremble_beside_a_wall<float>("auto", 4);
}

template <typename Real>
void approach_a_wall(const std::string& spec, std::size_t threads, bool at_once) {
  SCOPED_TRACE(spec + ", " + std::to_string(threads) + " threads");
  BoxesBesideAWall<Real> wall(boxes_beside_the_wall);
  for (double& gap : wall.gaps) gap = at_once ? 0.6 : wall.random.between(0.5F, 0.9F);
  Tracker<2, Real> tracker(spec);
  tracker.set_workers({.threads = threads, .executor = nullptr, .boxes_per_thread = 1});
  Tracker<2, Real> expected("grid:update=follow");
  Most first;
  Most most;
  for (int frame = 0; frame < 110; ++frame) {
    wall.move([&](std::size_t i) { return -std::min(0.004 * frame, wall.gaps[i] - 0.01); });
    follow<Real>(tracker, expected, {wall.boxes, wall.changed}, frame < 2 ? first : most);
  }
  EXPECT_GT(most.enlarged, 10U);
  EXPECT_LT(most.enlarged, 105U);
  // Where boxes touch the wall, `quadtree` makes 170 tests a box, enlarged or not.
  EXPECT_LT(most.tests, 2 * first.tests + 192 * wall.boxes.size());
  EXPECT_LT(most.allocated, allowed_bytes(threads > 1 ? 3000 : 1500));
  EXPECT_LT(most.bytes, first.bytes + 1500 * wall.boxes.size());
  EXPECT_LT(most.last_bytes, first.bytes + 100 * wall.boxes.size()) << "not given back";
}

TEST(CandidateLimits, HoldInEveryFrameAfterwards) {
  for (const std::string spec : {"auto", "grid", "quadtree", "bvh", "sweep_and_prune"}) {
    approach_a_wall<float>(spec, 1, false);
    approach_a_wall<float>(spec, 1, true);
  }
  approach_a_wall<double>("auto", 1, false);
  if (standard_executor() != nullptr) approach_a_wall<float>("auto", 4, true);
}

TEST(CandidateLimits, AreTriedLessAndLessOften) {
  BoxesBesideAWall<float> wall(600);
  Tracker<2> tracker("auto");
  std::vector<std::uint64_t> tests;
  for (int frame = 0; frame < 7000; ++frame) {
    wall.tremble();
    PairCounter none;
    const auto statistics = tracker.update({wall.boxes, wall.changed}, none, none);
    ASSERT_FALSE(mentions_enlarged(tracker.explanation())) << frame;
    if (frame > 0) tests.push_back(statistics->tests);
  }
  std::vector<std::uint64_t> sorted = tests;
  std::ranges::sort(sorted);
  const std::uint64_t usual = sorted[sorted.size() / 2];
  const auto tries = std::ranges::count_if(tests, [&](std::uint64_t count) { return count > usual + 5000; });
  EXPECT_GE(tries, 2);
  EXPECT_LE(tries, 6);
}

TEST(CandidateLimits, CountNoCandidatesThatFiltersRefuse) {
  // As beside the wall, and nothing large meets anything small.
  BoxesBesideAWall<float> wall(boxes_beside_the_wall);
  std::vector<Filter> filters(wall.boxes.size());
  for (std::size_t i = 0; i < filters.size(); ++i) {
    filters[i].category = i < wall.large ? 1 : 2;
    filters[i].mask = i < wall.large ? 1 : 2;
  }
  Tracker<2> tracker("auto");
  Tracker<2> expected("grid:update=follow");
  Most most;
  for (int frame = 0; frame < 40; ++frame) {
    wall.tremble();
    follow<float>(tracker, expected, {wall.boxes, wall.changed, filters}, most);
  }
  EXPECT_GT(most.enlarged, 30U);
  EXPECT_LT(most.last_tests, 8 * wall.boxes.size());
  EXPECT_LT(most.bytes, 1000 * wall.boxes.size());
}

/// Boxes of these sides, each moved along x by its part of them.
template <typename Real>
struct Moved {
  void add(std::size_t count, Real side, Real part) {
    for (std::size_t i = 0; i < count; ++i) {
      changed.push_back(BoxId(before.size()));
      before.push_back({{0, 0}, {side, side}});
      now.push_back({{side * part, 0}, {side + side * part, side}});
    }
  }
  std::optional<core::Margins<2, Real>> margins() const {
    const std::vector<std::uint8_t> flags(now.size(), 1);
    return track::StaggeredMargins<2, Real>::suiting({before, now, changed, flags});
  }
  Real margin_of(const core::Margins<2, Real>& margins, Real side) const {
    return -margins.enlarged({{0, 0}, {side, side}}, nullptr).min[0];
  }

  std::vector<Box<2, Real>> before;
  std::vector<Box<2, Real>> now;
  std::vector<BoxId> changed;
};

template <typename Real>
void expect_margins() {
  {
    // A fifth moves fast for its size, and a quarter far: no box is both. Three quarters stay within margins.
    Moved<Real> moved;
    for (int i = 0; i < 100; ++i) {
      moved.add(4, Real(0.1), Real(0.05));
      moved.add(5, 1000, Real(0.005));
      moved.add(11, 1, Real(0.005));
    }
    const auto margins = moved.margins();
    ASSERT_TRUE(margins);
    for (const Real side : {Real(1), Real(1000)}) {
      EXPECT_GE(moved.margin_of(*margins, side), 20 * Real(0.005) * side) << side;
      EXPECT_LE(moved.margin_of(*margins, side), Real(0.21) * side) << side;
    }
  }
  {
    // Large boxes at rest have no more than what small ones move, at any scale at which these have a number.
    for (const Real unit :
         {std::numeric_limits<Real>::min() * 1024, Real(1), std::numeric_limits<Real>::max() / Real(1e7)}) {
      Moved<Real> moved;
      moved.add(1000, unit, Real(0.005));
      const auto margins = moved.margins();
      ASSERT_TRUE(margins) << unit;
      EXPECT_LE(moved.margin_of(*margins, 1000 * unit) / unit, Real(0.5)) << unit;
      EXPECT_GE(moved.margin_of(*margins, unit) / unit, Real(0.1)) << unit;
    }
  }
  {
    // A displacement that is nearly nothing of a side is no reason for margins without a limit.
    Moved<Real> moved;
    moved.add(1000, 1, std::numeric_limits<Real>::denorm_min());
    if (const auto margins = moved.margins()) {
      EXPECT_LT(moved.margin_of(*margins, Real(1e9)), Real(1e-3));
    }
  }
  {
    Moved<Real> resting;
    resting.add(1000, 1, 0);
    EXPECT_FALSE(resting.margins());
    Moved<Real> points;
    points.add(1000, 0, 0);
    EXPECT_FALSE(points.margins()) << "0 / 0";
    Moved<Real> infinite;
    infinite.add(1000, std::numeric_limits<Real>::infinity(), Real(0.005));
    EXPECT_FALSE(infinite.margins());
  }
}

template <typename Real>
void expect_guessed_margins() {
  Moved<Real> mixed;  // some large boxes among small ones
  mixed.add(900, 1, 0);
  mixed.add(100, 1000, 0);
  const auto margins = track::StaggeredMargins<2, Real>::guessed(mixed.now);
  ASSERT_TRUE(margins);
  EXPECT_GE(mixed.margin_of(*margins, 1), Real(0.1));
  EXPECT_LE(mixed.margin_of(*margins, 1), Real(0.3));
  EXPECT_LE(mixed.margin_of(*margins, 1000), Real(0.3)) << "of small boxes, not of large ones";
  std::vector<Box<2, Real>> enlarged(mixed.now.size());
  track::StaggeredMargins<2, Real>(*margins).enlarge_all(mixed.now, enlarged);
  Real least = 1;
  Real most = 0;
  for (std::size_t i = 0; i < enlarged.size(); ++i) {
    const Real margin = mixed.now[i].min[0] - enlarged[i].min[0];
    least = std::min(least, margin);
    most = std::max(most, margin);
  }
  EXPECT_GT(least, 0);
  EXPECT_GT(most, 4 * least) << "boxes that move alike must not leave in one frame";
  EXPECT_LE(most, Real(0.3));
  for (const Real side : {Real(0), std::numeric_limits<Real>::infinity()}) {
    Moved<Real> boxes;
    boxes.add(1000, side, 0);
    EXPECT_FALSE((track::StaggeredMargins<2, Real>::guessed(boxes.now))) << side;
  }
  EXPECT_FALSE(
      (track::StaggeredMargins<2, Real>::guessed(std::vector<Box<2, Real>>(1000, absent_box<2, Real>()))));
}

TEST(MarginsFor, AreGuessedFromTheSizeOfMostBoxes) {
  expect_guessed_margins<float>();
  expect_guessed_margins<double>();
}

TEST(MarginsFor, CoverTheSameBoxesByBothLimits) { expect_margins<float>(); }

TEST(MarginsFor, DoSoForBoxesOfDoubles) { expect_margins<double>(); }

TEST(Margins, ALimitThatRoundsToZeroIsOne) {
  // As floats, 1e-60 is 0: neither margin may then be taken for one that was not given.
  for (const auto& [margin, relative] : {std::pair{1e-60, 0.5}, std::pair{5.0, 1e-60}}) {
    World2 world(
        WorldOptions{.margin = margin, .relative_margin = relative, .events = WorldEvents::enlarged});
    world.add({{0, 0}, {10, 10}});
    world.add({{11, 0}, {20, 10}});
    EXPECT_TRUE(world.update().begun.empty()) << margin << ", " << relative;
  }
  World<2, double> world(
      WorldOptions{.margin = 1e-60, .relative_margin = 0.5, .events = WorldEvents::enlarged});
  world.add({{0, 0}, {10, 10}});
  world.add({{11, 0}, {20, 10}});
  EXPECT_TRUE(world.update().begun.empty());
}

}  // namespace
}  // namespace broadside

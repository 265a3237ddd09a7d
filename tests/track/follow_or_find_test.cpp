// FollowOrFind: what an update costs a structure that stays from frame to frame, what it keeps, and when it
// is used.
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "lab/measure/memory.hpp"

namespace broadside {
namespace {

using testing::StartsWith;

const std::vector<std::string> following = {"brute_force:update=follow", "grid:update=follow",
                                            "sweep_and_prune:update=follow", "quadtree:update=follow",
                                            "bvh:update=follow"};

/// Unit boxes in a square that has room for four times as many.
std::vector<Box2> scattered(std::size_t count) {
  std::mt19937 random(7);
  float side = 1;
  while (side * side < 4 * static_cast<float>(count)) side *= 2;
  std::vector<Box2> boxes(count);
  for (Box2& box : boxes) {
    for (int axis = 0; axis < 2; ++axis) {
      box.min[axis] = static_cast<float>(random() % 4096) * side / 4096;
      box.max[axis] = box.min[axis] + 1;
    }
  }
  return boxes;
}

void shift(Box2& box, float by) {
  box.min[0] += by;
  box.max[0] += by;
}

std::vector<BoxId> every_place(std::size_t count, std::size_t step) {
  std::vector<BoxId> ids;
  for (std::size_t i = 0; i < count; i += step) ids.push_back(BoxId(i));
  return ids;
}

/// What an update reports and does.
struct Updated {
  std::uint64_t events;
  Statistics statistics;
};

Updated take(Tracker<2>& tracker, const std::vector<Box2>& boxes, const std::vector<BoxId>& changed) {
  PairCounter events;
  const std::optional<Statistics> statistics = tracker.update({boxes, changed}, events, events);
  EXPECT_TRUE(statistics);
  return {events.count(), statistics.value_or(Statistics{})};
}

TEST(FollowOrFind, ComparesAMoverWithItsNeighbourhoodOnly) {
  for (const std::string spec : {"grid", "sweep_and_prune", "quadtree", "bvh"}) {
    Tracker<2> tracker(spec);
    std::vector<Box2> boxes = scattered(20'000);
    Updated updated = take(tracker, boxes, {});
    for (int frame = 0; frame < 4; ++frame) {
      shift(boxes[77], 0.25F);
      updated = take(tracker, boxes, {BoxId(77)});
    }
    // Of a sweep, those that touch it on one axis: a window of the square's root.
    EXPECT_LE(updated.statistics.tests, spec != "sweep_and_prune" ? 200U : 1500U) << spec;
    EXPECT_GE(updated.statistics.tests, 1U) << spec;
  }
}

TEST(FollowOrFind, TakesItsFirstBoxesWithoutComparingAllOfThem) {
  Tracker<2> tracker("quadtree:update=follow");
  const std::vector<Box2> boxes = scattered(20'000);
  const Updated updated = take(tracker, boxes, {});
  EXPECT_GT(updated.events, 1'000U);
  EXPECT_LE(updated.statistics.tests, 500 * boxes.size());
}

TEST(FollowOrFind, AllocatesNothingInASteadyState) {
  if (!lab::AllocationMeter().read()) GTEST_SKIP() << "this build does not count allocations";
  for (const std::string& spec : following) {
    Tracker<2> tracker(spec);
    std::vector<Box2> boxes = scattered(2000);
    const std::vector<BoxId> changed = every_place(boxes.size(), 10);
    const auto follow = [&](int frames) {
      for (int frame = 0; frame < frames; ++frame) {
        const float by = frame % 8 < 4 ? 0.25F : -0.25F;
        for (const BoxId id : changed) shift(boxes[index(id)], by);
        take(tracker, boxes, changed);
      }
    };
    take(tracker, boxes, {});
    follow(16);
    const lab::AllocationMeter meter;
    follow(16);
    EXPECT_EQ(meter.read()->peak, 0) << spec;
  }
}

TEST(FollowOrFind, GivesMemoryBackWhenBoxesHaveGone) {
  Tracker<2> tracker("grid:update=follow");
  std::vector<Box2> boxes = scattered(20'000);
  const std::uint64_t cells = take(tracker, boxes, {}).statistics.cells;
  boxes.resize(100);
  take(tracker, boxes, {});
  EXPECT_LT(take(tracker, boxes, {BoxId(0)}).statistics.cells, cells / 2);
}

TEST(FollowOrFind, DoesNotGrowWhileEverythingDriftsFarAway) {
  for (const std::string& spec : following) {
    Tracker<2> tracker(spec);
    std::vector<Box2> boxes = scattered(500);
    const std::vector<BoxId> changed = every_place(boxes.size(), 1);
    take(tracker, boxes, {});
    std::uint64_t tests = 0;
    std::uint64_t last_tests = 0;
    std::size_t bytes = 0;
    for (int frame = 0; frame < 200; ++frame) {
      for (Box2& box : boxes) shift(box, 16);
      last_tests = take(tracker, boxes, changed).statistics.tests;
      if (frame == 10) {
        tests = last_tests;
        bytes = tracker.bytes();
      }
    }
    EXPECT_LE(last_tests, 2 * tests) << spec;
    EXPECT_LE(tracker.bytes(), bytes + bytes / 4) << spec;
  }
}

TEST(FollowOrFind, FollowsFewChangesAndFindsAllPairsAnewWhereMostChange) {
  for (const std::string spec : {"brute_force", "grid", "sweep_and_prune", "quadtree", "bvh"}) {
    Tracker<2> tracker(spec);
    std::vector<Box2> boxes = scattered(2000);
    take(tracker, boxes, {});
    EXPECT_THAT(tracker.explanation(), StartsWith("all pairs found anew")) << spec;
    shift(boxes[3], 1);
    take(tracker, boxes, {BoxId(3)});
    EXPECT_THAT(tracker.explanation(), StartsWith("followed by " + spec)) << spec;
    for (Box2& box : boxes) shift(box, 1);
    take(tracker, boxes, every_place(boxes.size(), 1));
    EXPECT_THAT(tracker.explanation(), StartsWith("all pairs found anew")) << spec;
  }
}

TEST(FollowOrFind, OffersItsFollowersIndexWhileItFollows) {
  for (const bool has_index : {false, true}) {
    Tracker<2> tracker(has_index ? "bvh" : "grid");
    std::vector<Box2> boxes = scattered(2000);
    take(tracker, boxes, {});
    EXPECT_EQ(tracker.box_index(), nullptr) << "all pairs found anew";
    shift(boxes[3], 1);
    take(tracker, boxes, {BoxId(3)});
    EXPECT_EQ(tracker.box_index() != nullptr, has_index);
    for (Box2& box : boxes) shift(box, 1);
    take(tracker, boxes, every_place(boxes.size(), 1));
    EXPECT_EQ(tracker.box_index(), nullptr) << "all pairs found anew";
  }
}

/// Boxes that all overlap each other and tremble: auto compares all of them, as brute_force does, where a
/// grid would look again at each pair in each frame.
TEST(FollowOrFind, ComparesAllWhereEveryBoxOverlapsEveryOther) {
  for (const float step : {0.001F, 0.2F}) {
    std::mt19937 random(1);
    std::vector<Box2> boxes(1500, Box2{{0, 0}, {1, 1}});
    const std::vector<BoxId> all = every_place(boxes.size(), 1);
    Tracker<2> tracker("auto");
    take(tracker, boxes, {});
    for (int frame = 0; frame < 8; ++frame) {
      for (Box2& box : boxes) {
        const float at = static_cast<float>(random() % 1024) / 1024 * step;
        box = {{at, -at}, {at + 1, 1 - at}};
      }
      const Updated updated = take(tracker, boxes, all);
      EXPECT_THAT(tracker.explanation(), StartsWith("followed by brute_force")) << step << ", " << frame;
      EXPECT_LE(updated.statistics.tests, boxes.size() * boxes.size());
    }
  }
}

TEST(FollowOrFind, FollowsInCellsWhereFewBoxesMove) {
  Tracker<2> tracker("auto");
  std::vector<Box2> boxes = scattered(5000);
  take(tracker, boxes, {});
  for (int frame = 0; frame < 8; ++frame) {
    shift(boxes[3], 0.25F);
    take(tracker, boxes, {BoxId(3)});
    EXPECT_THAT(tracker.explanation(), StartsWith("followed by grid"));
  }
}

}  // namespace
}  // namespace broadside

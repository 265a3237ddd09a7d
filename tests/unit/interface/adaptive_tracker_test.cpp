// Trackers that keep a structure from frame to frame: what an update costs them, and what they keep.
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/sinks.hpp"

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

std::uint64_t count_events(PairTracker<2>& tracker, const std::vector<Box2>& boxes,
                           const std::vector<BoxId>& changed) {
  PairCounter events;
  tracker.update({boxes, changed}, events, events);
  return events.count();
}

TEST(AdaptiveTracker, ComparesAMoverWithItsNeighbourhoodOnly) {
  for (const std::string spec : {"grid", "sweep_and_prune", "quadtree", "bvh"}) {
    const auto tracker = make_tracker<2>(spec);
    std::vector<Box2> boxes = scattered(20'000);
    count_events(*tracker, boxes, {});
    for (int frame = 0; frame < 4; ++frame) {
      shift(boxes[77], 0.25F);
      count_events(*tracker, boxes, {BoxId(77)});
    }
    ASSERT_TRUE(tracker->statistics()) << spec;
    // Of a sweep, those that touch it on one axis: a window of the square's root.
    EXPECT_LE(tracker->statistics()->tests, spec != "sweep_and_prune" ? 200U : 1500U) << spec;
    EXPECT_GE(tracker->statistics()->tests, 1U) << spec;
  }
}

TEST(AdaptiveTracker, TakesItsFirstBoxesWithoutComparingAllOfThem) {
  const auto tracker = make_tracker<2>("quadtree:update=follow");
  const std::vector<Box2> boxes = scattered(20'000);
  EXPECT_GT(count_events(*tracker, boxes, {}), 1'000U);
  ASSERT_TRUE(tracker->statistics());
  EXPECT_LE(tracker->statistics()->tests, 500 * boxes.size());
}

TEST(AdaptiveTracker, AllocatesNothingInASteadyState) {
  if (!lab::AllocationMeter().read()) GTEST_SKIP() << "this build does not count allocations";
  for (const std::string& spec : following) {
    const auto tracker = make_tracker<2>(spec);
    std::vector<Box2> boxes = scattered(2000);
    const std::vector<BoxId> changed = every_place(boxes.size(), 10);
    const auto follow = [&](int frames) {
      for (int frame = 0; frame < frames; ++frame) {
        const float by = frame % 8 < 4 ? 0.25F : -0.25F;
        for (const BoxId id : changed) shift(boxes[index(id)], by);
        count_events(*tracker, boxes, changed);
      }
    };
    count_events(*tracker, boxes, {});
    follow(16);
    const lab::AllocationMeter meter;
    follow(16);
    EXPECT_EQ(meter.read()->peak, 0) << spec;
  }
}

TEST(AdaptiveTracker, GivesMemoryBackWhenBoxesHaveGone) {
  const auto tracker = make_tracker<2>("grid:update=follow");
  std::vector<Box2> boxes = scattered(20'000);
  count_events(*tracker, boxes, {});
  const std::uint64_t cells = tracker->statistics()->cells;
  boxes.resize(100);
  count_events(*tracker, boxes, {});
  count_events(*tracker, boxes, {BoxId(0)});
  EXPECT_LT(tracker->statistics()->cells, cells / 2);
}

TEST(AdaptiveTracker, DoesNotGrowWhileEverythingDriftsFarAway) {
  for (const std::string& spec : following) {
    const auto tracker = make_tracker<2>(spec);
    std::vector<Box2> boxes = scattered(500);
    const std::vector<BoxId> changed = every_place(boxes.size(), 1);
    count_events(*tracker, boxes, {});
    std::uint64_t tests = 0;
    std::size_t bytes = 0;
    for (int frame = 0; frame < 200; ++frame) {
      for (Box2& box : boxes) shift(box, 16);
      count_events(*tracker, boxes, changed);
      if (frame == 10) {
        tests = tracker->statistics()->tests;
        bytes = tracker->bytes();
      }
    }
    EXPECT_LE(tracker->statistics()->tests, 2 * tests) << spec;
    EXPECT_LE(tracker->bytes(), bytes + bytes / 4) << spec;
  }
}

TEST(AdaptiveTracker, FollowsFewChangesAndFindsAllPairsAnewWhereMostChange) {
  for (const std::string spec : {"brute_force", "grid", "sweep_and_prune", "quadtree", "bvh"}) {
    const auto tracker = make_tracker<2>(spec);
    std::vector<Box2> boxes = scattered(2000);
    count_events(*tracker, boxes, {});
    EXPECT_THAT(tracker->explanation(), StartsWith("all pairs found anew")) << spec;
    shift(boxes[3], 1);
    count_events(*tracker, boxes, {BoxId(3)});
    EXPECT_THAT(tracker->explanation(), StartsWith("followed by " + spec)) << spec;
    for (Box2& box : boxes) shift(box, 1);
    count_events(*tracker, boxes, every_place(boxes.size(), 1));
    EXPECT_THAT(tracker->explanation(), StartsWith("all pairs found anew")) << spec;
  }
}

TEST(AdaptiveTracker, OffersItsFollowersIndexWhileItFollows) {
  for (const bool has_index : {false, true}) {
    const auto tracker = make_tracker<2>(has_index ? "bvh" : "grid");
    std::vector<Box2> boxes = scattered(2000);
    count_events(*tracker, boxes, {});
    EXPECT_EQ(tracker->box_index(), nullptr) << "all pairs found anew";
    shift(boxes[3], 1);
    count_events(*tracker, boxes, {BoxId(3)});
    EXPECT_EQ(tracker->box_index() != nullptr, has_index);
    for (Box2& box : boxes) shift(box, 1);
    count_events(*tracker, boxes, every_place(boxes.size(), 1));
    EXPECT_EQ(tracker->box_index(), nullptr) << "all pairs found anew";
  }
}

}  // namespace
}  // namespace broadside

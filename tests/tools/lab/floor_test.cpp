// The floor: that its work is done, and when it is timed.
#include "lab/measure/floor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/measure/compare.hpp"
#include "tests/support/boxes.hpp"

namespace broadside::lab {
namespace {

using testing::Each;
using testing::Gt;
using testing::IsEmpty;

Box2 begins_at(float x, float y) { return {{x, y}, {x + 1, y + 2}}; }

/// Boxes in an order that has nothing to do with their places; not whole blocks, and several stripes.
template <int D>
std::vector<Box<D>> many() {
  std::vector<Box<D>> boxes(20'001);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      boxes[i].min[axis] = static_cast<float>(i * 7'919 % 10'007 + axis);
      boxes[i].max[axis] = boxes[i].min[axis] + static_cast<float>(i);
    }
  }
  return boxes;
}

/// Each box is moved once, with its index, behind all that begin in a stripe before its own.
template <int D>
void expect_moved(const Floor<D>& floor, const std::vector<Box<D>>& boxes) {
  const auto moved = floor.moved();
  ASSERT_EQ(moved.size(), boxes.size());
  std::vector<bool> seen(boxes.size());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    ASSERT_LT(moved[i].index, boxes.size());
    ASSERT_FALSE(seen[moved[i].index]);
    seen[moved[i].index] = true;
    ASSERT_EQ(moved[i].box, boxes[moved[i].index]);
    if (i == 0) continue;
    ASSERT_LE(moved[i - 1].stripe, moved[i].stripe);
    if (moved[i - 1].stripe == moved[i].stripe)
      ASSERT_LT(moved[i - 1].index, moved[i].index);
    else
      ASSERT_LT(moved[i - 1].box.min[0], moved[i].box.min[0]);
  }
}

template <int D>
void expect_all_moved() {
  Floor<D> floor;
  for (const Stores stores : {Stores::plain, Stores::streamed}) {
    const std::vector<Box<D>> boxes = many<D>();
    floor.run(boxes, {}, stores);
    expect_moved(floor, boxes);
    EXPECT_GT(floor.moved().back().stripe, 3u);
    // In memory that held others.
    const std::vector<Box<D>> few(boxes.begin(), boxes.begin() + 17);
    floor.run(few, {}, stores);
    expect_moved(floor, few);
  }
}

TEST(Floor, MovesEachBoxIntoItsStripe) {
  expect_all_moved<2>();
  expect_all_moved<3>();
}

TEST(Floor, TakesBoxesAtInfinityAndAbsentOnes) {
  std::vector<Box2> boxes = many<2>();
  boxes[3] = absent_box<2>();
  boxes[5] = begins_at(-infinity, 0);
  boxes[7] = begins_at(infinity, 0);
  boxes[9] = begins_at(1e30F, 0);
  Floor<2> floor;
  floor.run(boxes, {}, Stores::streamed);
  expect_moved(floor, boxes);
  const std::vector<Box2> all_at_infinity(5'000, begins_at(infinity, 0));
  floor.run(all_at_infinity, {}, Stores::streamed);
  expect_moved(floor, all_at_infinity);
}

TEST(Floor, WritesEachPair) {
  constexpr Pair unwritten{BoxId{777}, BoxId{777}};
  for (const Stores stores : {Stores::plain, Stores::streamed}) {
    std::vector<Pair> pairs(300, unwritten);
    Floor<2>().run({}, pairs, stores);
    EXPECT_THAT(pairs, Each(testing::Ne(unwritten)));
  }
}

CaseResult compared(const CaseRequest& request) {
  CompareOptions options;
  options.algorithms = "grid,quadtree";
  options.plan = {request};
  options.effort.share_seconds = 0;
  options.effort.min_rounds = 3;
  return compare(Catalogue(), options).cases.at(0);
}

TEST(Floor, TakesItsTurnsFromAThousandBoxesOn) {
  const CaseResult result = compared({"uniform", 2, 1'000});
  EXPECT_EQ(result.floor_ms.size(), 3u);
  EXPECT_THAT(result.floor_ms, Each(Gt(0)));
  EXPECT_THAT(compared({"uniform", 2, 999}).floor_ms, IsEmpty());
}

TEST(Floor, IsNoneWhereBoxesMoveOrNobodySearches) {
  EXPECT_THAT(compared({"uniform", 2, 1'000, 0.1, 2}).floor_ms, IsEmpty());
  CompareOptions options;
  options.algorithms = "paper_grid";
  options.plan = {{"uniform", 3, 1'000}};
  EXPECT_THAT(compare(Catalogue(), options).cases.at(0).floor_ms, IsEmpty());
}

}  // namespace
}  // namespace broadside::lab

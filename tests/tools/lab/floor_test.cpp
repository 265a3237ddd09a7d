// The floor: that its work is done, and when it is timed.
#include "lab/measure/floor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/measure/compare.hpp"
#include "tests/support/boxes.hpp"

namespace broadside::lab {
namespace {

using testing::Each;
using testing::ElementsAre;
using testing::Gt;
using testing::IsEmpty;

Box2 begins_at(float x, float y) { return {{x, y}, {x + 1, y + 2}}; }

TEST(Floor, SortsByTheLeastXWithTiesInTheirOrder) {
  const std::vector<Box2> boxes{begins_at(1e-20F, 0), begins_at(-3, 0),  begins_at(infinity, 0),
                                begins_at(0, 0),      begins_at(1e9, 0), begins_at(-0.0F, 0),
                                begins_at(-3.5F, 0),  begins_at(-3, 0),  begins_at(-infinity, 0)};
  Floor<2> floor;
  floor.run(boxes, {});
  EXPECT_THAT(floor.order(), ElementsAre(8, 6, 1, 7, 3, 5, 0, 4, 2));
}

TEST(Floor, GathersTheBoundsInThatOrder) {
  Floor<3> floor;
  const std::vector<Box3> many(5, Box3{{9, 9, 9}, {9, 9, 9}});
  floor.run(many, {});  // so that memory of another size is there
  const std::vector<Box3> boxes{{{2, 30, 400}, {5, 60, 700}}, {{1, 31, 401}, {6, 61, 701}}};
  floor.run(boxes, {});
  EXPECT_THAT(floor.bounds(), ElementsAre(ElementsAre(1, 2), ElementsAre(31, 30), ElementsAre(401, 400),
                                          ElementsAre(6, 5), ElementsAre(61, 60), ElementsAre(701, 700)));
}

TEST(Floor, WritesEachPair) {
  constexpr Pair unwritten{BoxId{77}, BoxId{77}};
  std::vector<Pair> pairs(10, unwritten);
  Floor<2>().run({}, pairs);
  EXPECT_THAT(pairs, Each(testing::Ne(unwritten)));
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

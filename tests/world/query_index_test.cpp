// QueryIndex: what it has to be told, and when it is built.
#include "world/query_index.hpp"

#include <cstddef>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace broadside::world {
namespace {

Box2 at(float x) { return {{x, 0}, {x + 1, 1}}; }

BoxTable<2, float> table_of(std::vector<Box2> boxes, std::vector<Filter> filters = {}) {
  BoxTable<2, float> table{WorldOptions{}};
  table.restore(std::move(boxes), {});
  if (!filters.empty()) table.restore_filters(std::move(filters));
  return table;
}

std::size_t found(QueryIndex<2, float>& index, const std::vector<Box2>& boxes, const Box2& where,
                  const std::vector<Filter>& filters = {}, const Filter* filter = nullptr) {
  std::size_t count = 0;
  index.updated(table_of(boxes, filters))
      .overlapping(where, [&count](BoxId) { ++count; }, {.filter = filter});
  return count;
}

TEST(QueryIndex, TakesNoMemoryBeforeTheFirstQuery) {
  QueryIndex<2, float> index;
  index.reserve(100);
  index.mark(99);
  EXPECT_EQ(index.bytes(), 0u);
  EXPECT_EQ(found(index, {at(0), at(5)}, at(0)), 1u);
  EXPECT_GT(index.bytes(), 0u);
  index.drop();
  EXPECT_EQ(index.bytes(), 0u);
}

TEST(QueryIndex, FollowsTheSlotsThatAreMarked) {
  QueryIndex<2, float> index;
  std::vector<Box2> boxes = {at(0), at(5)};
  found(index, boxes, at(0));
  boxes[1] = at(0.5F);
  index.mark(1);
  EXPECT_EQ(found(index, boxes, at(0)), 2u);
  index.reserve(3);
  boxes.push_back(at(0));
  index.mark(std::vector<Handle>{{2, 0}, {77, 0}});
  EXPECT_EQ(found(index, boxes, at(0)), 3u);
}

TEST(QueryIndex, FindsNoBoxOfASlotThatIsGone) {
  QueryIndex<2, float> index;
  const std::vector<Box2> boxes = {at(0), at(0), at(0)};
  found(index, boxes, at(0));
  const std::vector<Box2> fewer = {at(0)};
  index.mark_differences(table_of(boxes), table_of(fewer));
  EXPECT_EQ(found(index, fewer, at(0)), 1u);
}

TEST(QueryIndex, SeesFiltersThatDiffer) {
  QueryIndex<2, float> index;
  const std::vector<Box2> boxes = {at(0), at(0)};
  const Filter filter;
  EXPECT_EQ(found(index, boxes, at(0), {}, &filter), 2u);
  const std::vector<Filter> filters = {{.mask = 0}, {}};
  index.mark_differences(table_of(boxes), table_of(boxes, filters));
  EXPECT_EQ(found(index, boxes, at(0), filters, &filter), 1u);
}

TEST(QueryIndex, IsDroppedWhenMostSlotsChangedAndNoQueryUsedIt) {
  QueryIndex<2, float> index;
  const std::vector<Box2> boxes(4000, at(0));
  found(index, boxes, at(9));
  for (std::uint32_t slot = 0; slot < 3000; ++slot) index.mark(slot);
  for (int update = 0; update < 100; ++update) index.drop_outdated(4000);
  EXPECT_GT(index.bytes(), 0u) << "few have changed";
  for (std::uint32_t slot = 3000; slot < 4000; ++slot) index.mark(slot);
  for (int update = 0; update < 15; ++update) index.drop_outdated(4000);
  found(index, boxes, at(9));
  for (std::uint32_t slot = 0; slot < 4000; ++slot) index.mark(slot);
  for (int update = 0; update < 15; ++update) index.drop_outdated(4000);
  EXPECT_GT(index.bytes(), 0u) << "a query used it";
  index.drop_outdated(4000);
  EXPECT_EQ(index.bytes(), 0u);
}

}  // namespace
}  // namespace broadside::world

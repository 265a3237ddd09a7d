// CellAxis, prefix_sum() and CellLists: in which cell a coordinate is, and where a cell's items go.
#include "core/cell_axis.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/cell_lists.hpp"
#include "core/prefix_sum.hpp"
#include "tests/support/rng.hpp"

namespace broadside::core {
namespace {

TEST(CellAxis, ClampsWhatLiesBeyondAndRisesWithTheCoordinate) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const CellAxis axis{.low = -2, .per_unit = 0.5F, .last = 3};
  EXPECT_EQ(axis.count(), 4U);
  std::uint32_t before = 0;
  for (const float coordinate :
       {-infinity, -1e30F, -2.0F, -0.1F, 0.0F, 1.9F, 2.0F, 5.9F, 6.0F, 1e30F, infinity}) {
    EXPECT_GE(axis(coordinate), before) << coordinate;
    before = axis(coordinate);
  }
  EXPECT_EQ(axis(-infinity), 0U);
  EXPECT_EQ(axis(0), 1U);
  EXPECT_EQ(axis(infinity), 3U);
  EXPECT_EQ(axis(std::numeric_limits<float>::quiet_NaN()), 0U);
}

TEST(PrefixSum, GivesEachRangeItsPlaceInEachBucket) {
  // Two ranges, three buckets.
  std::vector<std::uint32_t> counts = {1, 2, 3, 10, 0, 5};
  EXPECT_EQ(prefix_sum(std::span<std::uint32_t>(counts), 3), 21U);
  EXPECT_EQ(counts, (std::vector<std::uint32_t>{0, 11, 13, 1, 13, 16}));
}

TEST(CellLists, HoldWhatVectorsWouldInTheOrderOfTheRanges) {
  Rng rng(1);
  CellLists lists;
  for (const std::size_t cells : {1, 7, 1000}) {
    constexpr std::size_t ranges = 3;
    constexpr std::uint32_t count = 900;
    std::vector<std::size_t> cell_of(count);
    std::vector<std::vector<std::uint32_t>> expected(cells);
    lists.reset(cells, ranges);
    for (std::uint32_t item = 0; item < count; ++item) {
      cell_of[item] = rng.below(cells);
      expected[cell_of[item]].push_back(item);
      lists.count(cell_of[item], item * ranges / count);
    }
    lists.prepare();
    for (std::uint32_t item = count; item-- > 0;) {  // the last range first
      const std::uint32_t range = item * ranges / count;
      const std::uint32_t mirrored = (2 * range + 1) * count / ranges - 1 - item;
      lists.append(cell_of[mirrored], mirrored, range);
    }
    EXPECT_EQ(lists.size(), count);
    for (std::size_t cell = 0; cell < cells; ++cell)
      ASSERT_TRUE(std::ranges::equal(lists.list(cell), expected[cell])) << cell;
  }
}

}  // namespace
}  // namespace broadside::core

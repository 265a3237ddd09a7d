// CellAxis and prefix_sum(): in which cell a coordinate is, and where a cell's items go.
#include "core/cell_axis.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "core/prefix_sum.hpp"

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

}  // namespace
}  // namespace broadside::core

// The lengths that peers are told are of the boxes at hand, whatever else is among them.
#include "lab/peers/typical_extent.hpp"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/boxes.hpp"

namespace broadside::lab::peers {
namespace {

/// Squares of this side, so many in a row, a tenth of their side apart.
std::vector<Box2> row(std::size_t count, float side) {
  std::vector<Box2> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    const float x = static_cast<float>(i) * side * 1.1f;
    boxes[i] = {{x, 0}, {x + side, side}};
  }
  return boxes;
}

TEST(TypicalExtent, IsTheLongestSideOfTheMedianBox) {
  std::vector<Box2> boxes = row(100, 1);
  boxes[3] = {{-1e6f, 0}, {1e6f, 0}};
  boxes[50] = absent_box<2>();
  boxes[70] = {{-infinity, 0}, {0, infinity}};
  EXPECT_NEAR(typical_extent<2>(boxes), 1, 1e-4);
}

TEST(TypicalExtent, IsTheDistanceOfPoints) {
  std::vector<Box2> boxes;
  for (int x = 0; x < 10; ++x) {
    for (int y = 0; y < 10; ++y) {
      const auto at = std::array{static_cast<float>(5 * x), static_cast<float>(5 * y)};
      boxes.push_back({at, at});
    }
  }
  EXPECT_NEAR(typical_extent<2>(boxes), 5, 1);
}

TEST(TypicalExtent, IsNeverNothing) {
  EXPECT_GT(typical_extent<2>(std::vector<Box2>{}), 0);
  EXPECT_GT(typical_extent<2>(std::vector<Box2>(5, Box2{{7, 7}, {7, 7}})), 0);
  EXPECT_GT(typical_extent<2>(std::vector<Box2>(5, Box2{{-infinity, 0}, {infinity, 0}})), 0);
  EXPECT_GT(typical_extent<3>(std::vector<Box3>(5, absent_box<3>())), 0);
}

TEST(RangeOn, LeavesOutWhatIsAbsentOrInfinite) {
  const std::vector<Box2> boxes = {{{-infinity, 3}, {7, 4}}, absent_box<2>(), {{2, -1}, {5, infinity}}};
  EXPECT_EQ(range_on<2>(0, boxes), (std::array{2.0, 7.0}));
  EXPECT_EQ(range_on<2>(1, boxes), (std::array{-1.0, 4.0}));
  EXPECT_EQ(range_on<2>(0, {}), (std::array{0.0, 0.0}));
}

TEST(AxesByExtent, BeginWithTheLongestAndKeepTheOrderOfEqualOnes) {
  const std::vector<Box3> boxes = {{{0, 0, 0}, {1, 1, 1}}, {{0, 8, 0}, {1, 9, 1}}};
  EXPECT_EQ(axes_by_extent<3>(boxes), (std::array{1, 0, 2}));
}

TEST(CellSize, IsThatOfATypicalBox) { EXPECT_NEAR(cell_size<2>(row(100, 3), 2), 6, 1e-3); }

TEST(CellSize, KeepsHugeBoxesFromFillingTheGrid) {
  std::vector<Box2> boxes = row(1000, 1);
  for (std::size_t i = 0; i < 100; ++i) boxes[10 * i] = {{0, 0}, {1000, 1000}};
  const double cell = cell_size<2>(boxes, 1);
  // 32 cells a box: each of the hundred has its share and that of the nine others.
  EXPECT_LE(100 * (1000 / cell) * (1000 / cell), 32 * 1000);
  EXPECT_LE(cell, 200);
}

TEST(CellSize, LetsCellsBeCountedInAnInt) {
  std::vector<Box2> boxes = row(100, 1e-6f);
  boxes[0] = {{1e30f, 1e30f}, {1e30f, 1e30f}};
  EXPECT_LE(1e30 / cell_size<2>(boxes, 1), 0x1p20);
}

}  // namespace
}  // namespace broadside::lab::peers

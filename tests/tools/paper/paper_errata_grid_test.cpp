// docs/paper/errata.md on Algorithms 1 to 4: each printed listing goes wrong on its input, the mended one
// does not.
#include <algorithm>
#include <cmath>

#include "paper_errata.hpp"

namespace broadside::paper {
namespace {

using enum printed::To;
using printed::Filing;
using printed::Grid;

/// Algorithm 2 with x and y as they must have been meant.
Grid grid_of(double width, double height, double size) {
  return printed::algorithm_2_init(width, height, size, static_cast<std::size_t>(std::ceil(width / size)),
                                   static_cast<std::size_t>(std::ceil(height / size)));
}

/// Algorithm 3 on a new grid.
Grid filed(const std::vector<Box2>& boxes, double width, double size, float step) {
  Grid grid = grid_of(width, width, size);
  printed::algorithm_3_spanning_add_element(objects(boxes), excluding, step, grid);
  return grid;
}

Record spi(const Grid& grid) {
  Record record;
  printed::algorithm_4_spi(grid, excluding, record.sink());
  return record;
}

/// The filings whose computed row and col, rounded down, are these.
std::ptrdiff_t filings_in(const Grid& grid, double col, double row) {
  return std::ranges::count_if(grid.filings, [&](const Filing& filing) {
    return std::floor(filing.col) == col && std::floor(filing.row) == row;
  });
}

bool is_filed(const Grid& grid, BoxId id) {
  return std::ranges::any_of(grid.filings,
                             [id](const Filing& filing) { return filing.id == id && filing.cell_exists; });
}

TEST(Erratum1a, LoopsToTheLengthReadPastTheEnd) {
  const std::vector<Box2> boxes = {box(0, 0, 1, 1), box(1, 1, 2, 2)};
  Record record;
  expect_past_the_end("Algorithm 1",
                      [&] { printed::algorithm_1_brute_force(objects(boxes), including, record.sink()); });
  expect_right("paper_brute_force", boxes);
}

TEST(Erratum1b, ABoxIsTestedWithItself) {
  const std::vector<Box2> boxes = {box(0, 0, 1, 1), box(5, 5, 6, 6), box(8, 8, 9, 9)};
  Record record;
  printed::algorithm_1_brute_force(objects(boxes), excluding, record.sink());
  EXPECT_EQ(record.times(0, 0), 1U);
  EXPECT_EQ(record.size(), 6U);
  EXPECT_EQ(expect_right("paper_brute_force", boxes).tests, 3U);
}

TEST(Erratum2a, AGridOfXTimesYHasNoDefinedSize) {
  const Grid grid = printed::algorithm_2_init(100, 100, 10, 0, 0);
  EXPECT_EQ(grid.x_grids, 10);
  EXPECT_TRUE(grid.g.empty());
  expect_past_the_end("Algorithm 4", [&] { spi(grid); });
  expect_right("paper_grid:width=100:height=100:cell=10", {box(1, 1, 2, 2), box(2, 2, 3, 3)});
}

TEST(Erratum2b, TheWorldCanBeginNowhereButAtZero) {
  const std::vector<Box2> boxes = {box(-20, 1, -15, 5), box(-15, 1, -12, 5), box(-35, 1, -32, 5)};
  const Grid grid = filed(boxes, 100, 10, 10);  // a world from -50 to 50
  EXPECT_EQ(grid.filings.front().col, -2);
  EXPECT_FALSE(is_filed(grid, BoxId{0}));
  EXPECT_EQ(spi(grid).times(0, 1), 0U);
  const Statistics statistics =
      expect_right("paper_grid:left=-50:top=-50:width=100:height=100:cell=10", boxes);
  EXPECT_EQ(statistics.tests, 1U);  // C has a cell of its own
}

TEST(Erratum2c, AGridMayBeTooLargeForAnyMemory) {
  const Grid grid = printed::algorithm_2_init(1e9, 1e9, 1, 0, 0);
  EXPECT_EQ(grid.x_grids * grid.y_grids, 1e18);
  const std::vector<Box2> boxes = {box(1, 1, 2, 2), box(2, 2, 9e8F, 3)};
  expect_right("paper_grid:width=1e9:height=1e9:cell=1", boxes);
  PairCounter pairs;
  EXPECT_THROW(Finder<2>("paper_grid:width=1e30:height=1e30:cell=1:limit=none").find(boxes, pairs),
               std::bad_alloc);
}

TEST(Erratum3a, TheLoopToTheLengthReadsPastTheEnd) {
  const std::vector<Box2> boxes = {box(0, 0, 1, 1), box(1, 1, 2, 2)};
  Grid grid = grid_of(10, 10, 1);
  expect_past_the_end("Algorithm 3",
                      [&] { printed::algorithm_3_spanning_add_element(objects(boxes), including, 1, grid); });
  expect_right("paper_grid:width=10:height=10:cell=1", boxes);
}

TEST(Erratum3b, AUnitStepFilesABoxInOneCellAgainAndAgain) {
  const std::vector<Box2> boxes = {box(0, 0, 1, 1)};
  EXPECT_EQ(filings_in(filed(boxes, 8, 4, 1), 0, 0), 16);
  EXPECT_EQ(expect_right("paper_grid:width=8:height=8:cell=4", boxes).references, 1U);
}

TEST(Erratum3b, AUnitStepSkipsCellsSmallerThanIt) {
  const std::vector<Box2> boxes = {box(0, 0, 1, 1), box(.5F, .5F, .6F, .6F)};
  const Grid grid = filed(boxes, 4, .25, 1);
  for (const Filing& first : grid.filings) {
    for (const Filing& second : grid.filings) {
      if (first.id != second.id) {
        EXPECT_NE(std::floor(first.col), std::floor(second.col));
      }
    }
  }
  expect_right("paper_grid:width=4:height=4:cell=0.25", boxes);
}

TEST(Erratum3c, AStepOfSizeOvershootsByACell) {
  const std::vector<Box2> boxes = {box(0, 0, 5, 5)};
  const Grid grid = filed(boxes, 40, 10, 10);
  EXPECT_EQ(grid.filings.size(), 4U);
  EXPECT_EQ(filings_in(grid, 1, 1), 1);
  EXPECT_EQ(expect_right("paper_grid:width=40:height=40:cell=10", boxes).references, 1U);
}

TEST(Erratum3d, AStepInCoordinatesIsLostInRounding) {
  const std::vector<Box2> boxes = {box(16777216, 0, 16777218, 1), box(16777218, 0, 16777220, 1)};
  Grid grid = printed::algorithm_2_init(3e7, 3e7, 1e6, 0, 0);
  EXPECT_THROW(printed::algorithm_3_spanning_add_element(objects(boxes), excluding, 1, grid),
               printed::NeverEnds);
  expect_right("paper_grid:width=3e7:height=3e7:cell=1e6", boxes);
}

TEST(Erratum3d, AnInfiniteBoxIsFiledForEver) {
  const std::vector<Box2> boxes = {box(-infinity, 0, 5, 1), box(1, 1, 2, 2)};
  Grid grid = grid_of(10, 10, 1);
  EXPECT_THROW(printed::algorithm_3_spanning_add_element(objects(boxes), excluding, 1, grid),
               printed::NeverEnds);
  expect_right("paper_grid:width=10:height=10:cell=1", boxes);
}

TEST(Erratum3e, RowAndColAreNoWholeNumbers) {
  const std::vector<Box2> boxes = {box(17, 0, 18, 1)};
  EXPECT_EQ(filed(boxes, 100, 10, 10).filings.front().col, 1.7);
  EXPECT_EQ(expect_right("paper_grid:width=100:height=100:cell=10", boxes).references, 1U);
}

TEST(Erratum3f, WhatLiesAtTheWorldsMaximumIsLost) {
  const std::vector<Box2> boxes = {box(9.5F, 0, 10, .5F), box(10, 0, 10.5F, .5F)};
  const Grid grid = filed(boxes, 10, 1, 1);
  EXPECT_FALSE(is_filed(grid, BoxId{1}));
  EXPECT_EQ(spi(grid).times(0, 1), 0U);
  expect_right("paper_grid:left=0:top=0:width=10:height=10:cell=1", boxes);
}

TEST(Erratum3g, WhatLiesBelowTheWorldsMinimumHasANegativeIndex) {
  const std::vector<Box2> boxes = {box(-2, 1, -1, 1.5F), box(-1.5F, 1, -.5F, 1.5F)};
  const Grid grid = filed(boxes, 10, 1, 1);
  EXPECT_EQ(grid.filings.front().x, -2);
  EXPECT_FALSE(grid.filings.front().cell_exists);
  EXPECT_EQ(spi(grid).times(0, 1), 0U);
  expect_right("paper_grid:left=0:top=0:width=10:height=10:cell=1", boxes);
}

TEST(Erratum3h, BoxesAreFiledByTheirCoordinates) {
  const std::vector<Box2> boxes = {box(20, 0, 25, 5), box(24, 0, 29, 5)};
  const Grid grid = filed(boxes, 100, 10, 10);
  EXPECT_EQ(grid.filings.front().col, 2);
  EXPECT_EQ(grid.filings.front().x, 20);
  EXPECT_FALSE(is_filed(grid, BoxId{0}));
  EXPECT_EQ(spi(grid).times(0, 1), 0U);
  expect_right("paper_grid:width=100:height=100:cell=10", boxes);
}

TEST(Erratum3i, HugeBoxesFillEveryCell) {
  const std::vector<Box2> boxes(5, box(0, 0, 300, 300));
  EXPECT_EQ(filed(boxes, 300, 1, 1).filings.size(), 450'000U);
  EXPECT_EQ(expect_right("paper_grid:width=300:height=300:cell=1", boxes).references, 112'500U);
  EXPECT_LE(expect_right("paper_grid", boxes).references, 80U);
  EXPECT_EQ(expect_right("paper_grid:width=300:height=300:cell=1:limit=none", boxes).references, 450'000U);
}

TEST(Erratum4a, TheLoopsToTheNumberOfGridsReadPastTheEnd) {
  Record record;
  expect_past_the_end("Algorithm 4",
                      [&] { printed::algorithm_4_spi(grid_of(2, 2, 1), including, record.sink()); });
  expect_right("paper_grid:width=2:height=2:cell=1", {box(0, 0, 1, 1), box(1, 1, 2, 2)});
}

TEST(Erratum4b, APairIsTestedInEachCellThatItShares) {
  const std::vector<Box2> boxes = {box(.5F, .2F, 1.5F, .4F), box(.6F, .2F, 1.4F, .4F)};
  EXPECT_EQ(spi(filed(boxes, 4, 1, 1)).times(0, 1), 4U);
  const Statistics statistics = expect_right("paper_grid:left=0:top=0:width=4:height=4:cell=1", boxes);
  EXPECT_EQ(statistics.tests, 2U);  // in both cells, and reported in one
}

TEST(ErratumT3, ABoxTouchesMoreCellsThanItsWidthTimesItsHeight) {
  const std::vector<Box2> boxes = {box(0, 0, 3, 2)};
  EXPECT_EQ(filed(boxes, 10, 1, 1).filings.size(), 12U);
  EXPECT_EQ(expect_right("paper_grid:left=0:top=0:width=10:height=10:cell=1", boxes).references, 12U);
}

}  // namespace
}  // namespace broadside::paper

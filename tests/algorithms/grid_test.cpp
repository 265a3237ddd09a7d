// The search of the grid, with cells of many sizes.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/algorithms/searched.hpp"

namespace broadside::algorithm {
namespace {

TEST(Grid, FindsThePairsOfTheDefinitionWithCellsOfAnySize) {
  on_each_instruction_set([]<int D>() {
    Rng rng(1);
    const std::vector<Box<D>> boxes = random_boxes<D>(rng, 700);
    for (const char* const cell : {"0.001", "0.5", "1", "3", "25", "1e6", "auto"})
      expect_definition(std::string("grid:cell=") + cell, boxes);
  });
}

TEST(Grid, LimitsTheCellsThatABoxIsIn) {
  in_each_dimension([]<int D>() {
    Rng rng(2);
    const std::vector<Box<D>> boxes =
        random_boxes<D>(rng, 2000, {.places = 500, .max_extent = 60, .infinite_one_in = 0});
    const auto statistics = expect_definition(Spec("grid:cell=0.01"), boxes);
    ASSERT_TRUE(statistics);
    EXPECT_LE(statistics->references, 64 * boxes.size());
  });
}

TEST(Grid, CarriesInfiniteBoxesThroughAllCells) {
  in_each_dimension([]<int D>() {
    Rng rng(3);
    const std::vector<Box<D>> boxes = random_boxes<D>(rng, 600, {.places = 300, .infinite_one_in = 5});
    expect_definition(Spec("grid:cell=2"), boxes);
  });
}

TEST(Grid, TakesBoxesAtOnePlace) {
  in_each_dimension([]<int D>() {
    expect_definition(Spec("grid:cell=1"), std::vector<Box<D>>(200));
    expect_definition(Spec("grid"), std::vector<Box<D>>(200));
  });
}

}  // namespace
}  // namespace broadside::algorithm

// The search of the quadtree, with leaves of many capacities.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/algorithms/searched.hpp"

namespace broadside::algorithm {
namespace {

TEST(Quadtree, FindsThePairsOfTheDefinitionWithLeavesOfAnyCapacity) {
  on_each_instruction_set([]<int D>() {
    Rng rng(1);
    const std::vector<Box<D>> boxes = random_boxes<D>(rng, 700);
    for (const char* const capacity : {"1", "2", "7", "64", "1000", "auto"})
      expect_definition(std::string("quadtree:capacity=") + capacity, boxes);
  });
}

TEST(Quadtree, EndsWhereNoSplitPartsTheBoxes) {
  in_each_dimension([]<int D>() {
    std::vector<Box<D>> boxes(300);  // all at one point
    expect_definition(Spec("quadtree:capacity=1"), boxes);
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i].max[0] = static_cast<float>(i);
    expect_definition(Spec("quadtree:capacity=1"), boxes);  // all share a corner
  });
}

TEST(Quadtree, KeepsBoxesThatCoverAMiddle) {
  in_each_dimension([]<int D>() {
    Rng rng(4);
    std::vector<Box<D>> boxes = random_boxes<D>(rng, 500, {.places = 200, .infinite_one_in = 0});
    for (std::size_t i = 0; i < boxes.size(); i += 10) {
      for (int axis = 0; axis < D; ++axis) boxes[i].max[axis] = boxes[i].min[axis] + 100;
    }
    const auto statistics = expect_definition(Spec("quadtree:capacity=4"), boxes);
    ASSERT_TRUE(statistics);
    EXPECT_LT(statistics->references, 8 * boxes.size())
        << "large boxes are not in every leaf that they touch";
  });
}

}  // namespace
}  // namespace broadside::algorithm

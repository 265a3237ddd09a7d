// Lattices of touching boxes in order, such as tiles and voxels: a sample that is spread over the array is
// then spread over every axis as well, where it once saw no two boxes overlap.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

namespace broadside {
namespace {

/// `side` boxes along each axis, axis by axis; the last axis fastest, or the first one.
template <int D>
std::vector<Box<D>> lattice(std::size_t side, bool first_is_fastest) {
  std::size_t count = 1;
  for (int axis = 0; axis < D; ++axis) count *= side;
  std::vector<Box<D>> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t rest = i;
    for (int step = 0; step < D; ++step) {
      const int axis = first_is_fastest ? step : D - 1 - step;
      boxes[i].min[axis] = static_cast<float>(rest % side);
      boxes[i].max[axis] = boxes[i].min[axis] + 1;
      rest /= side;
    }
  }
  return boxes;
}

template <int D>
void expect_few_tests(std::string_view algorithm, std::size_t side, double max_per_box) {
  for (const bool first_is_fastest : {false, true}) {
    SCOPED_TRACE(std::string(algorithm) + ", " + std::to_string(D) + "D, " + std::to_string(side) +
                 (first_is_fastest ? ", the first axis fastest" : ""));
    const std::vector<Box<D>> boxes = lattice<D>(side, first_is_fastest);
    Finder<D> finder(algorithm);
    PairCounter pairs;
    const auto statistics = finder.find(boxes, pairs);
    // Pairs of neighbours in 3^D places, each once: those within the lattice.
    double near = 1;
    for (int axis = 0; axis < D; ++axis) near *= static_cast<double>(3 * side - 2);
    EXPECT_EQ(static_cast<double>(pairs.count()), (near - static_cast<double>(boxes.size())) / 2);
    EXPECT_LE(static_cast<double>(statistics->tests) / static_cast<double>(boxes.size()), max_per_box);
  }
}

TEST(OrderedLattice, TakesFewTestsWhateverItsSideAndOrder) {
  for (const std::string_view algorithm : {"auto", "grid", "quadtree", "bvh"}) {
    for (const std::size_t side : {500, 620, 700}) expect_few_tests<2>(algorithm, side, 32);
    for (const std::size_t side : {60, 70, 80}) expect_few_tests<3>(algorithm, side, 100);
  }
  for (const std::size_t side : {500, 620, 700}) expect_few_tests<2>("sweep_and_prune", side, 64);
}

}  // namespace
}  // namespace broadside

// ConservativeRounding: boxes of floats that contain boxes of doubles.
#include "algorithms/bvh/conservative_rounding.hpp"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::algorithm {
namespace {

TEST(ConservativeRounding, RoundsBelowAndAboveEveryDouble) {
  Rng rng(1);
  for (int i = 0; i < 10'000; ++i) {
    const double value = std::ldexp(rng.between(-1, 1) + 0x1p-40 * rng.unit(), rng.whole(-160, 99));
    ASSERT_LT(rounded_down(value), value);
    ASSERT_GT(rounded_up(value), value);
    ASSERT_LE(value - rounded_down(value), std::abs(value) * 0x1p-22 + 0x1p-125) << value << ": it is near";
  }
  for (const double value : {0.0, 1e308, -1e308, 1e-310, HUGE_VAL, -HUGE_VAL}) {
    EXPECT_LE(rounded_down(value), value);
    EXPECT_GE(rounded_up(value), value);
  }
}

TEST(ConservativeRounding, ContainsBoxesFarFromTheOrigin) {
  in_each_dimension([]<int D>() {
    Rng rng(2);
    std::vector<Box<D, double>> boxes;
    for (int i = 0; i < 500; ++i) {
      boxes.push_back(near_double(rng, random_box<D>(rng, {.infinite_one_in = 0})));
      for (int axis = 0; axis < D; ++axis) {
        boxes.back().min[axis] += 1e9;
        boxes.back().max[axis] += 1e9;
      }
    }
    ConservativeRounding<D> rounding;
    rounding.fit(boxes);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const bool meet = overlap(rounding.box(boxes[i]), rounding.box(boxes[j]));
        ASSERT_TRUE(meet || !overlap(boxes[i], boxes[j])) << i << ", " << j;
      }
    }
  });
}

}  // namespace
}  // namespace broadside::algorithm

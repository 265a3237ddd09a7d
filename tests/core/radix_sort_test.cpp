// RadixSort and SortedBoxes against std::stable_sort, for one thread and several.
#include "core/radix_sort.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "core/sorted_boxes.hpp"
#include "tests/support/model.hpp"

namespace broadside::core {
namespace {

TEST(SortKey, OrdersAsFloatsDo) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(sort_key(-0.0F), sort_key(0.0F));
  float before = -infinity;
  for (const float value : {-3e38F, -1.5F, -1e-40F, 0.0F, 1e-40F, 1.5F, 3e38F, infinity}) {
    EXPECT_LT(sort_key(before), sort_key(value)) << value;
    before = value;
  }
}

TEST(RadixSort, SortsAsStableSortDoes) {
  Rng rng(1);
  RadixSort radix;
  for (const std::size_t threads : {1, 3}) {
    Parallel parallel;
    for (const std::size_t count : {0, 1, 2, 100, 5000}) {
      parallel.start({.threads = threads, .boxes_per_thread = 1}, count);
      for (const int bits : {0, 1, 11, 12, 23, 32}) {  // keys that differ in some digits alone
        const std::span<KeyedPlace> places = radix.places(count);
        for (std::uint32_t i = 0; i < count; ++i)
          places[i] = {static_cast<std::uint32_t>(rng.bits() >> 32 >> (32 - bits)), i};
        std::vector<KeyedPlace> expected(places.begin(), places.end());
        std::ranges::stable_sort(expected, {}, &KeyedPlace::key);
        const auto sorted = threads == 1 ? radix.sort() : radix.sort(parallel);
        ASSERT_TRUE(std::ranges::equal(sorted, expected, {}, &KeyedPlace::place, &KeyedPlace::place))
            << count << " keys of " << bits << " bits, " << threads << " threads";
      }
    }
  }
}

TEST(SortedBoxes, AreInTheOrderOfASweepWithTheirAxesTurned) {
  in_each_dimension([]<int D>() {
    Rng rng(2);
    const std::vector<Box<D>> boxes = random_boxes<D>(rng, 3000);
    std::array<int, D> axes;
    std::iota(axes.begin(), axes.end(), 0);
    std::ranges::reverse(axes);
    std::vector<std::size_t> expected(boxes.size());
    std::iota(expected.begin(), expected.end(), 0);
    std::ranges::stable_sort(expected, {}, [&](std::size_t i) { return boxes[i].min[D - 1]; });
    for (const std::size_t threads : {1, 3}) {
      Parallel parallel;
      parallel.start({.threads = threads, .boxes_per_thread = 1}, boxes.size());
      SortedBoxes<D> sorted;
      const std::span<const SortedBox<D>> result = sorted.sort(boxes, axes, parallel);
      ASSERT_EQ(result.size(), boxes.size());
      for (std::size_t i = 0; i < result.size(); ++i) {
        ASSERT_EQ(result[i].id, BoxId(expected[i]));
        for (int axis = 0; axis < D; ++axis) {
          ASSERT_EQ(result[i].box.min[axis], boxes[expected[i]].min[D - 1 - axis]);
          ASSERT_EQ(result[i].box.max[axis], boxes[expected[i]].max[D - 1 - axis]);
        }
      }
    }
  });
}

}  // namespace
}  // namespace broadside::core

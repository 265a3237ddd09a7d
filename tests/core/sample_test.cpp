// Sample against what all pairs of the boxes say.
#include "core/sample.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::core {
namespace {

/// The part of the pairs that overlap on `axis`, or on all axes if it is D.
template <int D>
double overlapping_part(const std::vector<Box<D>>& boxes, int axis) {
  std::size_t overlaps = 0;
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j, ++pairs) {
      const auto on = [&](int a) {
        return boxes[i].min[a] <= boxes[j].max[a] && boxes[j].min[a] <= boxes[i].max[a];
      };
      overlaps += axis == D ? overlap(boxes[i], boxes[j]) : on(axis);
    }
  }
  return static_cast<double>(overlaps) / static_cast<double>(pairs);
}

TEST(SampledPlace, LiesInTheArrayAndSpreadsOverIt) {
  for (const std::size_t size : {1, 2, 64, 1000, 1 << 20}) {
    std::set<std::size_t> sixteenths;
    for (std::size_t i = 0; i < 64; ++i) {
      ASSERT_LT(sampled_place(i, size), size);
      sixteenths.insert(sampled_place(i, size) * 16 / size);
    }
    EXPECT_EQ(sixteenths.size(), std::min<std::size_t>(16, size));
  }
}

TEST(SampleShift, DependsOnTheHashedBoxesAlone) {
  Rng rng(2);
  std::vector<Box<2>> boxes = random_boxes<2>(rng, 1'000, {.infinite_one_in = 0});
  const std::span<const Box<2>> all = boxes;
  const std::uint32_t shift = sample_shift(all, 32);
  const std::uint32_t shift_of_all = sample_shift(all, boxes.size());
  boxes[1].min[0] = 0.375F;  // not among the hashed ones
  EXPECT_EQ(sample_shift(all, 32), shift);
  EXPECT_NE(sample_shift(all, boxes.size()), shift_of_all);
  boxes[sampled_place(31, boxes.size())].min[1] = 0.375F;
  EXPECT_NE(sample_shift(all, 32), shift);
}

TEST(Sample, SaysOfFewBoxesWhatIsTrueOfAll) {
  in_each_dimension([]<int D>() {
    Rng rng(1);
    Sample<D> sample;
    for (const std::size_t count : {2, 3, 31, 64}) {
      std::vector<Box<D>> boxes = random_boxes<D>(rng, count, {.infinite_one_in = 0});
      sample.take(boxes);
      for (int axis = 0; axis < D; ++axis) {
        std::vector<float> extents;
        for (const Box<D>& box : boxes) extents.push_back(box.max[axis] - box.min[axis]);
        std::ranges::sort(extents);
        EXPECT_NEAR(sample[axis].overlap, overlapping_part(boxes, axis), 1e-12);
        EXPECT_EQ(sample[axis].extent, extents[count / 2]);
        EXPECT_TRUE(std::ranges::is_sorted(sample[axis].minima));
        EXPECT_EQ(sample[axis].minima.size(), count);
      }
    }
  });
}

TEST(Sample, SweepsAlongTheAxisOfTheLeastOverlapAndIgnoresOutliers) {
  in_each_dimension([]<int D>() {
    std::vector<Box<D>> boxes(1000);
    for (std::size_t i = 0; i < boxes.size(); ++i)
      boxes[i].min[D - 1] = boxes[i].max[D - 1] = static_cast<float>(i % 100);
    boxes[3].max.fill(std::numeric_limits<float>::infinity());
    boxes[4].min.fill(-1e30F);
    Sample<D> sample;
    sample.take(boxes);
    EXPECT_EQ(sample.axes_by_overlap()[0], D - 1);
    EXPECT_GE(sample[D - 1].low, -100);
    EXPECT_LE(sample[D - 1].high, 200);
  });
}

}  // namespace
}  // namespace broadside::core

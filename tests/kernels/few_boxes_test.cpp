// The comparison of few boxes on every instruction set: the pairs of the definition, in its order, or none.
#include "kernels/few_boxes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

constexpr float largest = std::numeric_limits<float>::max();

/// Boxes of up to a unit that begin in a cube of twice `side`.
template <int D>
std::vector<Box<D>> drawn_boxes(Rng& rng, std::size_t count, float side) {
  std::vector<Box<D>> boxes(count);
  for (Box<D>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = rng.between(-side, side);
      box.max[axis] = box.min[axis] + rng.between(0, 1);
    }
  }
  return boxes;
}

/// What is written, or empty if the boxes are refused, which must not write.
template <int D>
std::optional<std::vector<Pair>> compared(const std::vector<Box<D>>& boxes, std::size_t left_count = 0,
                                          const Box<D, double>* doubles = nullptr) {
  bool is_done = false;
  std::vector<Pair> pairs = written_pairs([&](PairSink& sink) {
    is_done = compare_few(std::span<const Box<D>>(boxes), left_count, doubles, sink);
  });
  if (is_done) return pairs;
  EXPECT_TRUE(pairs.empty());
  return std::nullopt;
}

/// Numbers of boxes about those that fill vectors and words.
std::vector<std::size_t> counts() {
  std::vector<std::size_t> counts;
  for (std::size_t count = 0; count <= 70; ++count) counts.push_back(count);
  for (std::size_t count : {127, 128, 129, 191, 192, 193, 255, 256, 257, 300, 319, 320})
    counts.push_back(count);
  return counts;
}

TEST(FewBoxes, WritesThePairsInOrder) {
  on_each_instruction_set([]<int D>() {
    Rng rng(1);
    for (const std::size_t count : counts()) {
      for (const float side : {1.0F, 4.0F, 1000.0F}) {
        const auto boxes = drawn_boxes<D>(rng, count, side);
        ASSERT_EQ(compared(boxes), overlapping_pairs(boxes)) << count << " boxes, " << side;
      }
    }
  });
}

TEST(FewBoxes, WritesPairsBetweenTwoSets) {
  on_each_instruction_set([]<int D>() {
    Rng rng(2);
    for (const std::size_t count : counts()) {
      const auto boxes = drawn_boxes<D>(rng, count, 4);
      for (const std::size_t left :
           {std::size_t{1}, count / 3, count - 1, count, std::size_t{63}, std::size_t{64}}) {
        if (left == 0 || left > count) continue;
        ASSERT_EQ(compared(boxes, left), overlapping_pairs(boxes, left)) << left << " of " << count;
      }
    }
  });
}

TEST(FewBoxes, SeesBoxesThatTouchAndThoseThatMissByTheLeast) {
  on_each_instruction_set([]<int D>() {
    Rng rng(3);
    for (int axis = 0; axis < D; ++axis) {
      auto boxes = drawn_boxes<D>(rng, 100, 3);
      for (std::size_t i = 0; i + 1 < boxes.size(); i += 2) {
        boxes[i + 1] = boxes[i];
        const float length = boxes[i].max[axis] - boxes[i].min[axis];
        boxes[i + 1].min[axis] = boxes[i].max[axis];
        boxes[i + 1].max[axis] = boxes[i].max[axis] + length;
        if (i % 4 == 0) boxes[i + 1].min[axis] = std::nextafter(boxes[i].max[axis], largest);
      }
      ASSERT_EQ(compared(boxes), overlapping_pairs(boxes));
    }
  });
}

TEST(FewBoxes, LetsDoublesDecide) {
  on_each_instruction_set([]<int D>() {
    Rng rng(4);
    for (const std::size_t count : counts()) {
      const auto boxes = drawn_boxes<D>(rng, count, 2);
      std::vector<Box<D, double>> doubles(count);
      for (std::size_t i = 0; i < count; ++i) {
        for (int axis = 0; axis < D; ++axis) {  // less than a float can tell
          doubles[i].min[axis] = boxes[i].min[axis] + (axis == D - 1 ? 0.3 : 0);
          doubles[i].max[axis] = boxes[i].max[axis];
          if (doubles[i].min[axis] > doubles[i].max[axis]) doubles[i].min[axis] = doubles[i].max[axis];
        }
      }
      ASSERT_EQ(compared(boxes, 0, doubles.data()), overlapping_pairs(doubles)) << count;
    }
  });
}

TEST(FewBoxes, IsNotMisledByOutliers) {
  on_each_instruction_set([]<int D>() {
    Rng rng(5);
    for (const float far : {1e3F, 1e30F, largest, infinity}) {
      auto boxes = drawn_boxes<D>(rng, 200, 8);
      for (const std::size_t place : {0, 90, 150}) {  // the first is looked at
        boxes[place].min.fill(-far);
        if (place > 0) boxes[place].max.fill(place > 90 ? far : -far);
      }
      ASSERT_EQ(compared(boxes), overlapping_pairs(boxes)) << far;
    }
  });
}

TEST(FewBoxes, RefusesBoxesThatBytesCannotTellApart) {
  on_each_instruction_set([]<int D>() {
    Rng rng(6);
    std::vector<Box<D>> boxes = drawn_boxes<D>(rng, 256, 1e3);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (int axis = 0; axis < D; ++axis) {  // two clusters, a million of their sizes apart
        const float from = i % 2 == 0 ? 0.0F : 1e9F;
        boxes[i].min[axis] += from;
        boxes[i].max[axis] += from;
      }
    }
    EXPECT_EQ(compared(boxes), std::nullopt);
    EXPECT_EQ(compared(boxes, 128), std::nullopt);
  });
}

TEST(FewBoxes, WritesManyPairs) {
  on_each_instruction_set([]<int D>() {
    Rng rng(7);
    std::vector<Box<D>> boxes(max_few_boxes, drawn_boxes<D>(rng, 1, 1)[0]);
    ASSERT_EQ(compared(boxes), overlapping_pairs(boxes)) << "all boxes are the same";
    boxes = drawn_boxes<D>(rng, max_few_boxes, 0.7F);
    ASSERT_EQ(compared(boxes), overlapping_pairs(boxes));
  });
}

TEST(FewBoxes, TakesFlatBoxes) {
  on_each_instruction_set([]<int D>() {
    Rng rng(8);
    for (int axis = 0; axis < D; ++axis) {
      auto boxes = drawn_boxes<D>(rng, 150, 8);
      for (Box<D>& box : boxes) box.min[axis] = box.max[axis] = 3;
      boxes[77].max[axis] = 1e9F;
      boxes[78].min[axis] = boxes[78].max[axis] = 4;
      ASSERT_EQ(compared(boxes), overlapping_pairs(boxes));
    }
  });
}

}  // namespace
}  // namespace broadside::kernels

// The join by segment trees, which `auto` hands searches over to.
#include "algorithms/auto/segment_join.hpp"

#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/model.hpp"

namespace broadside::algorithm {
namespace {

template <int D>
Statistics expect_definition_of_join(SegmentJoin<D>& join, const std::vector<Box<D>>& boxes) {
  const std::function<void()> nothing;
  Statistics statistics;
  for (const std::size_t left_count : {std::size_t{0}, boxes.size() / 3}) {
    Checkpoint checkpoint(nothing);
    EXPECT_EQ(sorted_pairs([&](PairSink& sink) {
                statistics = join.join(boxes, left_count, nullptr, checkpoint, sink);
              }),
              overlapping_pairs(boxes, left_count));
  }
  return statistics;
}

TEST(SegmentJoin, FindsThePairsOfTheDefinitionOnceAndKeepsItsMemory) {
  on_each_instruction_set([]<int D>() {
    Rng rng(1);
    SegmentJoin<D> join;
    for (const std::size_t count : {3, 40, 700, 100})
      expect_definition_of_join(join, random_boxes<D>(rng, count, {.infinite_one_in = 10}));
    expect_definition_of_join(join, std::vector<Box<D>>(100));
  });
}

/// Plates that lie across each other on different axes: no axis alone tells them apart.
template <int D>
std::vector<Box<D>> plates(std::size_t count) {
  std::vector<Box<D>> boxes(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < D; ++axis) boxes[i].max[axis] = 1e6F;
    const int thin = static_cast<int>(i % D);
    boxes[i].min[thin] = static_cast<float>(3 * i);
    boxes[i].max[thin] = boxes[i].min[thin] + 1;
    boxes[i].min[(thin + 1) % D] = 2e6F;  // beside those that are thin on the next axis
    boxes[i].max[(thin + 1) % D] = 3e6F;
  }
  return boxes;
}

TEST(SegmentJoin, MakesFewTestsWhereNoSingleAxisTellsBoxesApart) {
  in_each_dimension([]<int D>() {
    SegmentJoin<D> join;
    const std::function<void()> nothing;
    Checkpoint checkpoint(nothing);
    const std::vector<Box<D>> boxes = plates<D>(20'000);
    PairCounter pairs;
    const Statistics statistics = join.join(boxes, 0, nullptr, checkpoint, pairs);
    const double n = static_cast<double>(boxes.size());
    EXPECT_LT(static_cast<double>(statistics.tests),
              (n + static_cast<double>(pairs.count())) * std::pow(std::log2(n), D));
  });
}

}  // namespace
}  // namespace broadside::algorithm

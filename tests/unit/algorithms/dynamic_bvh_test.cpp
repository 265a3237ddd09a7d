// DynamicBvh against a list of boxes: whatever was inserted, moved and removed, each box is in it once,
// bounds contain what is below them, and searches on every instruction set find what the definition says.
#include "algorithms/bvh/dynamic_bvh.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/executor.hpp"
#include "broadside/sinks.hpp"

#include "interface/encloses.hpp"
#include "kernels/bvh_follow.hpp"
#include "kernels/bvh_query.hpp"
#include "tests/instruction_sets.hpp"

namespace broadside::algorithm {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

template <int D>
Box<D> draw(std::mt19937& random) {
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = static_cast<float>(random() % 400) / 8;
    box.max[axis] = box.min[axis] + static_cast<float>(random() % 24) / 8;
    if (random() % 256 == 0) box.min[axis] = -infinity;
    if (random() % 256 == 0) box.max[axis] = infinity;
  }
  return box;
}

/// Counts the boxes below a node, and expects bounds to contain them and slots to lead to them.
template <int D>
std::size_t boxes_below(const DynamicBvh<D>& tree, const std::vector<Box<D>>& boxes, std::uint32_t number,
                        const Box<D>* bounds) {
  const kernels::Block<D>& node = tree.view().nodes[number & ~kernels::leaf_bit];
  std::size_t count = 0;
  for (std::size_t lane = 0; lane < kernels::fan_out; ++lane) {
    const Box<D> box = node.box(lane);
    EXPECT_EQ(is_present(box), lane < tree.child_count(number)) << "lane " << lane;
    if (!is_present(box)) continue;
    if (bounds != nullptr) {
      EXPECT_TRUE(core::encloses(*bounds, box));
    }
    if ((number & kernels::leaf_bit) == 0) {
      count += boxes_below(tree, boxes, node.id[lane], &box);
      continue;
    }
    ++count;
    EXPECT_EQ(box, boxes[node.id[lane]]);
    EXPECT_EQ(tree.slot(BoxId{node.id[lane]}), (number & ~kernels::leaf_bit) * kernels::fan_out + lane);
  }
  return count;
}

class Found final : public kernels::FoundBoxes {
 public:
  bool take() override {
    all.insert(all.end(), ids.begin(), ids.begin() + static_cast<std::ptrdiff_t>(count));
    count = 0;
    return true;
  }
  std::vector<std::uint32_t> all;
};

template <int D>
void expect_whole(const DynamicBvh<D>& tree, const std::vector<Box<D>>& boxes, std::mt19937& random) {
  const auto present = static_cast<std::size_t>(std::ranges::count_if(boxes, is_present<D, float>));
  ASSERT_EQ(tree.size(), present);
  if (present == 0) return;
  ASSERT_EQ(boxes_below<D>(tree, boxes, tree.view().root, nullptr), present);
  const Box<D> query = draw<D>(random);
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < boxes.size(); ++i) {
    if (is_present(boxes[i]) && overlap(boxes[i], query)) expected.push_back(i);
  }
  Found found;
  EXPECT_TRUE(kernels::find_overlapping(tree.view(), query, found));
  found.take();
  std::ranges::sort(found.all);
  EXPECT_EQ(found.all, expected);
}

template <int D>
void expect_random_changes_to_hold() {
  std::mt19937 random(D);
  DynamicBvh<D> tree;
  std::vector<Box<D>> boxes(600, absent_box<D>());
  for (int round = 0; round < 200; ++round) {
    if (round % 50 == 0) {
      for (Box<D>& box : boxes) box = random() % 8 == 0 ? absent_box<D>() : draw<D>(random);
      tree.build(boxes);
    }
    for (int change = 0; change < 30; ++change) {
      const std::size_t i = random() % boxes.size();
      // At first boxes go, then they come: leaves empty and nodes split.
      const bool goes = round % 50 < 25 ? random() % 3 != 0 : random() % 6 == 0;
      boxes[i] = goes ? absent_box<D>() : draw<D>(random);
      tree.set(BoxId(i), boxes[i]);
    }
    expect_whole(tree, boxes, random);
    if (testing::Test::HasFailure()) FAIL() << "round " << round;
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) tree.set(BoxId(i), absent_box<D>());
  EXPECT_EQ(tree.size(), 0U);
  EXPECT_EQ(tree.nodes(), 0U);
}

TEST(DynamicBvh, HoldsEachBoxOnceAfterRandomChanges) {
  for (const std::string& name : instruction_sets()) {
    SCOPED_TRACE(name);
    const OnInstructionSet on(name);
    expect_random_changes_to_hold<2>();
    expect_random_changes_to_hold<3>();
  }
}

/// follow() and what a tracker does after it: the pairs of each box that toggle, against the boxes as they
/// stand at its turn.
template <int D>
void expect_moves_to_toggle() {
  std::mt19937 random(7);
  DynamicBvh<D> tree;
  std::vector<Box<D>> boxes(500);
  for (Box<D>& box : boxes) box = draw<D>(random);
  tree.build(boxes);
  for (int round = 0; round < 20; ++round) {
    std::vector<core::MovedBox<D>> moved;
    std::vector<Pair> begun;
    std::vector<Pair> ended;
    for (std::uint32_t id = static_cast<std::uint32_t>(round % 3); id < boxes.size(); id += 7) {
      const bool filter_changed = random() % 16 == 0;
      const Box<D> before = boxes[id];
      const Box<D> now = filter_changed ? before : draw<D>(random);
      Box<D> bounds;
      for (int axis = 0; axis < D; ++axis) {
        bounds.min[axis] = std::min(before.min[axis], now.min[axis]);
        bounds.max[axis] = std::max(before.max[axis], now.max[axis]);
      }
      moved.push_back({.before = before,
                       .now = now,
                       .bounds = bounds,
                       .id = BoxId{id},
                       .slot = tree.slot(BoxId{id}),
                       .was_present = true,
                       .is_present = true,
                       .filter_changed = filter_changed});
      for (std::uint32_t other = 0; other < boxes.size(); ++other) {
        if (other == id) continue;
        const bool did = overlap(before, boxes[other]);
        const bool does = overlap(now, boxes[other]);
        const Pair pair{BoxId{std::min(id, other)}, BoxId{std::max(id, other)}};
        if (filter_changed ? did || does : does && !did) begun.push_back(pair);
        if (!filter_changed && did && !does) ended.push_back(pair);
      }
      boxes[id] = now;
    }
    std::vector<Pair> found_begun;
    std::vector<Pair> found_ended;
    std::vector<std::uint8_t> calls_for(moved.size());
    PairCollector begun_pairs(found_begun);
    PairCollector ended_pairs(found_ended);
    const std::uint64_t tests = kernels::follow(tree.writable(), std::span<const core::MovedBox<D>>(moved),
                                                calls_for.data(), begun_pairs, ended_pairs);
    begun_pairs.flush();
    ended_pairs.flush();
    EXPECT_GE(tests, kernels::fan_out * moved.size());
    // Where a leaf touches both boxes of one that jumped, its pairs are found twice.
    const auto sorted = [](std::vector<Pair>& pairs) {
      std::ranges::sort(pairs);
      pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
      return pairs;
    };
    EXPECT_EQ(sorted(found_begun), sorted(begun));
    EXPECT_EQ(sorted(found_ended), sorted(ended));
    for (std::size_t i = 0; i < moved.size(); ++i) {
      if ((calls_for[i] & kernels::left_leaf) != 0)
        tree.reinsert(moved[i].id);
      else if ((calls_for[i] & kernels::may_shrink) != 0)
        tree.refit(moved[i].id);
    }
    expect_whole(tree, boxes, random);
    if (testing::Test::HasFailure()) FAIL() << "round " << round;
  }
}

TEST(DynamicBvh, TellsWhatMovesToggle) {
  for (const std::string& name : instruction_sets()) {
    SCOPED_TRACE(name);
    const OnInstructionSet on(name);
    expect_moves_to_toggle<2>();
    expect_moves_to_toggle<3>();
  }
}

}  // namespace
}  // namespace broadside::algorithm

// DynamicBvh against a list of boxes: whatever was inserted, moved and removed, each box is in it once,
// bounds contain what is below them, and searches on every instruction set find what the definition says.
#include "algorithms/bvh/dynamic_bvh.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/executor.hpp"
#include "broadside/sinks.hpp"

#include "kernels/bvh.hpp"
#include "kernels/bvh_query.hpp"
#include "tests/support/model.hpp"

namespace broadside::algorithm {
namespace {

template <int D>
Box<D> draw(Rng& rng) {
  return random_box<D>(rng, {.places = 400, .max_extent = 24, .infinite_one_in = 256});
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
      EXPECT_TRUE(contains(*bounds, box));
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
void expect_whole(const DynamicBvh<D>& tree, const std::vector<Box<D>>& boxes, Rng& rng) {
  const auto present = static_cast<std::size_t>(std::ranges::count_if(boxes, is_present<D, float>));
  ASSERT_EQ(tree.size(), present);
  if (present == 0) return;
  ASSERT_EQ(boxes_below<D>(tree, boxes, tree.view().root, nullptr), present);
  const Box<D> query = draw<D>(rng);
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

TEST(DynamicBvh, HoldsEachBoxOnceAfterRandomChanges) {
  on_each_instruction_set([]<int D>() {
    Rng rng(D);
    DynamicBvh<D> tree;
    std::vector<Box<D>> boxes(600, absent_box<D>());
    for (int round = 0; round < 200; ++round) {
      if (round % 50 == 0) {
        for (Box<D>& box : boxes) box = rng.one_in(8) ? absent_box<D>() : draw<D>(rng);
        tree.build(boxes);
      }
      for (int change = 0; change < 30; ++change) {
        const std::size_t i = rng.below(boxes.size());
        // At first boxes go, then they come: leaves empty and nodes split.
        const bool goes = round % 50 < 25 ? !rng.one_in(3) : rng.one_in(6);
        boxes[i] = goes ? absent_box<D>() : draw<D>(rng);
        tree.set(BoxId(i), boxes[i]);
      }
      expect_whole(tree, boxes, rng);
      if (testing::Test::HasFailure()) FAIL() << "round " << round;
    }
    for (std::size_t i = 0; i < boxes.size(); ++i) tree.set(BoxId(i), absent_box<D>());
    EXPECT_EQ(tree.size(), 0U);
    EXPECT_EQ(tree.nodes(), 0U);
  });
}

TEST(DynamicBvh, RefitsAllBoundsAfterMostBoxesMoved) {
  on_each_instruction_set([]<int D>() {
    Rng rng(D);
    DynamicBvh<D> tree;
    std::vector<Box<D>> boxes(600);
    for (int round = 0; round < 60; ++round) {
      if (round % 20 == 0) {
        for (Box<D>& box : boxes) box = rng.one_in(8) ? absent_box<D>() : draw<D>(rng);
        tree.build(boxes);
      }
      // Nodes split and vanish in between, and then their numbers no longer follow their levels.
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (rng.one_in(4)) continue;
        boxes[i] = rng.one_in(8) ? absent_box<D>() : draw<D>(rng);
        if (is_present(boxes[i]) && tree.slot(BoxId(i)) != kernels::no_slot)
          tree.overwrite(BoxId(i), boxes[i]);
        else
          tree.set(BoxId(i), boxes[i]);
      }
      tree.refit_all();
      expect_whole(tree, boxes, rng);
      if (testing::Test::HasFailure()) FAIL() << "round " << round;
    }
  });
}

TEST(DynamicBvh, TellsHowManyMoreNodesASearchVisits) {
  const auto square = [](float x, float y) { return Box2{{x, y}, {x + 1, y + 1}}; };
  std::vector<Box2> boxes;
  for (int i = 0; i < 1024; ++i)
    boxes.push_back(square(static_cast<float>(i % 32), static_cast<float>(i / 32)));
  DynamicBvh<2> tree;
  tree.build(boxes);
  EXPECT_NEAR(tree.refit_all(), 1, 1e-6);
  const auto growth = [&](float factor) {
    for (std::size_t i = 0; i < boxes.size(); ++i)
      tree.overwrite(BoxId(i), {{factor * boxes[i].min[0], factor * boxes[i].min[1]},
                                {factor * boxes[i].max[0], factor * boxes[i].max[1]}});
    return tree.refit_all();
  };
  EXPECT_NEAR(growth(3), 1, 1e-6) << "larger everywhere, and shared as before";
  EXPECT_NEAR(growth(0.01F), 1, 1e-6);
  Rng rng(3);
  for (std::size_t i = 0; i < boxes.size(); ++i)
    tree.overwrite(BoxId(i), square(static_cast<float>(rng.below(8)), static_cast<float>(rng.below(8))));
  EXPECT_GT(tree.refit_all(), 4) << "each leaf is wherever the others are";
  tree.build({});
  tree.set(BoxId{0}, square(0, 0));
  tree.overwrite(BoxId{0}, square(5, 5));
  EXPECT_EQ(tree.refit_all(), 1) << "and the former tree is forgotten";
}

/// follow() and what a tracker does after it: the pairs of each box that toggle, against the boxes as they
/// stand at its turn.
TEST(DynamicBvh, TellsWhatMovesToggle) {
  on_each_instruction_set([]<int D>() {
    Rng rng(7);
    DynamicBvh<D> tree;
    std::vector<Box<D>> boxes(500);
    for (Box<D>& box : boxes) box = draw<D>(rng);
    tree.build(boxes);
    for (int round = 0; round < 20; ++round) {
      std::vector<core::MovedBox<D>> moved;
      Changes expected;
      const std::vector<std::uint8_t> none_move(boxes.size(), 0);
      for (std::uint32_t id = static_cast<std::uint32_t>(round % 3); id < boxes.size(); id += 7) {
        const bool filter_changed = rng.one_in(16);
        const Box<D> before = boxes[id];
        const Box<D> now = filter_changed ? before : draw<D>(rng);
        moved.push_back(moved_box(id, before, now, filter_changed));
        moved.back().slot = tree.slot(BoxId{id});
        expected.add<D>(moved.back(), boxes, none_move);
        boxes[id] = now;
      }
      expected.begun.merge(expected.candidates);  // where the filter changed
      std::vector<std::uint8_t> calls_for(moved.size());
      const Changes found = written_changes(none_move, [&](const core::ChangeSinks& sinks) {
        const std::uint64_t tests =
            kernels::follow(tree.writable(), std::span<const core::MovedBox<D>>(moved), calls_for.data(),
                            sinks.begun, sinks.ended);
        EXPECT_GE(tests, kernels::fan_out * moved.size());
      });
      EXPECT_EQ(found.begun, expected.begun);
      EXPECT_EQ(found.ended, expected.ended);
      for (std::size_t i = 0; i < moved.size(); ++i) {
        if ((calls_for[i] & kernels::left_leaf) != 0)
          tree.reinsert(moved[i].id);
        else if ((calls_for[i] & kernels::may_shrink) != 0)
          tree.refit(moved[i].id);
      }
      expect_whole(tree, boxes, rng);
      if (testing::Test::HasFailure()) FAIL() << "round " << round;
    }
  });
}

TEST(DynamicBvh, TellsWhetherAMoveLeftItsLeafAndMayHaveLeftABorder) {
  on_each_instruction_set([]<int D>() {
    Rng rng(9);
    DynamicBvh<D> tree;
    std::vector<Box<D>> boxes(500);
    for (Box<D>& box : boxes) box = draw<D>(rng);
    tree.build(boxes);
    for (int move = 0; move < 300; ++move) {
      const std::size_t id = rng.below(boxes.size());
      core::MovedBox<D> moved = moved_box(id, boxes[id], draw<D>(rng));
      if (rng.one_in(2)) moved = moved_box(id, boxes[id], boxes[id]);  // which stays in any bounds
      moved.slot = tree.slot(BoxId(id));
      const kernels::WritableBvh<D> writable = tree.writable();
      const std::uint32_t parent = writable.info[moved.slot / kernels::fan_out].parent;
      const Box<D> leaf = writable.nodes[parent / kernels::fan_out].box(parent % kernels::fan_out);
      std::uint8_t expected = contains(leaf, moved.now) ? 0 : kernels::left_leaf;
      for (int axis = 0; axis < D; ++axis) {
        if (moved.before.min[axis] == leaf.min[axis] || moved.before.max[axis] == leaf.max[axis])
          expected |= kernels::may_shrink;
      }
      std::uint8_t calls_for = 0;
      PairCounter pairs;
      kernels::follow(writable, std::span<const core::MovedBox<D>>(&moved, 1), &calls_for, pairs, pairs);
      ASSERT_EQ(calls_for, expected) << "move " << move;
      boxes[id] = moved.now;
    }
  });
}

}  // namespace
}  // namespace broadside::algorithm

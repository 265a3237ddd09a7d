// The nodes in which the quadtree follows boxes, against a list of boxes, while boxes come, move and go.
#include "algorithms/quadtree/quadtree_nodes.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/algorithms/moved_frames.hpp"
#include "tests/support/model.hpp"

namespace broadside::algorithm {
namespace {

/// Calls `visit(node)` for each node that is to hold a box.
template <int D, typename Visit>
void nodes_of(const QuadtreeNodes<D>& tree, const Box<D>& box, std::uint32_t at, Visit visit) {
  const QuadtreeNode<D>& node = tree[at];
  const std::uint32_t touched = node.is_leaf() ? 0 : node.touched(box);
  if (node.is_leaf() || node.keeps(box, touched)) {
    visit(at);
    return;
  }
  for (std::uint32_t child = 0; child < QuadtreeNodes<D>::child_count; ++child) {
    if ((touched >> child & 1) != 0) nodes_of(tree, box, node.children + child, visit);
  }
}

TEST(QuadtreeNodes, HoldEachBoxWhereItBelongsWhileNodesSplitAndMerge) {
  in_each_dimension([]<int D>() {
    MovedFrames<D> frames(3000, {.places = 1000, .max_extent = 12, .infinite_one_in = 100});
    QuadtreeNodes<D> tree(16);
    tree.build(frames.boxes);
    std::size_t max_nodes = 0;
    for (int round = 0; round < 30; ++round) {
      std::size_t references = 0;
      std::size_t kept = 0;
      for (std::size_t id = 0; id < frames.boxes.size(); ++id) {
        if (!is_present(frames.boxes[id])) continue;
        nodes_of(tree, frames.boxes[id], QuadtreeNodes<D>::root, [&](std::uint32_t node) {
          const std::uint32_t slot = tree.find(node, BoxId(id));
          ASSERT_NE(slot, kernels::no_slot) << id;
          ASSERT_EQ(tree.pool().box(slot), frames.boxes[id]);
          ++references;
          kept += tree[node].is_leaf() ? 0 : 1;
        });
      }
      ASSERT_EQ(tree.references(), references) << "round " << round;
      ASSERT_EQ(tree.kept(), kept) << "round " << round;
      max_nodes = std::max(max_nodes, tree.node_count());
      frames.step(4);
      for (const core::MovedBox<D>& box : frames.moved) {
        if (round > 20 && !box.was_present) continue;  // in the end boxes only go
        const bool stays = box.is_present && round <= 20;
        if (box.was_present) {
          nodes_of(tree, box.before, QuadtreeNodes<D>::root,
                   [&](std::uint32_t node) { tree.erase(node, tree.find(node, box.id)); });
        }
        QuadtreeHome home;
        if (stays) {
          nodes_of(tree, box.now, QuadtreeNodes<D>::root, [&](std::uint32_t node) {
            const std::uint32_t slot = tree.insert(node, box.now, box.id);
            home = {home.node == no_node ? node : home.node, home.node == no_node ? slot : home.slot,
                    home.node != no_node || !tree[node].is_leaf()};
          });
        }
        tree.home(index(box.id)) = home;
        frames.boxes[index(box.id)] = stays ? box.now : absent_box<D>();
      }
      tree.tidy(frames.boxes);
    }
    EXPECT_LT(tree.node_count(), max_nodes / 2) << "nodes merge as boxes go";
  });
}

}  // namespace
}  // namespace broadside::algorithm

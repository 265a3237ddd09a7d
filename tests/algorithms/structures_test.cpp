// What the trackers of grid, quadtree and sweep and prune keep, against a list of boxes, while boxes come,
// move and go.
#include <algorithm>
#include <array>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "algorithms/grid/hierarchical_cells.hpp"
#include "algorithms/grid/grid_layout.hpp"
#include "algorithms/quadtree/quadtree_nodes.hpp"
#include "algorithms/sweep_and_prune/sweep_order.hpp"
#include "tests/support/model.hpp"

namespace broadside::algorithm {
namespace {

/// Boxes by id, those that are not there being absent, and frames in which some of them change. What comes
/// later may be twice as long as what was there first.
template <int D>
class Frames {
 public:
  Frames(std::size_t count, const BoxKind& kind) : kind_(kind), boxes(count, absent_box<D>()) {
    const BoxKind shorter{kind.places, kind.max_extent / 2, kind.infinite_one_in};
    for (Box<D>& box : boxes) {
      if (!rng.one_in(4)) box = random_box<D>(rng, shorter);
    }
  }

  /// Draws a frame in which one box in `some` comes, moves near or far, or goes.
  void step(std::size_t some) {
    moved.clear();
    moves.assign(boxes.size(), 0);
    for (std::size_t id = 0; id < boxes.size(); ++id) {
      if (!rng.one_in(some)) continue;
      Box<D> now = random_box<D>(rng, kind_);
      if (is_present(boxes[id]) && rng.one_in(3)) now = absent_box<D>();
      if (is_present(boxes[id]) && rng.one_in(3)) {
        now = boxes[id];
        now.max[0] += 1;
      }
      if (!is_present(now) && !is_present(boxes[id])) continue;
      const auto or_nan = [](const Box<D>& box) { return is_present(box) ? box : core::nan_box<D>(); };
      moved.push_back(moved_box(id, or_nan(boxes[id]), or_nan(now), rng.one_in(8)));
      moves[id] = 1;
    }
  }

  /// Brings the list up to the frame.
  void apply() {
    for (const core::MovedBox<D>& box : moved)
      boxes[index(box.id)] = box.is_present ? box.now : absent_box<D>();
  }

  /// The boxes with nan_box() for those that are absent, or that move and are left out.
  std::vector<Box<D>> others(bool with_moved) const {
    std::vector<Box<D>> others = boxes;
    for (std::size_t id = 0; id < others.size(); ++id) {
      if (!is_present(others[id]) || (!with_moved && moves[id] != 0)) others[id] = core::nan_box<D>();
    }
    return others;
  }

 private:
  BoxKind kind_;

 public:
  Rng rng{11};
  std::vector<Box<D>> boxes;
  std::vector<core::MovedBox<D>> moved;
  std::vector<std::uint8_t> moves;
};

TEST(HierarchicalCells, TellWhatMovedBoxesChange) {
  on_each_instruction_set([]<int D>() {
    for (const BoxKind& kind : {BoxKind{}, BoxKind{.places = 400, .max_extent = 20, .infinite_one_in = 400},
                                BoxKind{.places = 300, .max_extent = 90, .infinite_one_in = 0}}) {
      Frames<D> frames(300, kind);
      HierarchicalCells<D> cells(std::nullopt);
      cells.build(frames.boxes, frames.boxes);
      for (int round = 0; round < 12; ++round) {
        for (const core::MovedBox<D>& box : frames.moved) {
          if (box.is_present) cells.settle(box.id, box.now);
        }
        frames.step(1 + frames.rng.below(6));
        Changes expected;
        std::set<Pair> of_two_moved;
        for (const core::MovedBox<D>& box : frames.moved) {
          expected.add<D>(box, frames.others(false), frames.moves);
          for (const core::MovedBox<D>& other : frames.moved) {
            const bool did = overlap(box.before, other.before);
            const bool does = overlap(box.now, other.now);
            if (box.id < other.id && did != does)
              of_two_moved.insert(ordered(index(box.id), index(other.id)));
          }
        }
        for (core::MovedBox<D>& box : frames.moved) cells.move(box);
        Changes found = written_changes(frames.moves, [&](const core::ChangeSinks& sinks) {
          kernels::find_changes(cells.view(), std::span<const core::MovedBox<D>>(frames.moved), sinks);
        });
        cells.drop_stale();
        frames.apply();
        EXPECT_TRUE(std::ranges::includes(found.candidates, of_two_moved));
        std::erase_if(found.candidates, [&](Pair pair) {
          return frames.moves[index(pair.first)] != 0 && frames.moves[index(pair.second)] != 0;
        });
        EXPECT_EQ(found, expected);
        EXPECT_EQ(cells.boxes(),
                  static_cast<std::size_t>(std::ranges::count_if(frames.boxes, is_present<D, float>)));
        if (testing::Test::HasFailure()) FAIL() << "round " << round;
      }
    }
  });
}

TEST(SweepOrder, StaysSortedAndTellsWhatMovedBoxesChange) {
  on_each_instruction_set([]<int D>() {
    Frames<D> frames(400, {.places = 100});
    SweepOrder<D> order;
    const auto assign = [&] {
      std::vector<SweepEntry> entries;
      for (std::size_t id = 0; id < frames.boxes.size(); ++id) {
        if (is_present(frames.boxes[id]))
          entries.push_back({{frames.boxes[id].min[0], BoxId(id)}, SweepEntry::is_new});
      }
      std::sort(entries.begin(), entries.end());
      order.assign(entries, [&](BoxId id) { return frames.boxes[index(id)]; });
    };
    assign();
    for (int round = 0; round < 10; ++round) {
      frames.step(1 + frames.rng.below(6));
      bool comes_or_goes = false;
      for (const core::MovedBox<D>& box : frames.moved) {
        comes_or_goes |= !box.was_present || !box.is_present;
        if (!box.was_present) continue;
        const SweepKey key{box.before.min[0], box.id};
        const std::size_t place = order.find(key, frames.rng.below(order.size() + 1));
        ASSERT_EQ(place, order.find(key));
        ASSERT_EQ(order.key(place).id, box.id);
        Changes expected;
        expected.add<D>(box, frames.others(true), frames.moves);
        ASSERT_EQ(
            written_changes(frames.moves,
                            [&](const core::ChangeSinks& sinks) { order.find_changes(box, place, sinks); }),
            expected);
        if (box.is_present)
          order.move(place, box.now);
        else
          order.remove(place);
        frames.boxes[index(box.id)] = box.is_present ? box.now : absent_box<D>();
      }
      frames.apply();
      if (comes_or_goes) assign();
      for (std::size_t place = 0; place < order.size(); ++place) {
        ASSERT_EQ(order.box(place), frames.boxes[index(order.key(place).id)]);
        ASSERT_TRUE(place == 0 || order.key(place - 1) < order.key(place));
      }
    }
  });
}

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
    Frames<D> frames(3000, {.places = 1000, .max_extent = 12, .infinite_one_in = 100});
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

TEST(GridLayout, HasACoordinateInTheCellBetweenTwoBorders) {
  in_each_dimension([]<int D>() {
    Rng rng(5);
    std::vector<Box<D>> boxes(20'000);
    for (Box<D>& box : boxes) {
      for (int axis = 0; axis < D; ++axis) {
        box.min[axis] = rng.between(-500, 500);
        box.max[axis] = box.min[axis] + rng.unit();
      }
    }
    core::Sample<D> sample;
    sample.take(boxes);
    for (const std::optional<double> cell : {std::optional<double>(), std::optional<double>(13)}) {
      GridLayout<D> layout;
      layout.choose(sample, boxes.size(), cell);
      ASSERT_GT(layout.rows(), 2U);
      EXPECT_EQ(layout.cells(), layout.rows() * layout.row_length());
      if (cell) {
        EXPECT_NEAR(layout.cell_size(0), 13, 0.5);
      }
      for (const Box<D>& box : boxes) {
        const std::size_t row = layout.row_of(box);
        const float coordinate = box.min[layout.axes()[D - 1]];
        ASSERT_LT(row, layout.rows());
        ASSERT_FALSE(coordinate >= layout.row_border(row));
        ASSERT_TRUE(row == 0 || coordinate >= layout.row_border(row - 1));
        ASSERT_LE(layout.slab_begin(layout.slab_of(row)), row);
        ASSERT_LT(row, layout.slab_begin(layout.slab_of(row) + 1));
      }
    }
  });
}

}  // namespace
}  // namespace broadside::algorithm

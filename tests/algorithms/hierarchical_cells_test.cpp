// The cells in which the grid follows boxes, against a list of boxes, while boxes come, move and go.
#include "algorithms/grid/hierarchical_cells.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/algorithms/moved_frames.hpp"
#include "tests/support/model.hpp"

namespace broadside::algorithm {
namespace {

TEST(HierarchicalCells, TellWhatMovedBoxesChange) {
  on_each_instruction_set([]<int D>() {
    for (const BoxKind& kind : {BoxKind{}, BoxKind{.places = 400, .max_extent = 20, .infinite_one_in = 400},
                                BoxKind{.places = 300, .max_extent = 90, .infinite_one_in = 0}}) {
      MovedFrames<D> frames(300, kind);
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

}  // namespace
}  // namespace broadside::algorithm

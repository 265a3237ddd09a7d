// The cells in which the grid follows boxes, against a list of boxes, while boxes come, move and go.
#include "algorithms/grid/hierarchical_cells.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

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
        Changes found = written_changes(frames.moves, [&](core::ChangeSinks sinks) {
          sinks.all_placed = round % 2 == 1;
          const std::size_t movers = round % 3 == 0 ? 0 : frames.moved.size();
          kernels::find_changes(cells.view(movers), std::span<const core::MovedBox<D>>(frames.moved), sinks);
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

TEST(HierarchicalCells, TellAPairOfTwoMovedBoxesOnceIfAllAreInTheirPlaces) {
  on_each_instruction_set([]<int D>() {
    constexpr std::uint32_t count = 40;
    std::vector<Box<D>> boxes(count);
    std::vector<core::MovedBox<D>> moved;
    for (std::uint32_t i = 0; i < count; ++i) {
      boxes[i].min.fill(static_cast<float>(i));
      boxes[i].max.fill(static_cast<float>(i) + 1);
      Box<D> now = boxes[i];
      now.max.fill(now.min[0] + 1.5F);
      moved.push_back(moved_box(i, boxes[i], now, false));
    }
    HierarchicalCells<D> cells(std::nullopt);
    cells.build(boxes, boxes);
    for (core::MovedBox<D>& box : moved) cells.move(box);
    for (const bool all_placed : {false, true}) {
      PairCounter none;
      PairCounter candidates;
      const std::vector<std::uint8_t> moves(count, 1);
      core::ChangeSinks sinks{none, none, candidates, moves.data()};
      sinks.all_placed = all_placed;
      kernels::find_changes(cells.view(count), std::span<const core::MovedBox<D>>(moved), sinks);
      none.flush();
      candidates.flush();
      EXPECT_EQ(none.count(), 0u);
      EXPECT_EQ(candidates.count(), all_placed ? count - 1 : 2 * (count - 1));
    }
  });
}

}  // namespace
}  // namespace broadside::algorithm

// The order in which sweep and prune follows boxes, against a list of boxes, while boxes come, move and go.
#include "algorithms/sweep_and_prune/sweep_order.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/algorithms/moved_frames.hpp"
#include "tests/support/model.hpp"

namespace broadside::algorithm {
namespace {

TEST(SweepOrder, StaysSortedAndTellsWhatMovedBoxesChange) {
  on_each_instruction_set([]<int D>() {
    MovedFrames<D> frames(400, {.places = 100});
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

}  // namespace
}  // namespace broadside::algorithm

// The kernels of trackers on every instruction set: what moved boxes begin and cease to overlap, by
// definition.
#include "kernels/find_changes.hpp"

#include <algorithm>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/executor.hpp"
#include "broadside/sinks.hpp"

#include "tests/support/model.hpp"

namespace broadside::kernels {
namespace {

template <int D>
Box<D> box_or_none(Rng& rng) {
  return rng.one_in(8) ? nan_box<D>() : random_box<D>(rng, {.places = 12, .max_extent = 5});
}

/// Boxes that rest, by id, and some that move, with greater ids.
template <int D>
struct Scene {
  Scene(Rng& rng, std::size_t resting, std::size_t moving) : moves(resting + moving, 0) {
    for (std::size_t i = 0; i < resting; ++i) boxes.push_back(box_or_none<D>(rng));
    for (std::size_t i = resting; i < resting + moving; ++i) {
      moved.push_back(moved_box(i, box_or_none<D>(rng), box_or_none<D>(rng), rng.one_in(4)));
      moves[i] = 1;
    }
    if (resting > 0) moves[0] = 1;  // listed, but where it was
  }

  std::vector<Box<D>> boxes;
  std::vector<MovedBox<D>> moved;
  std::vector<std::uint8_t> moves;
};

/// Calls `body(scene)` for 0 to 70 boxes.
template <typename Body>
void on_scenes(Body body) {
  on_each_instruction_set([&]<int D>() {
    Rng rng(23);
    for (std::size_t size = 0; size <= 70 && !testing::Test::HasFailure(); ++size) {
      SCOPED_TRACE(size);
      body(Scene<D>(rng, size, size % 7));
    }
  });
}

TEST(Moved, MeetBoxesInChainsOfBlocks) {
  on_scenes([]<int D>(const Scene<D>& scene) {
    BlockPool<D> pool;
    std::uint32_t first = no_slot;
    for (std::uint32_t id = 0; id < scene.boxes.size(); ++id) {
      if (first == no_slot || pool.is_full(first)) pool.add_block(first, 0);
      pool.insert(first, scene.boxes[id], BoxId{id});
    }
    std::vector<BlockTask> tasks;
    for (std::uint32_t i = 0; i < scene.moved.size() && first != no_slot; ++i) tasks.push_back({i, first});
    Changes expected;
    for (const MovedBox<D>& box : scene.moved) expected.add<D>(box, scene.boxes, scene.moves);
    EXPECT_EQ(written_changes(scene.moves,
                              [&](const core::ChangeSinks& sinks) {
                                const auto work = find_changes<D>(pool.view(), scene.moved, tasks, sinks);
                                EXPECT_EQ(work.tests, scene.boxes.size() * tasks.size());
                              }),
              expected);
  });
}

TEST(Moved, MeetAnotherMovedBoxInABlockAsACandidateUnlessItIsTheirOwn) {
  on_scenes([]<int D>(Scene<D> scene) {
    if (scene.moved.size() < 2) return;
    BlockPool<D> pool;
    std::uint32_t first = no_slot;
    pool.add_block(first, 0);
    for (MovedBox<D>& box : scene.moved) {
      box.slot = pool.insert(first, box.now, box.id);
      pool.mark(box.slot);
    }
    Changes expected;
    std::vector<BlockTask> tasks;
    for (std::uint32_t i = 0; i < scene.moved.size(); ++i) {
      tasks.push_back({i, first});
      const MovedBox<D>& box = scene.moved[i];
      for (const MovedBox<D>& other : scene.moved) {
        if (other.id != box.id && (overlap(box.before, other.now) || overlap(box.now, other.now)))
          expected.candidates.insert(ordered(index(box.id), index(other.id)));
      }
    }
    EXPECT_EQ(written_changes(scene.moves,
                              [&](const core::ChangeSinks& sinks) {
                                find_changes<D>(pool.view(), scene.moved, tasks, sinks);
                              }),
              expected);
  });
}

TEST(Moved, MeetBoxesInAWindowOfARun) {
  on_scenes([]<int D>(const Scene<D>& scene) {
    RunBuffer<D> buffer;
    buffer.reserve(scene.boxes.size());
    for (std::size_t i = 0; i < scene.boxes.size(); ++i) buffer.append(scene.boxes[i], BoxId(i));
    const std::size_t begin = scene.boxes.size() / 3;
    std::vector<Box<D>> in_window = scene.boxes;
    std::fill_n(in_window.begin(), begin, nan_box<D>());
    Changes expected;
    for (const MovedBox<D>& box : scene.moved) expected.add<D>(box, in_window, scene.moves);
    const kernels::Run<D> run = buffer.view(nullptr);
    EXPECT_EQ(written_changes(scene.moves,
                              [&](const core::ChangeSinks& sinks) {
                                for (const MovedBox<D>& box : scene.moved)
                                  find_changes(run, begin, scene.boxes.size(), box, sinks);
                              }),
              expected);
  });
}

}  // namespace
}  // namespace broadside::kernels

// The kernels of trackers on every instruction set there is: what moved boxes begin and cease to overlap, by
// definition.
#include "kernels/moved.hpp"

#include <limits>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/executor.hpp"
#include "broadside/sinks.hpp"

#include "tests/instruction_sets.hpp"

namespace broadside::kernels {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

struct Events {
  Pairs begun;
  Pairs ended;
  Pairs candidates;

  friend bool operator==(const Events&, const Events&) = default;
};

template <int D>
Box<D> draw(std::mt19937& random) {
  if (random() % 8 == 0) return nan_box<D>();
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = static_cast<float>(random() % 12);
    box.max[axis] = box.min[axis] + static_cast<float>(random() % 6);
    if (random() % 16 == 0) box.min[axis] = -infinity;
    if (random() % 16 == 0) box.max[axis] = infinity;
  }
  return box;
}

/// Boxes that rest, by id, and some that move, with greater ids.
template <int D>
struct Scene {
  Scene(std::mt19937& random, std::size_t resting, std::size_t moving) {
    for (std::size_t i = 0; i < resting; ++i) boxes.push_back(draw<D>(random));
    for (std::size_t i = 0; i < moving; ++i) {
      MovedBox<D> box{.before = draw<D>(random),
                      .now = draw<D>(random),
                      .bounds = {},
                      .id = BoxId(resting + i),
                      .was_present = true,
                      .is_present = true,
                      .filter_changed = random() % 4 == 0};
      moved.push_back(box);
    }
    moves.assign(resting, 0);
    moves.insert(moves.end(), moving, 1);
    if (resting > 0) moves[0] = 1;  // listed, but where it was
  }

  /// What the moved ones change, each with all that rest.
  Events expected() const {
    Events events;
    for (const MovedBox<D>& box : moved) {
      for (std::uint32_t other = 0; other < boxes.size(); ++other) {
        const bool was = overlap(box.before, boxes[other]);
        const bool is = overlap(box.now, boxes[other]);
        const std::pair<std::uint32_t, std::uint32_t> pair(other, index(box.id));
        if ((was || is) && box.filter_changed)
          events.candidates.insert(pair);
        else if (was != is)
          (moves[other] != 0 ? events.candidates : is ? events.begun : events.ended).insert(pair);
      }
    }
    return events;
  }

  std::vector<Box<D>> boxes;
  std::vector<MovedBox<D>> moved;
  std::vector<std::uint8_t> moves;
};

/// The events that `find(sinks)` writes.
template <typename Find>
Events found(const std::vector<std::uint8_t>& moves, Find find) {
  std::vector<Pair> lists[3];
  {
    PairCollector begun(lists[0]);
    PairCollector ended(lists[1]);
    PairCollector candidates(lists[2]);
    find(core::ChangeSinks{begun, ended, candidates, moves.data()});
    for (PairCollector* sink : {&begun, &ended, &candidates}) sink->flush();
  }
  Events events;
  for (const auto& [from, to] : {std::pair(&lists[0], &events.begun), std::pair(&lists[1], &events.ended),
                                 std::pair(&lists[2], &events.candidates)}) {
    for (const Pair pair : *from) to->insert(std::minmax(index(pair.first), index(pair.second)));
  }
  return events;
}

/// Runs `body.operator()<D>(scene)` on every instruction set, for 0 to 70 boxes.
template <typename Body>
void on_all(Body body) {
  for (const std::string& name : instruction_sets()) {
    const OnInstructionSet chosen(name);
    ASSERT_EQ(instruction_set(), name);
    SCOPED_TRACE(name);
    std::mt19937 random(23);
    for (std::size_t size = 0; size <= 70 && !testing::Test::HasFailure(); ++size) {
      body.template operator()<2>(Scene<2>(random, size, size % 7));
      body.template operator()<3>(Scene<3>(random, size, size % 7));
    }
  }
}

TEST(Moved, MeetBoxesInChainsOfBlocks) {
  on_all([]<int D>(const Scene<D>& scene) {
    BlockPool<D> pool;
    std::uint32_t first = no_slot;
    for (std::uint32_t id = 0; id < scene.boxes.size(); ++id) {
      if (first == no_slot || pool.is_full(first)) pool.add_block(first, 0);
      pool.insert(first, scene.boxes[id], BoxId{id});
    }
    std::vector<BlockTask> tasks;
    for (std::uint32_t i = 0; i < scene.moved.size() && first != no_slot; ++i) tasks.push_back({i, first});
    EXPECT_EQ(found(scene.moves,
                    [&](const core::ChangeSinks& sinks) {
                      const core::ChangeWork work = find_changes<D>(pool.view(), scene.moved, tasks, sinks);
                      EXPECT_EQ(work.tests, scene.boxes.size() * tasks.size());
                    }),
              scene.expected())
        << scene.boxes.size() << " boxes";
  });
}

TEST(Moved, MeetAnotherMovedBoxInABlockAsACandidateUnlessItIsTheirOwn) {
  on_all([]<int D>(Scene<D> scene) {
    if (scene.moved.size() < 2) return;
    BlockPool<D> pool;
    std::uint32_t first = no_slot;
    pool.add_block(first, 0);
    Events expected;
    for (MovedBox<D>& box : scene.moved) {
      box.slot = pool.insert(first, box.now, box.id);
      pool.mark(box.slot);
    }
    std::vector<BlockTask> tasks;
    for (std::uint32_t i = 0; i < scene.moved.size(); ++i) {
      tasks.push_back({i, first});
      for (const MovedBox<D>& other : scene.moved) {
        const MovedBox<D>& box = scene.moved[i];
        if (other.id != box.id && (overlap(box.before, other.now) || overlap(box.now, other.now)))
          expected.candidates.insert(std::minmax(index(box.id), index(other.id)));
      }
    }
    EXPECT_EQ(found(scene.moves,
                    [&](const core::ChangeSinks& sinks) {
                      find_changes<D>(pool.view(), scene.moved, tasks, sinks);
                    }),
              expected);
  });
}

TEST(Moved, MeetBoxesInAWindowOfARun) {
  on_all([]<int D>(const Scene<D>& scene) {
    RunBuffer<D> buffer;
    buffer.reserve(scene.boxes.size());
    for (std::size_t i = 0; i < scene.boxes.size(); ++i) buffer.append(scene.boxes[i], BoxId(i));
    const std::size_t begin = scene.boxes.size() / 3;
    Events expected = scene.expected();
    for (Pairs* pairs : {&expected.begun, &expected.ended, &expected.candidates})
      std::erase_if(*pairs, [begin](const auto& pair) { return pair.first < begin; });
    const kernels::Run<D> run = buffer.view();
    EXPECT_EQ(found(scene.moves,
                    [&](const core::ChangeSinks& sinks) {
                      for (const MovedBox<D>& box : scene.moved)
                        find_changes(run, begin, scene.boxes.size(), box, sinks);
                    }),
              expected)
        << scene.boxes.size() << " boxes";
  });
}

}  // namespace
}  // namespace broadside::kernels

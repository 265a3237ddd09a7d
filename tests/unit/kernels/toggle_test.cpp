// The kernels of trackers on every instruction set there is: what a box's step toggles, by definition.
#include "kernels/toggle.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/box.hpp"
#include "broadside/instruction_set.hpp"

#include "tests/instruction_sets.hpp"

namespace broadside::kernels {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

using Ids = std::vector<std::uint32_t>;

struct Events {
  Ids begun;
  Ids ended;

  friend bool operator==(const Events&, const Events&) = default;
};

template <int D>
Box<D> draw(std::mt19937& random) {
  if (random() % 8 == 0) return absent_box<D>();
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = static_cast<float>(random() % 12);
    box.max[axis] = box.min[axis] + static_cast<float>(random() % 6);
    if (random() % 16 == 0) box.min[axis] = -infinity;
    if (random() % 16 == 0) box.max[axis] = infinity;
  }
  return box;
}

/// What the step of mover `id` toggles among `boxes`, whose ids are their places.
template <int D>
Events toggled(const std::vector<Box<D>>& boxes, std::uint32_t id, const Box<D>& before, const Box<D>& now,
               bool refiltered) {
  Events events;
  for (std::uint32_t other = 0; other < boxes.size(); ++other) {
    if (other == id || !is_present(boxes[other])) continue;
    const bool did = is_present(before) && overlap(before, boxes[other]);
    const bool does = is_present(now) && overlap(now, boxes[other]);
    if (does && (!did || refiltered)) events.begun.push_back(other);
    if (did && !does) events.ended.push_back(other);
  }
  return events;
}

/// Runs `body.operator()<D>(boxes, id, before, now, refiltered)` on every instruction set, for 0 to 70 boxes.
template <typename Body>
void on_all(Body body) {
  for (const std::string& name : instruction_sets()) {
    const OnInstructionSet chosen(name);
    ASSERT_EQ(instruction_set(), name);
    SCOPED_TRACE(name);
    std::mt19937 random(23);
    const auto in_dimension = [&]<int D>(std::uint32_t size) {
      std::vector<Box<D>> boxes(size);
      for (Box<D>& box : boxes) box = draw<D>(random);
      const auto id = static_cast<std::uint32_t>(random() % (size + 1));  // perhaps none of them
      const Box<D> before = id < size ? boxes[id] : draw<D>(random);
      body.template operator()<D>(boxes, id, before, draw<D>(random), random() % 3 == 0);
    };
    for (std::uint32_t size = 0; size <= 70; ++size) {
      for (int times = 0; times < 4; ++times) {
        in_dimension.template operator()<2>(size);
        in_dimension.template operator()<3>(size);
        if (testing::Test::HasFailure()) return;
      }
    }
  }
}

TEST(Toggle, IsFoundInARunOnEveryInstructionSet) {
  on_all([]<int D>(const std::vector<Box<D>>& boxes, std::uint32_t id, const Box<D>& before,
                   const Box<D>& now, bool refiltered) {
    RunBuffer<D> buffer;
    buffer.reserve(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      Box<D> box = boxes[i];
      if (!is_present(box)) box.min[0] = nan;
      buffer.append(box, BoxId(i));
    }
    std::vector<Toggle> toggles(boxes.size());
    // From the middle on, since a window need not begin with the run.
    const std::size_t begin = boxes.size() / 3;
    const std::size_t count = find_toggles(mover_of(before, now, BoxId{id}, refiltered), buffer.view(), begin,
                                           boxes.size(), toggles.data());
    Events events;
    for (std::size_t i = 0; i < count; ++i)
      (toggles[i].overlaps ? events.begun : events.ended).push_back(index(toggles[i].id));
    Events expected = toggled(boxes, id, before, now, refiltered);
    for (Ids* ids : {&expected.begun, &expected.ended})
      std::erase_if(*ids, [begin](std::uint32_t other) { return other < begin; });
    EXPECT_EQ(events, expected) << boxes.size() << " boxes";
  });
}

TEST(Toggle, IsFoundInBlocksOnEveryInstructionSetAndTheMoverIsBroughtUpToDate) {
  on_all([]<int D>(const std::vector<Box<D>>& boxes, std::uint32_t id, const Box<D>& before,
                   const Box<D>& now, bool refiltered) {
    // What stands at a place that is not filled, and at the last one, must not matter.
    std::vector<Block<D>> blocks(boxes.size() / Block<D>::capacity + 1);
    for (Block<D>& block : blocks) {
      std::fill_n(block.min[0], Block<D>::places, nan);
      std::fill_n(block.id, Block<D>::places, 0xffffffffU);
      block.id[Block<D>::capacity] = id;
    }
    const auto place_of = [&](std::size_t i) -> std::pair<Block<D>&, std::size_t> {
      return {blocks[i / Block<D>::capacity], i % Block<D>::capacity};
    };
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!is_present(boxes[i])) continue;
      const auto [block, place] = place_of(i);
      for (int axis = 0; axis < D; ++axis) {
        block.min[axis][place] = boxes[i].min[axis];
        block.max[axis][place] = boxes[i].max[axis];
      }
      block.id[place] = static_cast<std::uint32_t>(i);
    }
    std::vector<Block<D>*> list;
    for (Block<D>& block : blocks) list.push_back(&block);
    const std::size_t room = (blocks.size() + 1) * Block<D>::places;
    Ids begun(room);
    Ids ended(room);
    StepEvents step{begun.data(), ended.data()};
    take_step(mover_of(before, now, BoxId{id}, refiltered), list.data(), list.size(), step);
    begun.resize(step.begun_count);
    ended.resize(step.ended_count);
    EXPECT_EQ((Events{begun, ended}), toggled(boxes, id, before, now, refiltered))
        << boxes.size() << " boxes";
    EXPECT_EQ(step.hits, toggled(boxes, id, before, now, true).begun.size());
    if (id >= boxes.size() || !is_present(before) || !is_present(now)) return;
    const auto [block, place] = place_of(id);
    for (int axis = 0; axis < D; ++axis) {
      EXPECT_EQ(block.min[axis][place], now.min[axis]);
      EXPECT_EQ(block.max[axis][place], now.max[axis]);
    }
    for (const Block<D>& one : blocks) EXPECT_EQ(one.id[Block<D>::capacity], id);
  });
}

}  // namespace
}  // namespace broadside::kernels

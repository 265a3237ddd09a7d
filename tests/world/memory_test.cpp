// World: what it holds, what it gives back, and that a steady state takes no memory.
#include "lab/measure/memory.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <ostream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "tests/world/handle_pairs.hpp"

namespace broadside {
namespace {

/// Boxes in rows, each of which overlaps its neighbours.
Box2 in_row(std::size_t i) {
  const auto x = static_cast<float>(i % 256);
  const auto y = static_cast<float>(i / 256);
  return {{x, y * 2}, {x + 1, y * 2 + 1}};
}

std::vector<Handle> fill(World2& world, std::size_t count) {
  std::vector<Box2> boxes(count);
  for (std::size_t i = 0; i < count; ++i) boxes[i] = in_row(i);
  std::vector<Handle> handles(count);
  world.add(boxes, handles);
  return handles;
}

TEST(WorldMemory, SaysWhatThereIs) {
  World2 world("brute_force");
  EXPECT_EQ(world.statistics().bytes.boxes, 0u);
  const std::vector<Handle> handles = fill(world, 100);
  world.remove(handles[0]);
  world.update();
  const WorldStatistics statistics = world.statistics();
  EXPECT_EQ(statistics.boxes, 99u);
  EXPECT_EQ(statistics.slots, 100u);
  EXPECT_EQ(statistics.pairs, 98u);
  EXPECT_EQ(statistics.begun, 98u);
  EXPECT_EQ(statistics.ended, 0u);
  EXPECT_GE(statistics.bytes.boxes, 100 * sizeof(Box2));
  EXPECT_GE(statistics.bytes.pairs, 98 * sizeof(HandlePair));
  EXPECT_GE(statistics.bytes.tracker, 100 * sizeof(Box2));
  EXPECT_EQ(statistics.bytes.filters, 0u);
  EXPECT_GE(statistics.bytes.total(), statistics.bytes.boxes + statistics.bytes.slots +
                                          statistics.bytes.pairs + statistics.bytes.tracker);
  world.set_filter(handles[1], {.mask = 0});
  EXPECT_GE(world.statistics().bytes.filters, 100 * sizeof(Filter));
  world.update();
  EXPECT_EQ(world.statistics().pairs, 97u);
  EXPECT_EQ(world.statistics().ended, 1u);
}

TEST(WorldMemory, SaysWhatTheTrackerChose) {
  World2 world("auto");
  fill(world, 10);
  world.update();
  EXPECT_FALSE(world.statistics().explanation.empty());
}

TEST(WorldMemory, ShortensTheArrayWhenTheLastSlotsAreFree) {
  World2 world("brute_force");
  const std::vector<Handle> handles = fill(world, 1000);
  world.update();
  world.remove(std::span(handles).subspan(10));
  world.update();
  world.update();
  EXPECT_EQ(world.statistics().slots, 10u);
  EXPECT_THROW(static_cast<void>(world.box(handles[500])), InvalidHandle);
  const std::vector<Handle> again = fill(world, 1000);
  EXPECT_TRUE(std::ranges::none_of(again, [&](Handle handle) {
    return std::ranges::find(handles, handle) != handles.end();
  })) << "no handle names two boxes";
  EXPECT_THROW(static_cast<void>(world.box(handles[500])), InvalidHandle);
  world.update();
  EXPECT_EQ(world.statistics().pairs, 996u + 9u + 29u);
}

TEST(WorldMemory, RetiresASlotWhoseGenerationsAreUsedUp) {
  constexpr std::uint32_t last = std::numeric_limits<std::uint32_t>::max();
  WorldOptions options;
  options.first_generation = last - 1;
  World2 world(options);
  for (const std::uint32_t generation : {last - 1, last}) {
    const Handle handle = world.add(in_row(0));
    EXPECT_EQ(handle, (Handle{0, generation}));
    world.remove(handle);
    world.update();
    world.update();
  }
  EXPECT_EQ(world.add(in_row(0)), (Handle{1, last - 1}));
  EXPECT_FALSE(world.contains({0, 0}));
  EXPECT_FALSE(world.contains({0, last}));
  EXPECT_THROW(static_cast<void>(world.box({0, last})), InvalidHandle);
}

TEST(WorldMemory, ReturnsWhatIsNoLongerNeeded) {
  for (const char* const spec : {"auto", "bvh", "grid", "sweep_and_prune", "quadtree"}) {
    SCOPED_TRACE(spec);
    World2 fresh(spec);
    fill(fresh, 1000);
    fresh.update();
    fresh.shrink_to_fit();
    World2 world(spec);
    const std::vector<Handle> handles = fill(world, 20'000);
    world.update();
    EXPECT_FALSE(world.pairs().empty());
    world.remove(std::span(handles).subspan(1000));
    world.update();
    EXPECT_TRUE(world.persisting().size() == world.pairs().size());
    world.update();
    EXPECT_LE(world.statistics().bytes.total(), 2 * fresh.statistics().bytes.total()) << "by itself";
    world.shrink_to_fit();
    EXPECT_LE(world.statistics().bytes.total(), fresh.statistics().bytes.total() * 12 / 10) << "when asked";
    EXPECT_EQ(listed(world.pairs()), listed(fresh.pairs()));
  }
}

TEST(WorldMemory, ShrinksWithoutAnEventLostOrSeenTwice) {
  World2 world("bvh");
  const std::vector<Handle> handles = fill(world, 10);
  world.update();
  world.move(handles[9], in_row(1000));
  world.shrink_to_fit();
  const Events events = world.update();
  EXPECT_EQ(listed(events.ended), (HandlePairs{{handles[8], handles[9]}}));
  EXPECT_TRUE(events.begun.empty());
  world.shrink_to_fit();
  EXPECT_TRUE(world.update().begun.empty());
  world.move(handles[9], in_row(9));
  EXPECT_EQ(listed(world.update().begun), (HandlePairs{{handles[8], handles[9]}}));
}

TEST(WorldMemory, TellsPersistingPairsFromThoseThatBegan) {
  World2 world("brute_force");
  const std::vector<Handle> handles = fill(world, 3);
  world.update();
  EXPECT_TRUE(world.persisting().empty());
  const Handle late = world.add(in_row(3));
  world.update();
  EXPECT_EQ(listed(world.persisting()), (HandlePairs{{handles[0], handles[1]}, {handles[1], handles[2]}}));
  EXPECT_EQ(listed(world.pairs()).back(), (HandlePair{handles[2], late}));
  world.remove(handles[0]);
  world.update();
  EXPECT_EQ(listed(world.persisting()), (HandlePairs{{handles[1], handles[2]}, {handles[2], late}}));
}

TEST(WorldMemory, KeepsNoPairsIfToldSo) {
  WorldOptions options;
  options.keep_pairs = false;
  World2 world(options);
  fill(world, 300);
  EXPECT_EQ(world.update().begun.size(), 298u);
  EXPECT_EQ(world.statistics().pairs, 298u);
  EXPECT_THROW(static_cast<void>(world.pairs()), std::logic_error);
  EXPECT_THROW(static_cast<void>(world.persisting()), std::logic_error);
}

/// Every own algorithm, and what it is like when the world is asked for more.
struct SteadyCase {
  std::string name;
  WorldOptions options;
};

void PrintTo(const SteadyCase& steady, std::ostream* out) { *out << steady.name; }

std::vector<SteadyCase> steady_cases() {
  std::vector<SteadyCase> cases;
  for (const Algorithm& algorithm : algorithms()) {
    if (algorithm.kind != AlgorithmKind::own) continue;
    SteadyCase steady{algorithm.name, {}};
    steady.options.algorithm = algorithm.name;
    cases.push_back(steady);
    steady.name += "_with_margin";
    steady.options.margin = 0.25;
    cases.push_back(steady);
  }
  return cases;
}

class WorldSteadyState : public testing::TestWithParam<SteadyCase> {};

TEST_P(WorldSteadyState, TakesNoMemory) {
  if (!lab::AllocationMeter().read()) GTEST_SKIP() << "this build does not count allocations";
  World2 world(GetParam().options);
  std::vector<Handle> handles = fill(world, 3000);
  std::vector<Box2> boxes(handles.size());
  // The same eight frames again and again: some drift and come back, some go and others come.
  const auto cycle = [&] {
    for (int frame = 0; frame < 8; ++frame) {
      for (std::size_t i = 0; i < 300; ++i) {
        Box2 box = in_row(i * 7 % 3000);
        box.min[0] += 0.25F * static_cast<float>(frame % 4);
        box.max[0] += 0.25F * static_cast<float>(frame % 4);
        world.move(handles[i * 7 % 3000], box);
      }
      const std::span<Handle> replaced = std::span(handles).subspan(static_cast<std::size_t>(frame) * 30, 30);
      world.remove(replaced);
      for (std::size_t i = 0; i < 30; ++i) boxes[i] = in_row(static_cast<std::size_t>(frame) * 30 + i);
      world.add(std::span<const Box2>(boxes).first(30), replaced);
      world.update();
      static_cast<void>(world.pairs());
      static_cast<void>(world.persisting());
    }
  };
  for (int i = 0; i < 12; ++i) cycle();
  const lab::AllocationMeter meter;
  for (int i = 0; i < 4; ++i) cycle();
  EXPECT_EQ(meter.read()->kept, 0);
  EXPECT_EQ(meter.read()->peak, 0);
}

INSTANTIATE_TEST_SUITE_P(Own, WorldSteadyState, testing::ValuesIn(steady_cases()),
                         [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace broadside

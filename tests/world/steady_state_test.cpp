// A world whose boxes go on as they did allocates nothing in its updates.
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/world.hpp"

#include "lab/measure/memory.hpp"

namespace broadside {
namespace {

struct Steady {
  std::string algorithm;
  double margin = 0;
  WorldEvents events = WorldEvents::exact;
};

class SteadyState : public testing::TestWithParam<Steady> {};

TEST_P(SteadyState, AllocatesNothing) {
  if (!lab::AllocationMeter().read()) GTEST_SKIP() << "this build does not count allocations";
  constexpr int side = 40;
  constexpr int period = 8;
  WorldOptions options;
  options.algorithm = GetParam().algorithm;
  options.margin = GetParam().margin;
  options.events = GetParam().events;
  World2 world(options);
  std::vector<Handle> handles;
  const auto box_in = [](int place, int frame) {
    // Every third box goes to and fro, and meets its neighbours and leaves them.
    const float step = place % 3 == 0 ? 0.2F * static_cast<float>(frame % period) : 0;
    const float x = 1.5F * static_cast<float>(place % side) + step;
    const float y = 1.5F * static_cast<float>(place / side);
    return Box2{{x, y}, {x + 1, y + 1}};
  };
  for (int place = 0; place < side * side; ++place) handles.push_back(world.add(box_in(place, 0)));
  std::size_t events = 0;
  const auto play = [&](int from, int to) {
    for (int frame = from; frame < to; ++frame) {
      for (int place = 0; place < side * side; place += 3) world.move(handles[place], box_in(place, frame));
      events += world.update().begun.size();
      events += world.pairs().size();
    }
  };
  play(0, 8 * period);
  const lab::AllocationMeter meter;
  play(0, 2 * period);
  EXPECT_EQ(meter.read()->peak, 0) << "bytes";
  EXPECT_GT(events, 0U);
}

INSTANTIATE_TEST_SUITE_P(All, SteadyState,
                         testing::Values(Steady{"auto"}, Steady{"brute_force"}, Steady{"grid"},
                                         Steady{"sweep_and_prune"}, Steady{"quadtree"}, Steady{"bvh"},
                                         Steady{"auto", 0.125},
                                         Steady{"auto", 0.125, WorldEvents::enlarged}));

TEST(WorldEvents, BringTheUserDataOfTheirBoxes) {
  World2 world;
  const Handle a = world.add({{0, 0}, {1, 1}}, {.user_data = 7});
  world.add({{1, 1}, {2, 2}}, {.user_data = 9});
  EXPECT_EQ(world.update().begun_data.size(), 1U);
  world.remove(a);
  const Events events = world.update();
  ASSERT_EQ(events.ended_data.size(), 1U);
  EXPECT_EQ(events.ended_data[0], (UserDataPair{7, 9}));
  EXPECT_TRUE(events.begun_data.empty());
  World2 without;
  without.add({{0, 0}, {1, 1}});
  without.add({{0, 0}, {1, 1}});
  EXPECT_TRUE(without.update().begun_data.empty());
}

}  // namespace
}  // namespace broadside

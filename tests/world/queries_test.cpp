// World's queries: in terms of handles, about the boxes as they are now.
#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "tests/support/scattered.hpp"
#include "tests/support/searchers.hpp"

namespace broadside {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr Box2 everywhere{{-1e6f, -1e6f}, {1e6f, 1e6f}};

std::vector<Handle> overlapping(const World2& world, const Box2& box,
                                const World2::QueryOptions& options = {}) {
  std::vector<Handle> found;
  world.overlapping(
      box, [&found](Handle handle) { found.push_back(handle); }, options);
  std::ranges::sort(found);
  return found;
}

TEST(WorldQueries, SeeBoxesAsTheyAreBeforeAndAfterAnUpdate) {
  World2 world;
  EXPECT_THAT(overlapping(world, everywhere), IsEmpty());
  const Handle a = world.add({{0, 0}, {1, 1}});
  const Handle b = world.add({{5, 0}, {6, 1}});
  EXPECT_THAT(overlapping(world, everywhere), ElementsAre(a, b));
  world.update();
  EXPECT_THAT(overlapping(world, everywhere), ElementsAre(a, b));
  world.move(b, {{8, 0}, {9, 1}});
  EXPECT_THAT(overlapping(world, {{5, 0}, {6, 1}}), IsEmpty());
  EXPECT_THAT(overlapping(world, {{8, 0}, {9, 1}}), ElementsAre(b));
  world.remove(a);
  EXPECT_THAT(overlapping(world, everywhere), ElementsAre(b));
  world.update();
  world.update();
  const Handle c = world.add({{0, 0}, {1, 1}});
  EXPECT_EQ(c.slot, a.slot);
  EXPECT_THAT(overlapping(world, {{0, 0}, {1, 1}}), ElementsAre(c)) << "not the handle of who was there";
}

TEST(WorldQueries, SeeNoBoxOfASlotThatARestoreTookAway) {
  World2 world;
  const Handle a = world.add({{0, 0}, {1, 1}});
  const std::vector<std::byte> snapshot = world.snapshot();
  world.add({{5, 0}, {6, 1}});
  EXPECT_EQ(overlapping(world, everywhere).size(), 2u);
  world.restore(snapshot);
  EXPECT_THAT(overlapping(world, everywhere), ElementsAre(a));
  EXPECT_EQ(world.nearest({5, 0}, 2).size(), 1u);
}

TEST(WorldQueries, CastAndHoldInTermsOfHandles) {
  World2 world;
  const Handle near = world.add({{2, 0}, {3, 1}});
  const Handle far = world.add({{5, 0}, {6, 1}});
  const Ray<2> ray{{0, 0.5f}, {1, 0}};
  EXPECT_EQ(world.first_hit(ray), (HandleHit<float>{near, 2}));
  EXPECT_EQ(world.first_hit(BoxCast<2>{{{0, 0}, {1, 1}}, {0.5f, 0}}), (HandleHit<float>{near, 2}));
  std::vector<HandleHit<float>> hits;
  world.hits(ray, [&hits](Handle handle, float entry) { hits.push_back({handle, entry}); });
  EXPECT_THAT(hits, testing::UnorderedElementsAre(HandleHit<float>{near, 2}, HandleHit<float>{far, 5}));
  int calls = 0;
  EXPECT_FALSE(world.hits(ray, [&calls](Handle, float) { return ++calls > 5; }));
  EXPECT_EQ(calls, 1);
  EXPECT_FALSE(world.containing({5.5f, 0.5f}, [far](Handle handle) { return handle != far; }));
}

TEST(WorldQueries, LeaveOutTheFloorThatABoxRestsOn) {
  World2 world;
  world.add({{-9, -1}, {9, 0}});
  const Handle wall = world.add({{5, 0}, {6, 9}});
  const Box2 walker{{0, 0}, {1, 2}};
  EXPECT_EQ(world.first_hit(BoxCast<2>{walker, {1, 0}})->t_enter, 0);
  EXPECT_EQ(world.first_hit(BoxCast<2>{.box = walker, .direction = {1, 0}, .entering = true}),
            (HandleHit<float>{wall, 4}));
  int hits = 0;
  world.hits(Ray<2>{.origin = {0, 0}, .direction = {1, 1}, .entering = true},
             [&](Handle handle, float t) { hits += handle == wall && t == 5 ? 1 : 9; });
  EXPECT_EQ(hits, 1);
}

TEST(WorldQueries, TellTheNearestByDistanceAndSlot) {
  World2 world;
  const Handle far = world.add({{5, 0}, {6, 1}});
  const Handle near = world.add({{2, 0}, {3, 1}});
  const Handle as_near = world.add({{-3, 0}, {-2, 1}});
  std::vector<HandleNeighbour> found;
  world.nearest({0, 0}, 2, found);
  EXPECT_THAT(found, ElementsAre(HandleNeighbour{near, 4}, HandleNeighbour{as_near, 4}));
  world.nearest({0, 0}, 9, found);
  EXPECT_EQ(found.back(), (HandleNeighbour{far, 25}));
  EXPECT_THAT(world.nearest(Box2{{-1, 0}, {4, 0}}, 2),
              ElementsAre(HandleNeighbour{near, 0}, HandleNeighbour{far, 1}));
}

template <int D, typename Real>
void expect_nearest_within() {
  World<D, Real> world;
  std::vector<Handle> handles;
  for (const Box<D>& box : scattered_boxes<D>(300, 10)) {
    Box<D, Real> wide;
    std::ranges::copy(box.min, wide.min.begin());
    std::ranges::copy(box.max, wide.max.begin());
    handles.push_back(world.add(wide));
  }
  world.remove(handles[4]);
  Point<D, Real> point;
  point.fill(5);
  for (const double max_distance : {0.0, 0.3, 2.0, std::numeric_limits<double>::infinity()}) {
    std::vector<HandleNeighbour> expected;
    for (const Handle handle : handles) {
      if (!world.contains(handle) || handle == handles[5]) continue;
      const double squared = distance_squared(point, world.box(handle));
      if (squared <= max_distance * max_distance) expected.push_back({handle, squared});
    }
    std::ranges::stable_sort(expected, {}, &HandleNeighbour::distance_squared);
    EXPECT_EQ(world.nearest(point, 999, {.except = handles[5], .max_distance = max_distance}), expected);
  }
  EXPECT_EQ(world.nearest(point, 999, {.except = handles[4]}).size(), 299U) << "one that is gone";
  EXPECT_THROW(world.nearest(point, 1, {.max_distance = -1}), InvalidQuery);
}

TEST(WorldQueries, TellTheNearestWithinADistance) {
  expect_nearest_within<2, float>();
  expect_nearest_within<3, float>();
  expect_nearest_within<2, double>();
  expect_nearest_within<3, double>();
}

TEST(WorldQueries, HeedFiltersAndNotTheMargin) {
  WorldOptions options;
  options.margin = 2;
  World2 world(options);
  const Handle a = world.add({{0, 0}, {1, 1}});
  const Handle b = world.add({{2, 0}, {3, 1}});
  world.update();
  EXPECT_THAT(overlapping(world, {{0, 0}, {1, 1}}), ElementsAre(a));
  const Filter query_filter{.category = 2, .mask = 4};
  EXPECT_THAT(overlapping(world, everywhere, {&query_filter}), IsEmpty());
  world.set_filter(b, {.category = 4});
  EXPECT_THAT(overlapping(world, everywhere, {&query_filter}), ElementsAre(b));
}

TEST(WorldQueries, LeaveOutOneBox) {
  World2 world;
  const Handle own = world.add({{0, 0}, {1, 1}});
  const Handle other = world.add({{3, 0}, {4, 1}});
  const Ray<2> ray{{0.5f, 0.5f}, {1, 0}};
  EXPECT_EQ(world.first_hit(ray), (HandleHit<float>{own, 0}));
  EXPECT_EQ(world.first_hit(ray, {.except = own}), (HandleHit<float>{other, 2.5f}));
  std::vector<Handle> found;
  const auto add = [&found](Handle handle) { found.push_back(handle); };
  world.overlapping(everywhere, add, {.except = own});
  world.containing({3.5f, 0.5f}, add, {.except = other});
  world.hits(ray, [&add](Handle handle, float) { add(handle); }, {.except = own});
  found.push_back(world.nearest({0, 0}, 1, {.except = own}).front().handle);
  EXPECT_THAT(found, ElementsAre(other, other, other));
  world.remove(other);
  EXPECT_EQ(world.first_hit(ray, {.except = other}), (HandleHit<float>{own, 0})) << "one that is gone";
}

TEST(WorldQueries, UseTheFollowersIndexWhereItHasOne) {
  auto made = follower_of<2>("bvh");
  const Follower<2>& follower = *made;
  World2 world{Tracker<2>(std::move(made))};
  const Handle a = world.add({{0, 0}, {1, 1}});
  const Handle b = world.add({{5, 0}, {6, 1}}, {.filter = {.category = 4}});
  world.update();
  EXPECT_THAT(overlapping(world, everywhere), ElementsAre(a, b));
  const Filter query_filter{.mask = 4};
  EXPECT_THAT(overlapping(world, everywhere, {&query_filter}), ElementsAre(b));
  EXPECT_EQ(&world.box_index(), follower.box_index());
  world.move(a, {{8, 0}, {9, 1}});
  EXPECT_THAT(overlapping(world, {{8, 0}, {9, 1}}), ElementsAre(a)) << "before the follower knows of it";
  EXPECT_NE(&world.box_index(), follower.box_index());
  world.update();
  EXPECT_THAT(overlapping(world, {{8, 0}, {9, 1}}), ElementsAre(a));
  EXPECT_EQ(&world.box_index(), follower.box_index());
}

class WorldQueriesBy : public testing::TestWithParam<const char*> {};

INSTANTIATE_TEST_SUITE_P(Algorithm, WorldQueriesBy, testing::Values("auto", "bvh", "bvh:update=follow"));

TEST_P(WorldQueriesBy, FollowChurn) {
  World2 world(GetParam());
  std::vector<Handle> handles;
  for (int i = 0; i < 3000; ++i) {
    const auto at = static_cast<float>(i);
    handles.push_back(world.add({{at, 0}, {at + 0.5f, 1}}));
  }
  for (int frame = 0; frame < 60; ++frame) {
    for (int k = 0; k < 40; ++k) {
      const auto i = static_cast<std::size_t>((frame * 40 + k) * 37 % 3000);
      if (world.contains(handles[i])) world.remove(handles[i]);
      const auto at = static_cast<float>((frame * 7919 + k * 104729) % 5000);
      if (k % 3 != 0) handles[i] = world.add({{at, 0}, {at + 0.5f, 1}});
    }
    world.update();
    if (frame % 4 == 1) continue;  // changes of several updates at once
    std::vector<Handle> expected;
    const Box2 asked{{1000, 0}, {3000, 1}};
    for (const Handle handle : handles) {
      if (world.contains(handle) && overlap(world.box(handle), asked)) expected.push_back(handle);
    }
    std::ranges::sort(expected);
    ASSERT_EQ(overlapping(world, asked), expected) << "frame " << frame;
  }
  for (const Handle handle : handles) {
    if (world.contains(handle)) world.remove(handle);
  }
  world.update();
  world.update();
  EXPECT_THAT(overlapping(world, everywhere), IsEmpty());
}

}  // namespace
}  // namespace broadside

// What several threads may read at the same time: a World between its updates, and a BoxIndex.
#include <array>
#include <cstddef>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/index.hpp"
#include "broadside/world.hpp"

namespace broadside {
namespace {

/// The i-th of boxes in a row along axis 0, one apart.
Box2 in_row(std::size_t i) {
  const auto at = static_cast<float>(2 * i);
  return {{at, 0}, {at + 1, 1}};
}

constexpr Box2 everywhere{{-1e6f, -1e6f}, {1e6f, 1e6f}};

std::vector<Box2> row(std::size_t count) {
  std::vector<Box2> boxes(count);
  for (std::size_t i = 0; i < count; ++i) boxes[i] = in_row(i);
  return boxes;
}

/// What `read()` gives in each of four threads at once.
template <typename Read>
std::array<std::size_t, 4> in_threads(Read read) {
  std::array<std::size_t, 4> results{};
  std::vector<std::jthread> threads;
  for (std::size_t& result : results) threads.emplace_back([&read, &result] { result = read(); });
  threads.clear();
  return results;
}

TEST(WorldThreads, MayReadAtTheSameTime) {
  World2 world("brute_force");
  std::vector<Handle> handles(500);
  world.add(row(500), handles);
  world.update();
  for (std::size_t round = 0; round < 10; ++round) {
    world.move(handles[100], in_row(round % 2 == 0 ? 100 : 1000));
    world.add(in_row(7));
    world.update();
    const std::array sums = in_threads([&world, &handles] {
      std::size_t sum = world.pairs().size() + world.persisting().size() + world.statistics().bytes.total();
      for (const Handle handle : handles) sum += world.contains(handle) && world.box(handle).min[0] >= 0;
      return sum;
    });
    EXPECT_THAT(sums, testing::Each(sums[0]));
    EXPECT_GT(world.pairs().size(), round);
  }
}

TEST(WorldQueriesThreads, MayAllAskFirst) {
  World2 world;
  std::vector<Handle> handles(2000);
  world.add(row(2000), handles);
  for (std::size_t frame = 1; frame <= 3; ++frame) {
    world.add({{-1, 0}, {0, 1}});
    world.update();
    EXPECT_THAT(in_threads([&world] {
                  std::size_t found = 0;
                  world.overlapping(everywhere, [&found](Handle) { ++found; });
                  return found;
                }),
                testing::Each(2000 + frame));
  }
}

TEST(BoxIndexThreads, MayAllAskAtOnce) {
  const std::vector<Box2> boxes = row(3000);
  BoxIndex<2> index;
  index.update({.boxes = boxes, .changed = {}});
  const std::array found = in_threads([&index] {
    std::size_t hits = 0;
    for (int i = 0; i < 50; ++i) {
      const auto at = static_cast<float>(i * 100);
      index.overlapping({{at, 0}, {at + 60, 1}}, [&hits](BoxId) { ++hits; });
      if (index.first_hit(Ray<2>{{at, 0.5f}, {1, 0}})) ++hits;
    }
    return hits;
  });
  EXPECT_GT(found[0], 0U);
  EXPECT_THAT(found, testing::Each(found[0]));
}

}  // namespace
}  // namespace broadside

// find_pairs: one call from boxes to pairs.
#include "broadside/find_pairs.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <list>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

namespace broadside {
namespace {

const std::vector<Pair> first_two = {{BoxId{0}, BoxId{1}}};

TEST(FindPairs, TakesAVector) {
  const std::vector<Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{9, 9}, {9, 9}}};
  EXPECT_EQ(find_pairs(boxes, {.algorithm = "brute_force"}), first_two);
}

TEST(FindPairs, TakesAnArrayAndASpan) {
  const std::array<Box3, 3> boxes = {
      {{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{0, 0, 2}, {0, 0, 3}}}};
  EXPECT_EQ(find_pairs(boxes, {.algorithm = "brute_force"}), first_two);
  EXPECT_EQ(find_pairs(std::span<const Box3>(boxes).first(2), {.algorithm = "brute_force"}), first_two);
}

TEST(FindPairs, FindsNothingAmongNoBoxesAndInOneBox) {
  EXPECT_TRUE(find_pairs(std::vector<Box2>{}, {.algorithm = "brute_force"}).empty());
  EXPECT_TRUE(find_pairs(std::span<const Box3>(), {.algorithm = "brute_force"}).empty());
  EXPECT_TRUE(find_pairs(std::vector<Box2>{{{0, 0}, {1, 1}}}, {.algorithm = "brute_force"}).empty());
}

TEST(FindPairs, ReturnsAtMostTwiceTheMemoryOfItsPairs) {
  const auto row = [](float step) {
    std::vector<Box2> boxes;
    for (int i = 0; i < 3000; ++i) {
      const float x = step * static_cast<float>(i % 30);
      const float y = static_cast<float>(i / 30) * 2;
      boxes.push_back({{x, y}, {x + 1, y + 1}});
    }
    return boxes;
  };
  for (const float step : {0.1F, 0.4F, 0.9F, 2.0F}) {
    const std::vector<Pair> pairs = find_pairs(row(step));
    EXPECT_EQ(pairs.empty(), step > 1);
    EXPECT_LE(pairs.capacity(), 2 * pairs.size() + 1) << step;
    EXPECT_LE(find_pairs(row(step), row(step)).capacity(), 2 * find_pairs(row(step), row(step)).size() + 1);
  }
}

TEST(FindPairs, WritesToASinkAndFlushesIt) {
  const std::vector<Box2> boxes(100, Box2{{0, 0}, {1, 1}});
  PairCounter counter;
  find_pairs(boxes, counter, {.algorithm = "brute_force"});
  EXPECT_EQ(counter.count(), 4950u);

  const std::vector<Box3> solid(100, Box3{{0, 0, 0}, {1, 1, 1}});
  find_pairs(solid, counter, {.algorithm = "brute_force"});
  EXPECT_EQ(counter.count(), 2 * 4950u);
}

TEST(FindPairs, HasAStandardAlgorithm) {
  const std::vector<Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}};
  EXPECT_EQ(find_pairs(boxes), first_two);
}

TEST(FindPairs, RefusesABadBoxAndABadSpec) {
  const std::vector<Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {0, 0}}};
  EXPECT_THROW(static_cast<void>(find_pairs(boxes, {.algorithm = "brute_force"})), InvalidInput);
  EXPECT_THROW(static_cast<void>(find_pairs(boxes, {.algorithm = "brute-force"})), InvalidSpec);
}

TEST(FindPairs, ListsWhatItQuarantines) {
  const std::vector<Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{1, 1}, {0, 0}}};
  std::vector<BoxId> quarantined = {BoxId{7}};
  EXPECT_EQ(find_pairs(boxes, {.quarantined = &quarantined}), first_two);
  EXPECT_EQ(quarantined, std::vector{BoxId{2}});
  EXPECT_EQ(find_pairs(boxes, boxes, {.quarantined = &quarantined}).size(), 4u);
  EXPECT_EQ(quarantined, (std::vector{BoxId{2}, BoxId{5}}));
}

TEST(FindPairs, LeavesOutWhatFiltersDoNotLetCount) {
  const std::vector<Box2> boxes(4, Box2{{0, 0}, {1, 1}});
  std::vector<Filter> filters(4);
  filters[3].mask = 0;
  IgnoredPairs ignored;
  ignored.insert({BoxId{2}, BoxId{0}});
  for (const char* const algorithm : {"brute_force", "grid", "grid:threads=2"}) {
    const FindOptions options{.algorithm = algorithm, .filters = filters, .ignored = &ignored};
    std::vector<Pair> pairs = find_pairs(boxes, options);
    std::ranges::sort(pairs);
    EXPECT_EQ(pairs, (std::vector<Pair>{{BoxId{0}, BoxId{1}}, {BoxId{1}, BoxId{2}}})) << algorithm;
  }
  EXPECT_EQ(find_pairs(boxes, boxes, {.filters = filters}).size(), 12U);
  EXPECT_EQ(find_pairs(boxes, boxes, {.right_filters = filters}).size(), 12U);
  EXPECT_THROW(static_cast<void>(find_pairs(std::span(boxes).first(3), {.filters = filters})), InvalidFrame);
  EXPECT_THROW(static_cast<void>(find_pairs(boxes, {.right_filters = filters})), InvalidFrame);
  EXPECT_THROW(static_cast<void>(find_pairs(boxes, boxes, {.ignored = &ignored})), InvalidFrame);
}

TEST(FindPairs, TakesBoxesInStructsOfTheCallers) {
  struct Body {
    char name;
    DoubleBox2 box;
    double mass;
  };
  const std::vector<Body> bodies = {
      {'a', {{0, 0}, {2, 2}}, 1}, {'b', {{1, 1}, {3, 3}}, 1}, {'c', {{9, 9}, {9, 9}}, 1}};
  const BoxView<2, double> view(&bodies[0].box, bodies.size(), sizeof(Body));
  EXPECT_EQ(find_pairs(view), first_two);
  EXPECT_EQ(find_pairs(view, view, {.algorithm = "grid"}).size(), 5U);
  EXPECT_EQ(find_pairs(boxes_of(bodies, &Body::box), {.algorithm = "grid"}), first_two);
}

struct Wall {
  int name;
  Box2 box;

  DoubleBox2 wide() const { return {{box.min[0], box.min[1]}, {box.max[0], box.max[1]}}; }
};

const std::vector<Wall> walls = {{7, {{0, 0}, {2, 2}}}, {8, {{1, 1}, {3, 3}}}, {9, {{9, 9}, {9, 9}}}};

TEST(FindPairs, TakesThingsAndWhatGivesTheirBoxes) {
  EXPECT_EQ(find_pairs(boxes_of(walls, &Wall::box)), first_two);
  EXPECT_EQ(find_pairs(boxes_of(walls, &Wall::wide)), first_two);
  EXPECT_EQ(find_pairs(boxes_of(walls, [](const Wall& wall) { return enlarged(wall.box, 10); })).size(), 3U);
  const std::list<Wall> list(walls.begin(), walls.end());
  EXPECT_EQ(find_pairs(boxes_of(list, &Wall::box)), first_two);
}

TEST(FindPairs, TakesTwoSetsOfThings) {
  const std::vector<Box2> boxes = {{{9, 9}, {10, 10}}};
  const std::vector<Pair> last = {{BoxId{2}, BoxId{0}}};
  EXPECT_EQ(find_pairs(boxes_of(walls, &Wall::box), boxes), last);
  std::vector<Pair> pairs;
  find_pairs(boxes_of(walls, &Wall::box), boxes, [&pairs](Pair pair) { pairs.push_back(pair); });
  EXPECT_EQ(pairs, last);
}

TEST(FindPairs, CallsAFunctionOfAPairOrOfAChunk) {
  const std::vector<Box2> boxes(100, Box2{{0, 0}, {1, 1}});
  std::vector<Pair> singly;
  find_pairs(boxes, [&singly](Pair pair) { singly.push_back(pair); });
  EXPECT_EQ(singly, find_pairs(boxes));
  std::vector<Pair> in_chunks;
  const auto add = [&in_chunks](std::span<const Pair> chunk) {
    in_chunks.insert(in_chunks.end(), chunk.begin(), chunk.end());
  };
  find_pairs(boxes, add, {.algorithm = "grid"});
  EXPECT_EQ(in_chunks, find_pairs(boxes, {.algorithm = "grid"}));
  in_chunks.clear();
  find_pairs(boxes, boxes, add);
  EXPECT_EQ(in_chunks, find_pairs(boxes, boxes));
  std::size_t sum = 0;
  find_pairs(boxes, [&sum](auto pair) { sum += pair.second - pair.first; });
  EXPECT_EQ(sum, 166'650U);
}

TEST(FindPairs, CallsTheCallersFunctionAndNoCopy) {
  struct Count {
    std::size_t pairs = 0;
    void operator()(Pair) { ++pairs; }
  } count;
  find_pairs(boxes_of(walls, &Wall::box), count);
  EXPECT_EQ(count.pairs, 1U);
}

TEST(FindPairs, EndsWhereAFunctionThrows) {
  const std::vector<Box2> boxes(100, Box2{{0, 0}, {1, 1}});
  std::size_t calls = 0;
  const auto third_time = [&calls](Pair) {
    if (++calls == 3) throw std::runtime_error("enough");
  };
  for (const char* const algorithm : {"brute_force", "grid", "bvh:threads=2"}) {
    calls = 0;
    EXPECT_THROW(find_pairs(boxes, third_time, {.algorithm = algorithm}), std::runtime_error) << algorithm;
    EXPECT_EQ(calls, 3U) << algorithm;
  }
  Finder<2> finder("grid");
  EXPECT_THROW(finder.find(boxes, [](Pair) { throw std::runtime_error("enough"); }), std::runtime_error);
  PairCounter counter;
  finder.find(boxes, counter);
  EXPECT_EQ(counter.count(), 4950U) << "a finder that goes on";
  std::size_t found = 0;
  finder.find_between(boxes, boxes, [&found](std::span<const Pair> chunk) { found += chunk.size(); });
  EXPECT_EQ(found, 10'000U);
}

TEST(BoxId, IsAnIndex) {
  for (const auto [a, b] : find_pairs(boxes_of(walls, &Wall::box))) {
    EXPECT_EQ(walls[a].name, 7);
    EXPECT_EQ(walls[b].name, 8);
  }
  static_assert(!std::is_convertible_v<std::uint32_t, BoxId>, "a number is no id");
}

}  // namespace
}  // namespace broadside

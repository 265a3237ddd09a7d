// find_pairs: one call from boxes to pairs.
#include <algorithm>
#include <array>
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
  EXPECT_EQ(find_pairs(boxes, "brute_force"), first_two);
}

TEST(FindPairs, TakesAnArrayAndASpan) {
  const std::array<Box3, 3> boxes = {
      {{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{0, 0, 2}, {0, 0, 3}}}};
  EXPECT_EQ(find_pairs(boxes, "brute_force"), first_two);
  EXPECT_EQ(find_pairs(std::span<const Box3>(boxes).first(2), "brute_force"), first_two);
}

TEST(FindPairs, FindsNothingAmongNoBoxesAndInOneBox) {
  EXPECT_TRUE(find_pairs(std::vector<Box2>{}, "brute_force").empty());
  EXPECT_TRUE(find_pairs(std::span<const Box3>(), "brute_force").empty());
  EXPECT_TRUE(find_pairs(std::vector<Box2>{{{0, 0}, {1, 1}}}, "brute_force").empty());
}

TEST(FindPairs, WritesToASinkAndFlushesIt) {
  const std::vector<Box2> boxes(100, Box2{{0, 0}, {1, 1}});
  PairCounter counter;
  find_pairs(boxes, counter, "brute_force");
  EXPECT_EQ(counter.count(), 4950u);

  const std::vector<Box3> solid(100, Box3{{0, 0, 0}, {1, 1, 1}});
  find_pairs(solid, counter, "brute_force");
  EXPECT_EQ(counter.count(), 2 * 4950u);
}

TEST(FindPairs, HasAStandardAlgorithm) {
  const std::vector<Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}};
  EXPECT_EQ(find_pairs(boxes), first_two);
}

TEST(FindPairs, RefusesABadBoxAndABadSpec) {
  const std::vector<Box2> boxes = {{{0, 0}, {2, 2}}, {{1, 1}, {0, 0}}};
  EXPECT_THROW(find_pairs(boxes, "brute_force"), InvalidInput);
  EXPECT_THROW(find_pairs(boxes, "brute-force"), InvalidSpec);
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
  EXPECT_THROW(find_pairs(std::span(boxes).first(3), {.filters = filters}), InvalidFrame);
  EXPECT_THROW(find_pairs(boxes, {.right_filters = filters}), InvalidFrame);
  EXPECT_THROW(find_pairs(boxes, boxes, {.ignored = &ignored}), InvalidFrame);
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
  EXPECT_EQ(find_pairs(view, view, "grid").size(), 5U);
  EXPECT_EQ(find_pairs(bodies, "grid", &Body::box), first_two);
  EXPECT_EQ(find_pairs(bodies, FindOptions{}, [](const Body& body) { return body.box; }), first_two);
}

}  // namespace
}  // namespace broadside

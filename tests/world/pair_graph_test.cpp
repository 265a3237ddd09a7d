// PairGraph against a plain set.
#include "world/pair_graph.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/drawn_boxes.hpp"

namespace broadside::world {
namespace {

TEST(PairGraph, AgreesWithAPlainSet) {
  constexpr std::uint32_t boxes = 40;
  Rng random(2);
  PairGraph graph;
  std::set<Pair> expected;
  for (int i = 0; i < 20'000; ++i) {
    const Pair pair = random_pair(random, boxes);
    const PairGraph::EdgeId edge = graph.find(pair);
    ASSERT_EQ(edge != PairGraph::none, expected.contains(pair));
    if (edge != PairGraph::none) {
      ASSERT_EQ(graph.marks()[edge], key(pair) % 251);
      ASSERT_FALSE(graph.renew_stamp(edge, static_cast<std::uint32_t>(key(pair) % 1000 + 1)));
      graph.erase(edge);
      expected.erase(pair);
    } else {
      const auto added = graph.insert(pair, static_cast<std::uint8_t>(key(pair) % 251));
      ASSERT_TRUE(graph.renew_stamp(added, static_cast<std::uint32_t>(key(pair) % 1000 + 1)));
      expected.insert(pair);
    }
    if (i % 5000 == 4999) graph.shrink_to_fit();
    const auto box = BoxId(random.below(boxes));
    std::set<Pair> of_box;
    graph.for_each_of(box, [&](PairGraph::EdgeId its) { of_box.insert(graph.pairs()[its]); });
    std::set<Pair> expected_of_box;
    std::ranges::copy_if(expected, std::inserter(expected_of_box, expected_of_box.end()),
                         [box](Pair other) { return other.first == box || other.second == box; });
    ASSERT_EQ(of_box, expected_of_box);
  }
  EXPECT_EQ(std::set<Pair>(graph.pairs().begin(), graph.pairs().end()), expected);
  EXPECT_EQ(graph.size(), expected.size());
}

TEST(PairGraph, LosesABoxesEdgesOneByOne) {
  PairGraph graph;
  for (std::uint32_t i = 0; i < 20; ++i) {
    if (i != 7) graph.insert({BoxId{std::min(i, 7u)}, BoxId{std::max(i, 7u)}});
  }
  while (graph.first_of(BoxId{7}) != PairGraph::none) graph.erase(graph.first_of(BoxId{7}));
  EXPECT_EQ(graph.size(), 0u);
  graph.for_each_of(BoxId{3}, [](PairGraph::EdgeId) { ADD_FAILURE(); });
}

}  // namespace
}  // namespace broadside::world

// What World is made of: the set of free slots, the graph of pairs, and the pairs that hold, each against a
// plain set.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <random>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "world/current_pairs.hpp"
#include "world/pair_graph.hpp"
#include "world/slot_set.hpp"

namespace broadside::core {
namespace {

std::uint32_t below(std::mt19937& random, std::uint32_t end) {
  return static_cast<std::uint32_t>(random() % end);
}

Pair random_pair(std::mt19937& random, std::uint32_t boxes) {
  const std::uint32_t a = below(random, boxes);
  const std::uint32_t b = (a + 1 + below(random, boxes - 1)) % boxes;
  return {BoxId{std::min(a, b)}, BoxId{std::max(a, b)}};
}

TEST(SlotSet, KnowsItsLowest) {
  SlotSet set;
  EXPECT_TRUE(set.empty());
  set.reserve(300'000);
  for (const std::uint32_t slot : {262'144u, 4096u, 70u, 299'999u, 3u}) {
    set.insert(slot);
    EXPECT_TRUE(set.contains(slot));
  }
  EXPECT_EQ(set.size(), 5u);
  for (const std::uint32_t slot : {3u, 70u, 4096u, 262'144u, 299'999u}) {
    EXPECT_EQ(set.lowest(), slot);
    set.erase(slot);
    EXPECT_FALSE(set.contains(slot));
  }
  EXPECT_TRUE(set.empty());
  EXPECT_FALSE(set.contains(1'000'000));
}

TEST(SlotSet, AgreesWithAPlainSet) {
  std::mt19937 random(1);
  SlotSet set;
  std::set<std::uint32_t> expected;
  set.reserve(5000);
  for (int i = 0; i < 20'000; ++i) {
    const std::uint32_t slot = below(random, 5000);
    if (expected.contains(slot)) {
      set.erase(slot);
      expected.erase(slot);
    } else {
      set.insert(slot);
      expected.insert(slot);
    }
    ASSERT_EQ(set.size(), expected.size());
    ASSERT_EQ(set.empty(), expected.empty());
    if (!expected.empty()) {
      ASSERT_EQ(set.lowest(), *expected.begin());
    }
  }
  for (const std::uint32_t slot : expected) set.erase(slot);
  set.shrink_to(0);
  EXPECT_EQ(set.bytes(), 0u);
  set.reserve(10);
  set.insert(9);
  EXPECT_EQ(set.lowest(), 9u);
}

TEST(PairGraph, AgreesWithAPlainSet) {
  constexpr std::uint32_t boxes = 40;
  std::mt19937 random(2);
  PairGraph graph;
  std::set<Pair> expected;
  for (int i = 0; i < 20'000; ++i) {
    const Pair pair = random_pair(random, boxes);
    const PairGraph::EdgeId edge = graph.find(pair);
    ASSERT_EQ(edge != PairGraph::none, expected.contains(pair));
    if (edge != PairGraph::none) {
      ASSERT_EQ(graph.mark(edge).stamp, key(pair) % 1000);
      graph.erase(edge);
      expected.erase(pair);
    } else {
      graph.mark(graph.insert(pair)).stamp = static_cast<std::uint32_t>(key(pair) % 1000);
      expected.insert(pair);
    }
    if (i % 5000 == 4999) graph.shrink_to_fit();
    const BoxId box{below(random, boxes)};
    std::set<Pair> of_box;
    graph.for_each_of(box, [&](PairGraph::EdgeId its) { of_box.insert(graph.pair(its)); });
    std::set<Pair> expected_of_box;
    std::ranges::copy_if(expected, std::inserter(expected_of_box, expected_of_box.end()),
                         [box](Pair other) { return other.first == box || other.second == box; });
    ASSERT_EQ(of_box, expected_of_box);
  }
  std::set<Pair> all;
  graph.for_each([&](PairGraph::EdgeId edge) { all.insert(graph.pair(edge)); });
  EXPECT_EQ(all, expected);
  EXPECT_EQ(graph.size(), expected.size());
}

TEST(PairGraph, LosesABoxesEdgesWhileItVisitsThem) {
  PairGraph graph;
  for (std::uint32_t i = 0; i < 20; ++i) {
    if (i != 7) graph.insert({BoxId{std::min(i, 7u)}, BoxId{std::max(i, 7u)}});
  }
  graph.for_each_of(BoxId{7}, [&](PairGraph::EdgeId edge) { graph.erase(edge); });
  EXPECT_EQ(graph.size(), 0u);
  graph.for_each_of(BoxId{3}, [](PairGraph::EdgeId) { ADD_FAILURE(); });
}

/// A history of events, and what must hold after it.
class CurrentPairsTest : public testing::Test {
 protected:
  void add(const std::set<Pair>& toggled) {
    std::vector<Pair> begun;
    std::vector<Pair> ended;
    for (const Pair pair : toggled) (expected_.contains(pair) ? ended : begun).push_back(pair);
    for (const Pair pair : ended) expected_.erase(pair);
    expected_.insert(begun.begin(), begun.end());
    pairs_.add(begun, ended, generations_);
  }

  void check() {
    EXPECT_EQ(pairs_.size(), expected_.size());
    pairs_.merge(generations_);
    std::vector<HandlePair> handles;
    for (const Pair pair : expected_)
      handles.push_back({{index(pair.first), generations_[index(pair.first)]},
                         {index(pair.second), generations_[index(pair.second)]}});
    ASSERT_TRUE(std::ranges::equal(pairs_.pairs(), handles));
  }

  CurrentPairs pairs_;
  std::set<Pair> expected_;
  std::vector<std::uint32_t> generations_ = std::vector<std::uint32_t>(100, 1);
};

TEST_F(CurrentPairsTest, AgreesWithAPlainSet) {
  std::mt19937 random(3);
  for (int i = 0; i < 500; ++i) {
    std::set<Pair> toggled;
    const std::uint32_t boxes = 2 + below(random, 98);
    for (std::uint32_t count = below(random, i % 50 == 0 ? 3000 : 30); count > 0; --count)
      toggled.insert(random_pair(random, boxes));
    add(toggled);
    if (below(random, 4) == 0) check();
  }
  check();
}

TEST_F(CurrentPairsTest, GivesAPairThatCameBackTheHandlesOfNow) {
  const Pair pair{BoxId{3}, BoxId{5}};
  add({pair, {BoxId{1}, BoxId{2}}, {BoxId{7}, BoxId{8}}});
  check();
  add({pair});
  generations_[3] = 2;
  add({pair});
  check();
}

TEST_F(CurrentPairsTest, TakesInALogThatHasGrownLong) {
  std::mt19937 random(4);
  for (int i = 0; i < 300; ++i) {
    std::set<Pair> toggled;
    for (int j = 0; j < 50; ++j) toggled.insert(random_pair(random, 100));
    add(toggled);
  }
  EXPECT_LE(pairs_.bytes(), 200'000u) << "15,000 events of at most 4,950 pairs";
  check();
}

}  // namespace
}  // namespace broadside::core

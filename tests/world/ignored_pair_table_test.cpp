// IgnoredPairTable: which pairs it holds, and what it lists as changed.
#include "world/ignored_pair_table.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace broadside::world {
namespace {

constexpr Pair a{BoxId{0}, BoxId{1}};
constexpr Pair b{BoxId{1}, BoxId{2}};
constexpr Pair c{BoxId{0}, BoxId{2}};

std::vector<Pair> changed(const IgnoredPairTable& pairs) {
  return {pairs.changed().begin(), pairs.changed().end()};
}

TEST(IgnoredPairTable, ListsWhatWasPutInAndTakenOut) {
  IgnoredPairTable pairs;
  EXPECT_TRUE(pairs.insert(a));
  EXPECT_FALSE(pairs.insert(a));
  EXPECT_TRUE(pairs.insert(b));
  EXPECT_TRUE(pairs.erase(a));
  EXPECT_FALSE(pairs.erase(a));
  EXPECT_EQ(changed(pairs), (std::vector<Pair>{a, b, a}));
  EXPECT_EQ(pairs.size(), 1u);
  pairs.settle();
  EXPECT_TRUE(pairs.changed().empty());
  EXPECT_TRUE(pairs.contains(b));
}

TEST(IgnoredPairTable, ForgetsAllPairsOfASlot) {
  IgnoredPairTable pairs;
  for (const Pair pair : {a, b, c}) pairs.insert(pair);
  pairs.settle();
  pairs.reserve_forgetting();
  pairs.forget(1);
  EXPECT_EQ(pairs.size(), 1u);
  EXPECT_TRUE(pairs.contains(c));
  EXPECT_EQ(pairs.changed().size(), 2u);
}

TEST(IgnoredPairTable, TakesThePairsOfASnapshot) {
  IgnoredPairTable pairs;
  pairs.insert(c);
  pairs.restore(std::vector<Pair>{a, b}, {b});
  EXPECT_EQ(pairs.size(), 2u);
  EXPECT_FALSE(pairs.contains(c));
  EXPECT_EQ(changed(pairs), (std::vector<Pair>{b}));
  pairs.shrink_to_fit();
  pairs.reserve_forgetting();
  pairs.forget(1);
  EXPECT_EQ(pairs.size(), 0u);
}

}  // namespace
}  // namespace broadside::world

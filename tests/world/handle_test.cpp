// Handles as keys of hash tables.
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <gtest/gtest.h>

#include "broadside/world.hpp"

namespace broadside {
namespace {

static_assert(noexcept(std::hash<Handle>{}(Handle{})));
static_assert(noexcept(std::hash<HandlePair>{}(HandlePair{})));

TEST(Handle, IsAKeyOfHashTables) {
  std::unordered_map<Handle, std::string> names = {{{7, 1}, "ball"}, {{7, 2}, "crate"}};
  EXPECT_EQ(names.at({7, 1}), "ball");
  EXPECT_EQ(names.at({7, 2}), "crate");
  EXPECT_FALSE(names.contains({7, 3}));
  const std::unordered_set<HandlePair> contacts = {{{1, 0}, {2, 0}}, {{1, 0}, {2, 0}}, {{2, 0}, {1, 0}}};
  EXPECT_EQ(contacts.size(), 2u);
}

/// How many of 2^14 buckets are taken by as many keys, where the bucket is the hash's lowest or highest 14
/// bits.
template <typename Key, typename Make>
std::pair<std::size_t, std::size_t> taken_buckets(const Make& make) {
  std::unordered_set<std::size_t> lowest;
  std::unordered_set<std::size_t> highest;
  for (std::uint32_t slot = 0; slot < 1u << 12; ++slot) {
    for (std::uint32_t other = 0; other < 4; ++other) {
      const std::size_t hash = std::hash<Key>{}(make(slot, other));
      lowest.insert(hash & 0x3fff);
      highest.insert(hash >> (8 * sizeof(hash) - 14));
    }
  }
  return {lowest.size(), highest.size()};
}

TEST(Handle, HashesSpreadOverTheBuckets) {
  // Random hashes take 1 - 1/e of them, 10,357.
  const auto [low, high] = taken_buckets<Handle>([](auto slot, auto other) { return Handle{slot, other}; });
  EXPECT_GT(low, 10'000u);
  EXPECT_GT(high, 10'000u);
  const auto [low_of_pair, high_of_pair] = taken_buckets<HandlePair>([](auto slot, auto other) {
    return HandlePair{{slot, 1}, {slot + 1 + other, 1}};
  });
  EXPECT_GT(low_of_pair, 10'000u);
  EXPECT_GT(high_of_pair, 10'000u);
}

}  // namespace
}  // namespace broadside

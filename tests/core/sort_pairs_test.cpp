// sort_unique: the same as std::sort and std::unique, however many pairs and whatever their ids.
#include "core/sort_pairs.hpp"

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace broadside::core {
namespace {

/// So many pairs with ids below `first_end` and `second_end`.
std::vector<Pair> random_pairs(std::size_t count, std::uint64_t first_end, std::uint64_t second_end) {
  std::mt19937_64 random(count);
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < count; ++i) {
    const auto first = static_cast<std::uint32_t>(random() % first_end);
    const auto second = static_cast<std::uint32_t>(random() % second_end);
    pairs.push_back({BoxId{first}, BoxId{second}});
  }
  return pairs;
}

std::vector<Pair> sorted_unique(std::vector<Pair> pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// The counts about which its ways change: none, one, the most that are compared, and more.
constexpr std::size_t counts[] = {0, 1, 2, 23, 24, 127, 128, 129, 1024, 5000};

TEST(SortUnique, SortsPairsOfIdsOfEveryMagnitude) {
  std::vector<Pair> scratch;
  constexpr std::uint64_t ends[] = {1, 2, 2047, 2048, 2049, 1U << 22U, 3U << 22U, 1U << 31U, 1ULL << 32U};
  for (const std::size_t count : counts) {
    for (const std::uint64_t first_end : ends) {
      for (const std::uint64_t second_end : ends) {
        const std::vector<Pair> pairs = random_pairs(count, first_end, second_end);
        std::vector<Pair> sorted = pairs;
        sort_unique(sorted, scratch);
        ASSERT_EQ(sorted, sorted_unique(pairs))
            << count << " pairs of ids below " << first_end << " and " << second_end;
      }
    }
  }
}

TEST(SortUnique, KeepsOneOfPairsThatAreAllTheSame) {
  std::vector<Pair> scratch;
  for (const std::size_t count : counts) {
    const Pair pair{BoxId{5000000}, BoxId{0xffffffff}};
    std::vector<Pair> pairs(count, pair);
    sort_unique(pairs, scratch);
    EXPECT_EQ(pairs, std::vector<Pair>(count > 0 ? 1 : 0, pair));
  }
}

TEST(SortUnique, IgnoresWhatItsScratchHolds) {
  std::vector<Pair> scratch = random_pairs(3000, 1ULL << 32U, 1ULL << 32U);
  for (const std::size_t count : {4000, 600, 700, 2999}) {
    const std::vector<Pair> pairs = random_pairs(count, 70000, 70000);
    std::vector<Pair> sorted = pairs;
    sort_unique(sorted, scratch);
    ASSERT_EQ(sorted, sorted_unique(pairs));
  }
}

}  // namespace
}  // namespace broadside::core

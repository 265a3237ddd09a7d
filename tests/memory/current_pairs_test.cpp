// A world's current pairs when memory runs out while they take in a log that has grown long.
#include "world/current_pairs.hpp"

#include <cstdint>
#include <new>
#include <vector>

#include <gtest/gtest.h>

#include "failing_allocation.hpp"

namespace broadside::world {
namespace {

std::vector<Pair> pairs_with(std::uint32_t first) {
  std::vector<Pair> pairs;
  for (std::uint32_t second = 0; second < 1000; ++second) pairs.push_back({BoxId{first}, BoxId{10 + second}});
  return pairs;
}

TEST(CurrentPairs, LoseNoEventOfAnUpdateBeforeOneThatFails) {
  const std::vector<std::uint32_t> generations(1010);
  const std::vector<Pair> earlier = pairs_with(5);
  const std::vector<Pair> later = pairs_with(2);
  bool has_failed = true;
  for (std::uint64_t number = 0; has_failed; ++number) {
    CurrentPairs pairs(true);
    PairEvents events{earlier, {}};
    pairs.take(events, generations, {});
    events.begun = later;
    has_failed = false;
    try {
      const laws::FailingAllocation failing(number, laws::FailureKind::once);
      pairs.take(events, generations, {});
    } catch (const std::bad_alloc&) {
      has_failed = true;
    }
    EXPECT_EQ(events.begun.size(), has_failed ? 1000u : 0u) << "allocation " << number;
    const auto current = pairs.pairs(generations);
    ASSERT_EQ(current.size(), pairs.size()) << "allocation " << number;
    ASSERT_EQ(current.size(), has_failed ? 1000u : 2000u) << "allocation " << number;
    EXPECT_EQ(current.back().first.slot, 5u) << "allocation " << number;
    EXPECT_EQ(current.front().first.slot, has_failed ? 5u : 2u) << "allocation " << number;
  }
}

}  // namespace
}  // namespace broadside::world

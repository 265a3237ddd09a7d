// SlotSet against a plain set.
#include "world/slot_set.hpp"

#include <cstdint>
#include <set>

#include <gtest/gtest.h>

#include "tests/support/drawn_boxes.hpp"

namespace broadside::world {
namespace {

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
  Rng random(1);
  SlotSet set;
  std::set<std::uint32_t> expected;
  set.reserve(5000);
  for (int i = 0; i < 20'000; ++i) {
    const auto slot = static_cast<std::uint32_t>(random.below(5000));
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

}  // namespace
}  // namespace broadside::world

// PairSet against a set of pairs: keys that probe past each other, and are deleted.
#include "core/pair_set.hpp"

#include <set>

#include <gtest/gtest.h>

#include "tests/support/drawn_boxes.hpp"

namespace broadside::core {
namespace {

TEST(PairSet, HoldsWhatWasInsertedAndNotErasedInEitherOrder) {
  Rng rng(1);
  PairSet set;
  std::set<Pair> expected;
  for (int step = 0; step < 20'000; ++step) {
    const std::size_t boxes = step < 10'000 ? 60 : 9;  // first it grows, then it is nearly emptied
    const Pair pair = random_pair(rng, boxes);
    const Pair given = rng.one_in(2) ? pair : Pair{pair.second, pair.first};
    if (rng.one_in(step < 10'000 ? 3 : 2))
      ASSERT_EQ(set.erase(given), expected.erase(pair) == 1) << step;
    else
      ASSERT_EQ(set.insert(given), expected.insert(pair).second) << step;
    ASSERT_EQ(set.size(), expected.size());
    const Pair asked = random_pair(rng, 60);
    ASSERT_EQ(set.contains({asked.second, asked.first}), expected.contains(asked)) << step;
  }
  for (const Pair pair : expected) EXPECT_TRUE(set.contains({pair.second, pair.first}));
  EXPECT_FALSE(set.contains({BoxId{0}, BoxId{0}}));
}

}  // namespace
}  // namespace broadside::core

// PairEvents: events that were undone before they were delivered.
#include "world/pair_events.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace broadside::world {
namespace {

TEST(PairEvents, AreNettedAndUndone) {
  const Pair pair_01{BoxId{0}, BoxId{1}};
  const Pair pair_02{BoxId{0}, BoxId{2}};
  const Pair pair_12{BoxId{1}, BoxId{2}};
  const Pair pair_13{BoxId{1}, BoxId{3}};
  const PairEvents events{{pair_13, pair_02, pair_01}, {pair_12, pair_02}};
  const PairEvents net = events.netted();
  EXPECT_EQ(net.begun, (std::vector<Pair>{pair_01, pair_13}));
  EXPECT_EQ(net.ended, (std::vector<Pair>{pair_12}));
  EXPECT_EQ(net.undone({pair_01, pair_02, pair_13}), (std::vector<Pair>{pair_02, pair_12}));
}

}  // namespace
}  // namespace broadside::world

// PairEvents: events that were undone before they were delivered.
#include "world/pair_events.hpp"

#include <vector>

#include <gtest/gtest.h>

namespace broadside::world {
namespace {

TEST(PairEvents, CancelWhatBeganAndEnded) {
  const Pair a{BoxId{0}, BoxId{1}};
  const Pair b{BoxId{0}, BoxId{2}};
  const Pair c{BoxId{1}, BoxId{2}};
  const Pair d{BoxId{1}, BoxId{3}};
  PairEvents events{{d, b, a}, {c, b}};
  const PairEvents net = events.netted();
  EXPECT_EQ(net.begun, (std::vector<Pair>{a, d}));
  EXPECT_EQ(net.ended, (std::vector<Pair>{c}));
  events.cancel();
  EXPECT_EQ(events.begun, net.begun);
  EXPECT_EQ(events.ended, net.ended);
}

}  // namespace
}  // namespace broadside::world

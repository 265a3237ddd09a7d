// WorldTracker: the way to another frame, and back.
#include "world/world_tracker.hpp"

#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

namespace broadside::world {
namespace {

using Pairs = std::vector<Pair>;
using Boxes = std::vector<Box2>;

constexpr Pair ab{BoxId{0}, BoxId{1}};
const Boxes together = {{{0, 0}, {1, 1}}, {{0, 0}, {1, 1}}};
const Boxes apart = {{{0, 0}, {1, 1}}, {{5, 5}, {6, 6}}};

class WorldTrackerTest : public testing::Test {
 protected:
  WorldTrackerTest() {
    tracker.update({.boxes = together}, events);
    events.clear();
    to_apart.boxes = apart;
  }

  Pairs led_to(const TakenFrame<2, float>& frame, std::optional<Pairs> known) {
    Pairs found;
    tracker.lead_to(frame, std::move(known), [&found](const Pairs& pairs) { found = pairs; });
    return found;
  }

  PairEvents events;
  WorldTracker<2, float> tracker{WorldOptions{.algorithm = "brute_force"}};
  TakenFrame<2, float> to_apart;
};

TEST_F(WorldTrackerTest, LeadsToAFrameAndStays) {
  EXPECT_TRUE(led_to(to_apart, Pairs{ab}).empty());
  tracker.update({.boxes = together, .changed = std::vector<BoxId>{BoxId{1}}}, events);
  EXPECT_EQ(events.begun, (Pairs{ab}));
}

TEST_F(WorldTrackerTest, FindsThePairsAnewWhereTheyAreNotKnown) {
  EXPECT_TRUE(led_to(to_apart, std::nullopt).empty());
  TakenFrame<2, float> to_together;
  to_together.boxes = together;
  EXPECT_EQ(led_to(to_together, std::nullopt), (Pairs{ab}));
}

TEST_F(WorldTrackerTest, GoesBackWhereTheCheckThrows) {
  const auto refuse = [this](const Pairs&) {
    EXPECT_EQ(tracker.last_frame().boxes[1], together[1]) << "the next events start there";
    throw std::runtime_error("refused");
  };
  EXPECT_THROW(tracker.lead_to(to_apart, Pairs{ab}, refuse), std::runtime_error);
  tracker.update({.boxes = together}, events);
  EXPECT_TRUE(events.empty());
}

TEST_F(WorldTrackerTest, RenewsItselfWithoutEvents) {
  tracker.renew({.boxes = together});
  tracker.update({.boxes = apart, .changed = std::vector<BoxId>{BoxId{1}}}, events);
  EXPECT_EQ(events.ended, (Pairs{ab}));
}

}  // namespace
}  // namespace broadside::world

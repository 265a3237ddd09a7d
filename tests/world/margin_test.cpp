// World with a margin: the tracker sees enlarged boxes, and the pairs are those of the boxes themselves.
#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/world.hpp"

#include "tests/support/boxes.hpp"
#include "tests/support/message.hpp"
#include "tests/support/trackers.hpp"
#include "tests/world/handle_pairs.hpp"

namespace broadside {
namespace {

WorldOptions with_margin(double margin) {
  WorldOptions options;
  options.algorithm = "brute_force";
  options.margin = margin;
  return options;
}

/// Compares what it is told has changed with all boxes, and counts it.
Tracker<2> counting_tracker(std::size_t& changes) {
  return stub_tracker([&changes](const Change<2>& change, PairSink& begun, PairSink& ended) {
    changes += change.changed.size();
    for (const BoxId a : change.changed) {
      for (std::uint32_t b = 0; b < change.now.size(); ++b) {
        if (BoxId{b} != a) change.report(a, BoxId{b}, begun, ended);
      }
    }
  });
}

class WorldMarginTest : public testing::Test {
 protected:
  std::size_t changes_ = 0;
  World2 world_{counting_tracker(changes_), with_margin(0.5)};
};

TEST_F(WorldMarginTest, ReportsThePairsOfTheBoxesThemselvesInTheSameUpdate) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(1.25F));
  EXPECT_TRUE(world_.update().begun.empty()) << "only the enlarged boxes overlap";
  EXPECT_EQ(world_.statistics().enlarged_pairs, 1u);
  world_.move(b, at(1));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
  world_.move(b, at(1.125F));
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, b}}));
  world_.move(b, at(1));
  world_.move(a, at(-0.25F));
  EXPECT_TRUE(world_.update().begun.empty());
  EXPECT_EQ(world_.box(a), at(-0.25F));
}

TEST_F(WorldMarginTest, TellsTheTrackerOnlyOfBoxesThatLeaveTheirEnlargedOnes) {
  const Handle a = world_.add(at(0));
  world_.update();
  EXPECT_EQ(changes_, 1u);
  for (const float x : {0.5F, -0.5F, 0.0F, 0.25F}) {
    world_.move(a, at(x));
    world_.update();
  }
  EXPECT_EQ(changes_, 1u);
  world_.move(a, at(0.625F));
  world_.update();
  EXPECT_EQ(changes_, 2u);
  world_.move(a, at(1.125F));
  world_.update();
  EXPECT_EQ(changes_, 2u) << "the new one is around the new place";
}

TEST_F(WorldMarginTest, ReplacesAnEnlargedBoxThatHasBecomeFarTooLarge) {
  const Handle a = world_.add({{-100, -100}, {100, 100}});
  world_.add(at(50));
  world_.update();
  world_.move(a, at(0));
  EXPECT_EQ(world_.update().ended.size(), 1u);
  EXPECT_EQ(world_.statistics().enlarged_pairs, 0u);
}

TEST_F(WorldMarginTest, TakesInfiniteBoxesAndRemovals) {
  const Handle whole = world_.add({{-infinity, -infinity}, {infinity, infinity}});
  const Handle a = world_.add(at(0));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{whole, a}}));
  world_.remove(whole);
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{whole, a}}));
  EXPECT_EQ(world_.statistics().enlarged_pairs, 0u);
}

TEST_F(WorldMarginTest, AsksThePredicateAboutBoxesThatOverlapAndNoOthers) {
  int asked = 0;
  world_.set_predicate([&](Handle, Handle) {
    ++asked;
    return true;
  });
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(1.25F));
  world_.update();
  world_.refilter();
  world_.update();
  EXPECT_EQ(asked, 0);
  world_.move(b, at(1));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
  EXPECT_EQ(asked, 1);
}

TEST_F(WorldMarginTest, FollowsFiltersAndIgnoredPairs) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(0));
  world_.ignore(a, b);
  EXPECT_TRUE(world_.update().begun.empty());
  world_.unignore(a, b);
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
  world_.set_filter(a, {.mask = 0});
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, b}}));
  world_.set_filter(a, {});
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
}

TEST_F(WorldMarginTest, MovesEnlargedBoxesWithTheOrigin) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(1));
  world_.update();
  world_.shift_origin({50, 0});
  EXPECT_TRUE(world_.update().ended.empty());
  world_.move(a, at(-50.25F));
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, b}}));
  EXPECT_EQ(changes_, 4u);
}

TEST_F(WorldMarginTest, RefusesAMarginThatIsNone) {
  EXPECT_THAT(message_of<std::invalid_argument>([] { World2(with_margin(-1)); }),
              names("margin", "-1", "at least 0"));
  EXPECT_THROW(World2(with_margin(std::numeric_limits<double>::quiet_NaN())), std::invalid_argument);
  EXPECT_THROW(World2(with_margin(1e300)), std::invalid_argument) << "infinite as a float";
}

TEST(WorldMargin, IsTheLesserOfTheTwo) {
  WorldOptions options = with_margin(0.5);
  options.relative_margin = 0.125;
  World2 world(options);
  const Handle small = world.add({{0, 0}, {2, 1}});
  const Handle large = world.add({{0, 0}, {64, 1}});
  EXPECT_EQ(world.enlarged_box(small), (Box2{{-0.25F, -0.25F}, {2.25F, 1.25F}}));
  EXPECT_EQ(world.enlarged_box(large), (Box2{{-0.5F, -0.5F}, {64.5F, 1.5F}}));
  const Handle half_plane = world.add({{-infinity, -infinity}, {infinity, 0}});
  EXPECT_EQ(world.enlarged_box(half_plane), (Box2{{-infinity, -infinity}, {infinity, 0}}));
}

TEST(WorldMargin, CoversTheWayAheadWhereAVelocityIsGiven) {
  WorldOptions options = with_margin(0.25);
  options.predicted_frames = 4;
  World2 world(options);
  const Handle a = world.add(at(0));
  world.move(a, at(1), {0.5F, -1});
  EXPECT_EQ(world.enlarged_box(a), (Box2{{0.75F, -4.25F}, {4.25F, 1.25F}}));
  world.move(a, at(1.5F), {0.5F, -1});
  EXPECT_EQ(world.enlarged_box(a).max[0], 4.25F) << "kept while the box is within";
  world.move(a, at(1.5F));
  EXPECT_EQ(world.enlarged_box(a), (Box2{{1.25F, -0.25F}, {2.75F, 1.25F}})) << "it has stopped";
}

TEST(WorldMargin, StaysABoxWhereInfinitiesAreAdded) {
  WorldOptions options = with_margin(0.5);
  options.predicted_frames = 1e30;
  options.bad_input = BadInput::quarantine;
  World2 world(options);
  const std::array<float, 2> fast = {1e30F, 0};
  const Box2 far_left = {{-infinity, 0}, {-infinity, 1}};
  const Handle a = world.add(at(0));
  const Handle b = world.add(far_left);
  const Handle c = world.add(at(0));
  world.update();
  world.move(a, far_left, fast);
  world.move(c, at(0), fast);
  EXPECT_TRUE(is_present(world.enlarged_box(a)));
  const Events events = world.update();
  EXPECT_EQ(listed(events.begun), (HandlePairs{{a, b}}));
  EXPECT_EQ(listed(events.ended), (HandlePairs{{a, c}}));
  world.move(c, {{0, 0}, {-1, 1}}, fast);
  EXPECT_TRUE(is_absent(world.enlarged_box(c)));
  world.update();
  World2 restored(options);
  EXPECT_NO_THROW(restored.restore(world.snapshot()));
}

TEST(WorldMargin, RefusesAVelocityThatIsNone) {
  WorldOptions options = with_margin(0.25);
  World2 still(options);
  const Handle a = still.add(at(0));
  EXPECT_THROW(still.move(a, at(1), {1, 0}), std::logic_error);
  options.predicted_frames = 4;
  World2 world(options);
  const Handle b = world.add(at(0));
  const auto before = world.snapshot();
  EXPECT_THAT(message_of<InvalidInput>([&] {
                world.move(b, at(1), {0, infinity});
              }),
              names("coordinate 1", "velocity", "slot 0", "inf"));
  const std::vector<Point<2>> velocities = {{0, 0}, {std::numeric_limits<float>::quiet_NaN(), 0}};
  try {
    world.move(std::vector{b, b}, std::vector{at(1), at(2)}, velocities);
    ADD_FAILURE();
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.index(), 1U);
  }
  EXPECT_THROW(world.move(std::vector{b}, std::vector{at(1)}, velocities), std::invalid_argument);
  EXPECT_EQ(world.snapshot(), before);
}

TEST(WorldMargin, OfEnlargedEventsIsNeeded) {
  WorldOptions options = with_margin(0);
  options.events = WorldEvents::enlarged;
  EXPECT_THAT(message_of<std::invalid_argument>([&] { World2{options}; }),
              names("margin", "relative margin"));
}

TEST(EnlargedEvents, TellWhereEnlargedBoxesMeetAndPart) {
  WorldOptions options = with_margin(0.5);
  options.events = WorldEvents::enlarged;
  World2 world(options);
  const Handle a = world.add(at(0));
  const Handle b = world.add(at(1.75F));
  EXPECT_EQ(listed(world.update().begun), (HandlePairs{{a, b}}));
  std::vector<std::uint8_t> flags(1);
  world.overlaps(world.pairs(), flags);
  EXPECT_EQ(flags[0], 0);
  for (const float x : {1.5F, 1.0F, 1.75F, 2.25F}) {
    world.move(b, at(x));
    const Events events = world.update();
    EXPECT_TRUE(events.begun.empty() && events.ended.empty()) << x;
    world.overlaps(world.pairs(), flags);
    EXPECT_EQ(flags[0], x == 1.0F);
    EXPECT_EQ(world.box(b), at(x));
  }
  world.move(b, at(2.5F));
  EXPECT_EQ(listed(world.update().ended), (HandlePairs{{a, b}}));
}

TEST(EnlargedEvents, LeaveQueriesToTheBoxesThemselves) {
  WorldOptions options = with_margin(0.5);
  options.events = WorldEvents::enlarged;
  World2 world(options);
  const Handle a = world.add(at(0));
  world.update();
  const auto is_found_at = [&](float x) {
    bool found = false;
    world.containing({x, 0.5F}, [&](Handle handle) {
      found = handle == a;
      return true;
    });
    return found;
  };
  EXPECT_FALSE(is_found_at(1.25F));
  world.move(a, at(0.375F));
  EXPECT_TRUE(is_found_at(1.25F));
  world.update();
  world.move(a, at(0));
  EXPECT_FALSE(is_found_at(1.25F));
  EXPECT_TRUE(is_found_at(0.25F));
}

}  // namespace
}  // namespace broadside

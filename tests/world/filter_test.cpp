// World: filters, ignored pairs and the predicate, and that changing them brings the right events.
#include <array>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

#include "tests/support/boxes.hpp"
#include "tests/support/message.hpp"
#include "tests/world/handle_pairs.hpp"

namespace broadside {
namespace {

class WorldFilterTest : public testing::Test {
 protected:
  World2 world_{"brute_force"};
};

TEST_F(WorldFilterTest, KeepsApartWhatFiltersDoNotAccept) {
  const Handle crate = world_.add(at(0), {.filter = {.category = 1, .mask = 2}});
  const Handle ghost = world_.add(at(0), {.filter = {.category = 4}});
  const Handle wall = world_.add(at(0), {.filter = {.category = 2}});
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{crate, wall}, {ghost, wall}}));
  EXPECT_EQ(world_.filter(ghost), (Filter{.category = 4}));
}

TEST_F(WorldFilterTest, NeverPairsTwoStaticBoxes) {
  const Handle ground = world_.add(at(0), {.filter = {.is_static = true}});
  const Handle wall = world_.add(at(0), {.filter = {.is_static = true}});
  const Handle ball = world_.add(at(0));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{ground, ball}, {wall, ball}}));
  world_.set_filter(wall, {});
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{ground, wall}}));
}

TEST_F(WorldFilterTest, BringsTheEventsOfAFilterThatChanges) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(0));
  world_.update();
  world_.set_filter(b, {.mask = 0});
  EXPECT_EQ(listed(world_.pairs()), (HandlePairs{{a, b}})) << "at the next update";
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, b}}));
  world_.set_filter(b, {});
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
  EXPECT_TRUE(world_.update().begun.empty());
}

TEST_F(WorldFilterTest, GivesASlotThatIsUsedAgainTheFilterOfItsNewBox) {
  const Handle a = world_.add(at(0), {.filter = {.mask = 0}, .user_data = 7});
  world_.remove(a);
  world_.update();
  EXPECT_EQ(world_.filter(a).mask, 0u) << "readable as long as its box is";
  EXPECT_EQ(world_.user_data(a), 7u);
  world_.update();
  EXPECT_THROW(static_cast<void>(world_.filter(a)), InvalidHandle);
  EXPECT_THROW(static_cast<void>(world_.user_data(a)), InvalidHandle);
  const Handle again = world_.add(at(0));
  ASSERT_EQ(again.slot, a.slot);
  EXPECT_EQ(world_.filter(again), Filter{});
  EXPECT_EQ(world_.user_data(again), 0u);
}

TEST_F(WorldFilterTest, KeepsUserData) {
  const Handle a = world_.add(at(0));
  EXPECT_EQ(world_.user_data(a), 0u);
  const Handle b = world_.add(at(5), {.user_data = 12});
  EXPECT_EQ(world_.user_data(a), 0u);
  EXPECT_EQ(world_.user_data(b), 12u);
  world_.set_user_data(a, 13);
  EXPECT_EQ(world_.user_data(a), 13u);
  EXPECT_EQ(world_.user_data(world_.add(at(9))), 0u);
}

TEST_F(WorldFilterTest, EndsAndBeginsPairsThatAreIgnored) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(0));
  const Handle c = world_.add(at(0));
  world_.ignore(c, a);
  EXPECT_TRUE(world_.is_ignored(a, c));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}, {b, c}}));
  world_.ignore(a, b);
  world_.ignore(a, b);
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, b}}));
  world_.unignore(b, a);
  world_.unignore(b, c);
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
  world_.ignore(a, b);
  world_.unignore(a, b);
  EXPECT_TRUE(world_.update().ended.empty()) << "taken back";
}

TEST_F(WorldFilterTest, ForgetsIgnoredPairsOfABoxThatIsRemoved) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(0));
  const Handle c = world_.add(at(0));
  world_.ignore(a, b);
  world_.ignore(b, c);
  world_.update();
  EXPECT_EQ(world_.statistics().ignored_pairs, 2u);
  world_.remove(a);
  EXPECT_EQ(world_.statistics().ignored_pairs, 1u);
  EXPECT_THROW(static_cast<void>(world_.is_ignored(a, b)), InvalidHandle);
  world_.update();
  world_.update();
  const Handle again = world_.add(at(0));
  ASSERT_EQ(again.slot, a.slot);
  EXPECT_FALSE(world_.is_ignored(again, b));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{again, b}, {again, c}}));
}

TEST_F(WorldFilterTest, RefusesToIgnoreABoxAndItself) {
  const Handle a = world_.add(at(0));
  EXPECT_THAT(message_of<std::invalid_argument>([&] { world_.ignore(a, a); }), names("slot 0", "twice"));
  EXPECT_THROW(world_.ignore(a, Handle{}), InvalidHandle);
  EXPECT_THROW(world_.set_filter(Handle{}, {}), InvalidHandle);
  EXPECT_THROW(world_.refilter(Handle{}), InvalidHandle);
}

TEST_F(WorldFilterTest, AsksThePredicateOnceForEachPairThatBegins) {
  HandlePairs asked;
  world_.set_predicate([&](Handle first, Handle second) {
    asked.push_back({first, second});
    return first.slot != 1;
  });
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(0));
  const Handle c = world_.add(at(0));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}, {a, c}}));
  EXPECT_EQ(asked, (HandlePairs{{a, b}, {a, c}, {b, c}}));
  world_.move(a, at(0.5F));
  EXPECT_TRUE(world_.update().begun.empty());
  EXPECT_EQ(asked.size(), 3u) << "they began long ago";
  world_.move(b, at(9));
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, b}})) << "b and c were no pair";
  world_.move(b, at(0));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
  EXPECT_EQ(asked.size(), 5u);
  EXPECT_EQ(listed(world_.pairs()), (HandlePairs{{a, b}, {a, c}}));
}

TEST_F(WorldFilterTest, AsksThePredicateAgainWhenToldTo) {
  bool is_open = false;
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(0));
  const Handle c = world_.add(at(1));
  world_.set_predicate([&](Handle, Handle) { return is_open; });
  EXPECT_TRUE(world_.update().begun.empty());
  is_open = true;
  EXPECT_TRUE(world_.update().begun.empty()) << "nobody has told";
  world_.refilter(c);
  world_.refilter(c);
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, c}, {b, c}}));
  world_.refilter();
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
  is_open = false;
  world_.refilter();
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, b}, {a, c}, {b, c}}));
}

TEST_F(WorldFilterTest, AppliesANewPredicateToThePairsThereAre) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(0));
  const Handle c = world_.add(at(0));
  world_.update();
  world_.set_predicate([&](Handle first, Handle) { return first == a; });
  EXPECT_EQ(listed(world_.pairs()), (HandlePairs{{a, b}, {a, c}, {b, c}}));
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{b, c}}));
  world_.set_predicate({});
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{b, c}}));
  EXPECT_EQ(world_.statistics().enlarged_pairs, 0u) << "nothing has to be kept for a predicate any more";
  world_.move(c, at(9));
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, c}, {b, c}}));
}

TEST_F(WorldFilterTest, CanTryAgainWhenThePredicateThrows) {
  bool throws = false;
  int asked = 0;
  world_.set_predicate([&](Handle, Handle) -> bool {
    ++asked;
    if (throws && asked % 2 == 0) throw std::runtime_error("out of luck");
    return true;
  });
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(0));
  world_.update();
  const Handle c = world_.add(at(0));
  world_.remove(b);
  throws = true;
  asked = 1;
  EXPECT_THROW(world_.update(), std::runtime_error);
  EXPECT_EQ(listed(world_.pairs()), (HandlePairs{{a, b}}));
  EXPECT_EQ(world_.box(b), at(0));
  const Handle d = world_.add(at(1));
  world_.move(c, at(2));
  EXPECT_THROW(world_.update(), std::runtime_error);
  world_.move(c, at(0));
  throws = false;
  const Events events = world_.update();
  EXPECT_EQ(listed(events.ended), (HandlePairs{{a, b}}));
  EXPECT_EQ(listed(events.begun), (HandlePairs{{a, c}, {a, d}, {c, d}}));
  EXPECT_EQ(listed(world_.pairs()), (HandlePairs{{a, c}, {a, d}, {c, d}}));
}

TEST_F(WorldFilterTest, ReportsNoEndOfAPairThatCameBackBeforeTheUpdateWasTriedAgain) {
  bool throws = false;
  world_.set_predicate([&](Handle, Handle) -> bool {
    if (throws) throw std::runtime_error("out of luck");
    return true;
  });
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(0));
  const Handle c = world_.add(at(5));
  world_.update();
  world_.move(b, at(5));
  throws = true;
  EXPECT_THROW(world_.update(), std::runtime_error);
  world_.move(b, at(0));
  throws = false;
  const Events events = world_.update();
  EXPECT_TRUE(events.begun.empty());
  EXPECT_TRUE(events.ended.empty());
  EXPECT_EQ(listed(world_.pairs()), (HandlePairs{{a, b}}));
  world_.remove(c);
}

TEST_F(WorldFilterTest, RefusesAPredicateThatChangesTheWorld) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(0));
  const std::vector<std::byte> snapshot = world_.snapshot();
  std::function<void()> change;
  world_.set_predicate([&](Handle, Handle) {
    change();
    return true;
  });
  const auto message = [&](std::function<void()> call) {
    change = std::move(call);
    return message_of<std::logic_error>([&] { world_.update(); });
  };
  EXPECT_EQ(message([&] { world_.update(); }),
            "a predicate called World::update(); expected one that only reads the world");
  EXPECT_EQ(message([&] { world_.remove(b); }),
            "a predicate called World::remove(); expected one that only reads the world");
  const std::array handles{a};
  const std::array boxes{at(0)};
  std::array<Handle, 1> added;
  const std::vector<std::function<void()>> others{[&] { world_.add(at(0)); },
                                                  [&] { world_.add(boxes, added); },
                                                  [&] { world_.move(a, at(1)); },
                                                  [&] { world_.move(handles, boxes); },
                                                  [&] { world_.set_filter(a, {.mask = 2}); },
                                                  [&] { world_.set_predicate({}); },
                                                  [&] {
                                                    world_.shift_origin({1, 1});
                                                  },
                                                  [&] { world_.restore(snapshot); }};
  for (const std::function<void()>& other : others)
    EXPECT_EQ(message(other).substr(0, 26), "a predicate called World::");
  change = [] {};
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}})) << "and nothing has changed";
}

TEST_F(WorldFilterTest, TakesAPredicateLateOnlyWherePairsAreKept) {
  WorldOptions options;
  options.algorithm = "brute_force";
  options.keep_pairs = false;
  World2 early(options);
  early.set_predicate([](Handle, Handle) { return false; });
  early.add(at(0));
  early.add(at(0));
  EXPECT_TRUE(early.update().begun.empty());
  World2 late(options);
  late.update();
  EXPECT_THROW(late.set_predicate([](Handle, Handle) { return false; }), std::logic_error);
}

}  // namespace
}  // namespace broadside

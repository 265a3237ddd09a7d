// World: handles that name, boxes that come and go, events and pairs by handle.
#include "broadside/world.hpp"

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"

#include "tests/support/boxes.hpp"
#include "tests/support/message.hpp"
#include "tests/support/searchers.hpp"
#include "tests/world/handle_pairs.hpp"

namespace broadside {
namespace {

class WorldTest : public testing::Test {
 protected:
  World2 world_{"brute_force"};
};

TEST_F(WorldTest, IsEmptyAtFirst) {
  EXPECT_EQ(world_.size(), 0u);
  EXPECT_TRUE(world_.pairs().empty());
  const Events events = world_.update();
  EXPECT_TRUE(events.begun.empty());
  EXPECT_TRUE(events.ended.empty());
}

TEST_F(WorldTest, HoldsTheBoxesThatAreAdded) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(5));
  EXPECT_NE(a, b);
  EXPECT_EQ(world_.size(), 2u);
  EXPECT_TRUE(world_.contains(a));
  EXPECT_EQ(world_.box(a), at(0));
  EXPECT_EQ(world_.box(b), at(5));
}

TEST_F(WorldTest, ReportsPairsAtTheNextUpdateAndNotBefore) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(1));
  EXPECT_TRUE(world_.pairs().empty());
  const Events events = world_.update();
  EXPECT_EQ(listed(events.begun), (HandlePairs{{a, b}}));
  EXPECT_TRUE(events.ended.empty());
  EXPECT_EQ(listed(world_.pairs()), (HandlePairs{{a, b}}));
}

TEST_F(WorldTest, IsSilentWhileNothingChanges) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(1));
  world_.update();
  const Events events = world_.update();
  EXPECT_TRUE(events.begun.empty());
  EXPECT_TRUE(events.ended.empty());
  EXPECT_EQ(listed(world_.pairs()), (HandlePairs{{a, b}}));
}

TEST_F(WorldTest, FollowsAMovingBox) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(5));
  const Handle c = world_.add(at(9));
  world_.update();
  world_.move(b, at(1));
  EXPECT_EQ(world_.box(b), at(1));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{a, b}}));
  world_.move(b, at(7));
  world_.move(b, at(8));
  const Events events = world_.update();
  EXPECT_EQ(listed(events.begun), (HandlePairs{{b, c}}));
  EXPECT_EQ(listed(events.ended), (HandlePairs{{a, b}}));
  EXPECT_EQ(listed(world_.pairs()), (HandlePairs{{b, c}}));
}

TEST_F(WorldTest, SeesNoMoveThatWasTakenBack) {
  const Handle a = world_.add(at(0));
  world_.add(at(1));
  world_.update();
  world_.move(a, at(50));
  world_.move(a, at(0));
  const Events events = world_.update();
  EXPECT_TRUE(events.begun.empty());
  EXPECT_TRUE(events.ended.empty());
}

TEST_F(WorldTest, EndsThePairsOfARemovedBox) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(1));
  world_.update();
  world_.remove(a);
  EXPECT_EQ(world_.size(), 1u);
  EXPECT_FALSE(world_.contains(a));
  EXPECT_EQ(listed(world_.pairs()), (HandlePairs{{a, b}})) << "they hold until the update";
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{a, b}}));
  EXPECT_TRUE(world_.pairs().empty());
}

TEST_F(WorldTest, NeverShowsABoxThatCameAndWentBetweenUpdates) {
  world_.add(at(0));
  world_.update();
  const Handle visitor = world_.add(at(0));
  world_.remove(visitor);
  const Events events = world_.update();
  EXPECT_TRUE(events.begun.empty());
  EXPECT_TRUE(events.ended.empty());
  EXPECT_EQ(world_.size(), 1u);
}

TEST_F(WorldTest, TellsARemovedBoxFromTheOneAddedInItsPlace) {
  const Handle a = world_.add(at(0));
  const Handle old_box = world_.add(at(1));
  world_.update();
  world_.remove(old_box);
  const Handle new_box = world_.add(at(1));
  EXPECT_NE(old_box, new_box);
  const Events events = world_.update();
  EXPECT_EQ(listed(events.ended), (HandlePairs{{a, old_box}}));
  EXPECT_EQ(listed(events.begun), (HandlePairs{{a, new_box}}));
}

TEST_F(WorldTest, ReusesASlotUnderAnotherGenerationAfterTheUpdateThatFollowsTheReport) {
  const Handle first = world_.add(at(0));
  world_.update();
  world_.remove(first);
  EXPECT_NE(world_.add(at(10)).slot, first.slot) << "not yet reported";
  world_.update();
  EXPECT_NE(world_.add(at(20)).slot, first.slot) << "still readable";
  world_.update();
  const Handle again = world_.add(at(30));
  EXPECT_EQ(again.slot, first.slot);
  EXPECT_NE(again.generation, first.generation);
  EXPECT_FALSE(world_.contains(first));
  EXPECT_TRUE(world_.contains(again));
  EXPECT_EQ(world_.box(again), at(30));
}

TEST_F(WorldTest, DoesNotGrowWhileAsManyComeAsGo) {
  std::uint32_t highest = 0;
  for (int frame = 0; frame < 100; ++frame) {
    const Handle visitor = world_.add(at(0));
    highest = std::max(highest, visitor.slot);
    world_.update();
    world_.remove(visitor);
  }
  EXPECT_LE(highest, 2u);
}

TEST_F(WorldTest, KeepsARemovedBoxReadableUntilTheUpdateAfterItsReport) {
  const Handle a = world_.add(at(3));
  world_.update();
  world_.remove(a);
  EXPECT_EQ(world_.box(a), at(3));
  world_.update();
  EXPECT_EQ(world_.box(a), at(3));
  world_.update();
  EXPECT_THROW(static_cast<void>(world_.box(a)), InvalidHandle);
}

TEST_F(WorldTest, RefusesToMoveOrRemoveABoxThatWasRemoved) {
  const Handle a = world_.add(at(3));
  world_.remove(a);
  EXPECT_THAT(message_of<InvalidHandle>([&] { world_.move(a, at(1)); }),
              names("slot 0, generation 0", "removed"));
  EXPECT_THAT(message_of<InvalidHandle>([&] { world_.remove(a); }), names("slot 0, generation 0", "removed"));
  EXPECT_EQ(world_.box(a), at(3)) << "what was refused has changed nothing";
}

TEST_F(WorldTest, TellsAHandleThatWasRemovedFromOneThatNeverWas) {
  const Handle a = world_.add(at(3));
  const std::string removed = "names a box that was removed";
  const std::string unknown = "was never issued by this world";
  const auto refusal = [&](Handle handle) {
    return message_of<InvalidHandle>([&] { static_cast<void>(world_.box(handle)); });
  };
  EXPECT_NE(refusal(Handle{}).find("cannot read a box: handle (slot 4294967295, generation 0) " + unknown),
            std::string::npos);
  EXPECT_NE(refusal({1, 0}).find(unknown), std::string::npos);
  EXPECT_NE(refusal({a.slot, 1}).find(unknown), std::string::npos);
  world_.remove(a);
  world_.update();
  world_.update();
  EXPECT_NE(refusal(a).find(removed), std::string::npos);
  EXPECT_NE(refusal({a.slot, 1}).find(unknown), std::string::npos) << "free, but not given out again";
  const Handle again = world_.add(at(1));
  EXPECT_EQ(again, (Handle{a.slot, 1}));
  EXPECT_NE(refusal(a).find(removed), std::string::npos);
}

TEST_F(WorldTest, TellsAnotherWorldsHandleFromOneThatWasRemoved) {
  World<2> first({.first_generation = 1000});
  World<2> second({.first_generation = 2000});
  const Handle a = first.add(at(0));
  const Handle b = second.add(at(0));
  const std::string unknown = "was never issued by this world: it belongs to another world or is invalid";
  const auto refusal = [&](const World<2>& world, Handle handle) {
    return message_of<InvalidHandle>([&] { static_cast<void>(world.box(handle)); });
  };
  EXPECT_NE(refusal(first, b).find(unknown), std::string::npos);
  EXPECT_NE(refusal(second, a).find(unknown), std::string::npos);
  second.restore(first.snapshot());
  second.remove(a);
  second.update();
  second.update();
  EXPECT_NE(refusal(second, a).find("names a box that was removed"), std::string::npos)
      << "its handles are those of the first one now";
}

TEST_F(WorldTest, RefusesWrongBoxesAndStaysAsItIs) {
  const Handle a = world_.add(at(0));
  for (const Box2& wrong : {Box2{{nan, 0}, {1, 1}}, Box2{{0, 2}, {1, 1}}, absent_box<2>()}) {
    EXPECT_THROW(world_.add(wrong), InvalidInput);
    EXPECT_THROW(world_.move(a, wrong), InvalidInput);
  }
  EXPECT_EQ(world_.size(), 1u);
  EXPECT_EQ(world_.box(a), at(0));
  EXPECT_EQ(world_.add(at(1)).slot, 1u);
  EXPECT_EQ(world_.update().begun.size(), 1u);
}

TEST_F(WorldTest, SaysWhyABoxIsRefusedAndForWhichSlot) {
  const Handle a = world_.add(at(0));
  const Handle b = world_.add(at(9));
  EXPECT_TRUE(message_of<InvalidInput>([&] {
                world_.move(b, {{0, 2}, {1, 1}});
              }).starts_with("the box for slot 1 has min (0, 2) and max (1, 1); expected numbers"));
  EXPECT_THAT(message_of<InvalidInput>([&] { world_.move(a, absent_box<2>()); }), names("slot 0", "absent"));
}

TEST_F(WorldTest, NamesABoxAloneByIndex0AndOneOfAnArrayByItsPlace) {
  const std::vector<Handle> handles = {world_.add(at(0)), world_.add(at(9))};
  const Box2 wrong{{0, 2}, {1, 1}};
  const auto index_of = [](const auto& call) -> std::size_t {
    try {
      call();
    } catch (const InvalidInput& error) {
      return error.index();
    }
    return 99;
  };
  EXPECT_EQ(index_of([&] { world_.add(wrong); }), 0u);
  EXPECT_EQ(index_of([&] { world_.move(handles[1], wrong); }), 0u);
  EXPECT_EQ(index_of([&] { world_.move(handles, std::vector<Box2>{at(1), wrong}); }), 1u);
}

TEST_F(WorldTest, TakesACopyOfItsOwnBox) {
  const Handle first = world_.add(at(42));
  for (int i = 0; i < 100; ++i) {
    const Handle copy = world_.add(world_.box(first));
    EXPECT_EQ(world_.box(copy), at(42));
  }
  world_.remove(first);
  world_.update();
  const Handle heir = world_.add(world_.box(first));
  EXPECT_EQ(world_.box(heir), at(42));
}

TEST_F(WorldTest, TakesInfiniteBoxes) {
  const Handle whole = world_.add({{-infinity, -infinity}, {infinity, infinity}});
  const Handle small = world_.add(at(0));
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{whole, small}}));
  world_.remove(small);
  EXPECT_EQ(listed(world_.update().ended), (HandlePairs{{whole, small}}));
}

TEST_F(WorldTest, SortsEventsAndPairsBySlot) {
  for (int i = 0; i < 20; ++i) world_.add(at(0));
  const Events events = world_.update();
  EXPECT_EQ(events.begun.size(), 190u);
  EXPECT_TRUE(std::ranges::is_sorted(events.begun));
  EXPECT_EQ(listed(events.begun), listed(world_.pairs()));
}

TEST_F(WorldTest, WorksInThreeDimensions) {
  World3 world("brute_force");
  const Handle a = world.add({{0, 0, 0}, {1, 1, 1}});
  const Handle b = world.add({{1, 1, 1}, {2, 2, 2}});
  EXPECT_EQ(listed(world.update().begun), (HandlePairs{{a, b}}));
  world.move(b, {{1, 1, 1.5f}, {2, 2, 2}});
  EXPECT_EQ(listed(world.update().ended), (HandlePairs{{a, b}}));
}

TEST_F(WorldTest, LosesNoEventWhenAnUpdateFails) {
  bool fails = false;
  const auto searcher = searcher_of<2>("brute_force");
  World2 world{Tracker<2>(std::make_unique<StubSearcher>([&](const SearchInput<2>& input, PairSink& pairs) {
    if (fails) throw std::runtime_error("out of luck");
    return searcher->search(input, pairs);
  }))};
  const Handle a = world.add(at(0));
  const Handle b = world.add(at(1));
  world.update();
  world.remove(b);
  const Handle c = world.add(at(0));
  fails = true;
  EXPECT_THROW(world.update(), std::runtime_error);
  EXPECT_EQ(listed(world.pairs()), (HandlePairs{{a, b}}));
  EXPECT_EQ(world.box(b), at(1));
  fails = false;
  const Events events = world.update();
  EXPECT_EQ(listed(events.ended), (HandlePairs{{a, b}}));
  EXPECT_EQ(listed(events.begun), (HandlePairs{{a, c}}));
  EXPECT_EQ(world.box(b), at(1));
}

TEST(WorldMaxBoxes, BoundsWhatIsAddedAndRestored) {
  World2 world({.algorithm = "grid", .max_boxes = 2});
  const Handle first = world.add(at(0));
  world.add(at(1));
  EXPECT_THAT(message_of<InvalidFrame>([&] { world.add(at(2)); }), testing::HasSubstr("3 boxes"));
  std::vector<Handle> handles(2);
  EXPECT_THROW(world.add(std::vector{at(2), at(3)}, handles), InvalidFrame);
  EXPECT_EQ(world.size(), 2U);
  world.remove(first);
  world.add(at(2));
  const std::vector<std::byte> snapshot = world.snapshot();
  World2 smaller({.algorithm = "grid", .max_boxes = 1});
  EXPECT_THROW(smaller.restore(snapshot), InvalidSnapshot);
  EXPECT_EQ(smaller.size(), 0U);
  World2({.algorithm = "grid", .max_boxes = 2}).restore(snapshot);
}

TEST_F(WorldTest, RefusesABadSpec) { EXPECT_THROW(World2("no_such_algorithm"), InvalidSpec); }

}  // namespace
}  // namespace broadside

// World: many boxes at once, a new origin, and the joins of two worlds.
#include <array>
#include <stdexcept>
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

class WorldBatchTest : public testing::Test {
 protected:
  std::vector<Handle> add(const std::vector<Box2>& boxes) {
    std::vector<Handle> handles(boxes.size());
    world_.add(boxes, handles);
    return handles;
  }

  World2 world_{"brute_force"};
};

TEST_F(WorldBatchTest, AddsManyBoxesAtOnce) {
  const std::vector<Box2> boxes = {at(0), at(1), at(5)};
  const std::vector<BoxOptions> options = {{.user_data = 1}, {.user_data = 2}, {.filter = {.mask = 8}}};
  std::vector<Handle> handles(3);
  world_.add(boxes, handles, options);
  EXPECT_EQ(world_.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(world_.box(handles[i]), boxes[i]);
  EXPECT_EQ(world_.user_data(handles[1]), 2u);
  EXPECT_EQ(world_.filter(handles[2]).mask, 8u);
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{handles[0], handles[1]}}));
}

TEST_F(WorldBatchTest, AddsAllOrNone) {
  const Handle first = world_.add(at(0));
  std::vector<Handle> handles(2, first);
  EXPECT_TRUE(message_of<InvalidInput>([&] {
                world_.add(std::vector<Box2>{at(1), {{nan, 0}, {1, 1}}}, handles);
              }).starts_with("added box 1 has min (nan, 0)"));
  EXPECT_THAT(message_of<InvalidInput>([&] {
                world_.add(std::vector<Box2>{absent_box<2>(), at(1)}, handles);
              }),
              names("box 0", "absent"));
  EXPECT_THAT(message_of<std::invalid_argument>([&] { world_.add(std::vector<Box2>{at(1)}, handles); }),
              names("2 handles", "1 boxes"));
  EXPECT_THROW(world_.add(std::vector<Box2>{at(1), at(2)}, handles, std::vector<BoxOptions>(3)),
               std::invalid_argument);
  EXPECT_EQ(handles, std::vector<Handle>(2, first));
  EXPECT_EQ(world_.size(), 1u);
  EXPECT_EQ(world_.statistics().slots, 1u);
  EXPECT_EQ(world_.slots(), 1u);
  EXPECT_TRUE(world_.update().begun.empty());
}

TEST_F(WorldBatchTest, UsesFreeSlotsFirst) {
  const std::vector<Handle> old = add({at(0), at(10), at(20)});
  world_.remove(std::vector<Handle>{old[0], old[2]});
  world_.update();
  world_.update();
  const std::vector<Handle> now = add({at(1), at(2), at(3)});
  EXPECT_EQ(now, (std::vector<Handle>{{0, 1}, {2, 1}, {3, 0}}));
}

TEST_F(WorldBatchTest, MovesAllOrNone) {
  const std::vector<Handle> handles = add({at(0), at(5), at(10)});
  world_.update();
  world_.move(handles, std::vector<Box2>{at(1), at(2), at(30)});
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{handles[0], handles[1]}}));
  const std::vector<Box2> wrong = {at(7), at(8), {{0, 2}, {1, 1}}};
  EXPECT_THROW(world_.move(handles, wrong), InvalidInput);
  EXPECT_THROW(world_.move(std::vector<Handle>{handles[0], Handle{}}, std::vector<Box2>{at(7), at(8)}),
               InvalidHandle);
  EXPECT_THROW(world_.move(handles, std::vector<Box2>{at(7)}), std::invalid_argument);
  EXPECT_EQ(world_.box(handles[0]), at(1));
  EXPECT_TRUE(world_.update().ended.empty());
  world_.move(std::vector<Handle>{handles[0], handles[0]}, std::vector<Box2>{at(50), at(60)});
  EXPECT_EQ(world_.box(handles[0]), at(60)) << "the last one counts";
}

TEST_F(WorldBatchTest, RemovesAllOrNone) {
  const std::vector<Handle> handles = add({at(0), at(0), at(0)});
  world_.update();
  EXPECT_NE(message_of<InvalidHandle>([&] {
              world_.remove(std::vector<Handle>{handles[0], handles[1], handles[0]});
            }).find("cannot remove a box twice: handle (slot 0, generation 0)"),
            std::string::npos);
  EXPECT_THROW(world_.remove(std::vector<Handle>{handles[0], Handle{7, 7}}), InvalidHandle);
  EXPECT_EQ(world_.size(), 3u);
  EXPECT_TRUE(world_.update().ended.empty());
  world_.remove(std::vector<Handle>{handles[2], handles[0]});
  EXPECT_EQ(world_.size(), 1u);
  EXPECT_EQ(world_.update().ended.size(), 3u);
}

TEST_F(WorldBatchTest, AddsABoxOfItsOwn) {
  const Handle first = world_.add(at(7));
  for (int i = 0; i < 100; ++i) {
    Handle added;
    world_.add(std::span(&world_.box(first), 1), std::span(&added, 1));
    ASSERT_EQ(world_.box(added), at(7)) << i;
    world_.add(BoxView<2>(&world_.box(first), 1, sizeof(Box2)), std::span(&added, 1));
    ASSERT_EQ(world_.box(added), at(7)) << i;
  }
}

TEST_F(WorldBatchTest, TakesNothingForNothing) {
  world_.add(std::span<const Box2>{}, std::span<Handle>{});
  world_.move(std::span<const Handle>{}, std::span<const Box2>{});
  world_.remove(std::span<const Handle>{});
  EXPECT_EQ(world_.size(), 0u);
}

TEST_F(WorldBatchTest, ShiftsTheOrigin) {
  const std::vector<Handle> handles = add({at(100), at(101), at(200)});
  world_.update();
  world_.remove(handles[2]);
  world_.shift_origin({100, -1});
  EXPECT_EQ(world_.box(handles[0]), (Box2{{0, 1}, {1, 2}}));
  EXPECT_EQ(world_.box(handles[2]), (Box2{{100, 1}, {101, 2}})) << "also what was removed";
  const Events events = world_.update();
  EXPECT_TRUE(events.begun.empty());
  EXPECT_TRUE(events.ended.empty());
  EXPECT_EQ(world_.pairs().size(), 1u);
  EXPECT_THAT(message_of<std::invalid_argument>([&] {
                world_.shift_origin({0, nan});
              }),
              names("coordinate 1", "nan", "finite"));
}

TEST_F(WorldBatchTest, ReportsThePairsThatRoundingMakesWhenTheOriginShifts) {
  const std::vector<Handle> handles = add({at(0), {{1.0001F, 0}, {2, 1}}});
  EXPECT_TRUE(world_.update().begun.empty());
  world_.shift_origin({-1e6F, 0});
  EXPECT_EQ(listed(world_.update().begun), (HandlePairs{{handles[0], handles[1]}}));
}

TEST_F(WorldBatchTest, JoinsTwoWorlds) {
  const std::vector<Handle> ours = add({at(0), at(10), at(20), at(30)});
  World2 other("brute_force");
  const Handle gone = other.add(at(0));
  other.remove(gone);
  const Handle far = other.add(at(20.5F), {.filter = {.mask = 4}});
  const Handle near = other.add(at(9.5F));
  HandlePairs pairs = {{ours[0], ours[0]}};
  world_.join(other, pairs);
  EXPECT_EQ(pairs, (HandlePairs{{ours[1], near}})) << "filters count, and what was removed does not";
  world_.set_filter(ours[2], {.category = 4});
  world_.join(other, pairs);
  EXPECT_EQ(pairs, (HandlePairs{{ours[1], near}, {ours[2], far}}));
}

}  // namespace
}  // namespace broadside

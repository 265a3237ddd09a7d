// BoxTable: when a box is enlarged anew, and what is listed as changed.
#include "world/box_table.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"

namespace broadside::world {
namespace {

constexpr Box2 unit{{0, 0}, {1, 1}};
constexpr Box2 near{{0.5F, 0}, {1.5F, 1}};
constexpr Box2 far{{9, 9}, {10, 10}};

using Ids = std::vector<BoxId>;

Ids listed(std::span<const BoxId> ids) { return {ids.begin(), ids.end()}; }

BoxTable<2, float> table_of(const WorldOptions& options, std::size_t slots) {
  BoxTable<2, float> boxes(options);
  boxes.reserve(slots, false);
  boxes.reserve_changes(4 * slots);
  for (std::size_t i = 0; i < slots; ++i) boxes.append();
  return boxes;
}

TEST(BoxTable, ListsEachSlotThatChangedOnce) {
  auto boxes = table_of({}, 3);
  boxes.set(2, unit, nullptr);
  boxes.set(0, unit, nullptr);
  boxes.set(2, near, nullptr);
  EXPECT_EQ(listed(boxes.shown_changes()), (Ids{BoxId{2}, BoxId{0}}));
  EXPECT_EQ(boxes.shown()[2], near);
  EXPECT_FALSE(boxes.is_changed(1));
  boxes.settle();
  EXPECT_TRUE(boxes.changed().empty());
  boxes.remove(2);
  EXPECT_EQ(listed(boxes.changed()), (Ids{BoxId{2}}));
  EXPECT_TRUE(is_absent(boxes.boxes()[2]));
}

TEST(BoxTable, ShowsANewEnlargedBoxOnlyWhenTheBoxHasLeftIt) {
  auto boxes = table_of({.margin = 1}, 1);
  EXPECT_TRUE(boxes.refines());
  boxes.set(0, unit, nullptr);
  EXPECT_EQ(boxes.shown()[0], (Box2{{-1, -1}, {2, 2}}));
  boxes.settle();
  boxes.set(0, near, nullptr);
  EXPECT_EQ(listed(boxes.changed()), (Ids{BoxId{0}}));
  EXPECT_TRUE(boxes.moved().empty());
  boxes.set(0, far, nullptr);
  EXPECT_EQ(listed(boxes.moved()), (Ids{BoxId{0}}));
  EXPECT_EQ(boxes.shown()[0], (Box2{{8, 8}, {11, 11}}));
}

TEST(BoxTable, ListsNoMoveWithinAnEnlargedBoxThatAloneMakesPairs) {
  auto boxes = table_of({.margin = 1, .events = WorldEvents::enlarged}, 1);
  EXPECT_FALSE(boxes.refines());
  boxes.set(0, unit, nullptr);
  boxes.settle();
  boxes.set(0, near, nullptr);
  EXPECT_TRUE(boxes.changed().empty());
  EXPECT_EQ(boxes.boxes()[0], near);
  boxes.reset(0, near);
  EXPECT_EQ(boxes.shown()[0], (Box2{{-0.5F, -1}, {2.5F, 2}}));
}

TEST(BoxTable, SetsManyBoxesAsItSetsOne) {
  const std::vector<Handle> handles = {{1, 0}, {0, 0}, {1, 0}, {99, 0}};
  const std::vector<Box2> to = {unit, near, far, unit};
  for (const double margin : {0.0, 1.0}) {
    auto many = table_of({.margin = margin}, 2);
    many.set(handles, to, {});
    auto one_by_one = table_of({.margin = margin}, 2);
    for (std::size_t i = 0; i < 3; ++i) one_by_one.set(handles[i].slot, to[i], nullptr);
    EXPECT_EQ(listed(many.changed()), listed(one_by_one.changed()));
    EXPECT_EQ(listed(many.moved()), listed(one_by_one.moved()));
    EXPECT_TRUE(std::ranges::equal(many.boxes(), one_by_one.boxes()));
    EXPECT_TRUE(std::ranges::equal(many.shown(), one_by_one.shown()));
  }
}

/// Moves of 300 boxes: most slots in a row, a slot twice, one that does not exist; most boxes move little.
TEST(BoxTable, SetsConsecutiveSlotsAsItSetsOne) {
  constexpr std::uint32_t slots = 300;
  for (const WorldOptions& options :
       {WorldOptions{}, WorldOptions{.margin = 1}, WorldOptions{.margin = 1, .events = WorldEvents::enlarged},
        WorldOptions{.relative_margin = 0.5}, WorldOptions{.bad_input = BadInput::quarantine}}) {
    auto many = table_of(options, slots);
    auto one_by_one = table_of(options, slots);
    std::vector<Handle> handles;
    for (std::uint32_t slot = 0; slot < slots; ++slot) handles.push_back({slot, 0});
    for (std::uint32_t i = 128; i < 192; ++i) handles[i].slot = 319 - i;  // not in a row
    handles[120].slot = 7;
    handles[130].slot = 140;
    handles[200].slot = slots + 5;
    for (int frame = 0; frame < 8; ++frame) {
      std::vector<Box2> to;
      for (std::uint32_t i = 0; i < slots; ++i) {
        const bool is_fast = i % 50 == 3 || (i > 200 && i % 2 == 0);
        const float x = static_cast<float>(frame) * (is_fast ? 1.5F : 0.1F);
        to.push_back({{x, 0}, {x + 1, 1}});
      }
      many.set(handles, frame % 2 == 0 ? to : BoxView<2>(to.data(), to.size(), sizeof(Box2)), {});
      for (std::size_t i = 0; i < slots; ++i) {
        if (handles[i].slot < slots) one_by_one.set(handles[i].slot, to[i], nullptr);
      }
      ASSERT_EQ(listed(many.changed()), listed(one_by_one.changed()));
      ASSERT_EQ(listed(many.moved()), listed(one_by_one.moved()));
      ASSERT_TRUE(std::ranges::equal(many.boxes(), one_by_one.boxes()));
      ASSERT_TRUE(std::ranges::equal(many.shown(), one_by_one.shown()));
      if (frame % 3 != 0) continue;  // else frames add to the lists
      many.settle();
      one_by_one.settle();
      for (std::uint32_t slot = 0; slot < slots; ++slot) ASSERT_FALSE(many.is_changed(slot));
    }
  }
}

TEST(BoxTable, SeesTheBoxThatIsNotPresent) {
  const auto table = table_of({}, 1);
  std::vector<Box2> boxes(100, unit);
  EXPECT_TRUE(table.are_present(boxes));
  EXPECT_TRUE(table.are_present({boxes.data(), boxes.size(), sizeof(Box2)}));
  boxes[77] = absent_box<2>();
  EXPECT_FALSE(table.are_present(boxes));
  EXPECT_FALSE(table.are_present({boxes.data(), boxes.size(), sizeof(Box2)}));
}

TEST(BoxTable, TakesAnInvalidBoxForAnAbsentOneWhereItQuarantines) {
  const Box2 wrong{{1, 0}, {0, 1}};
  EXPECT_THROW(table_of({}, 1).check(wrong, 0, "box", 0), InvalidInput);
  auto boxes = table_of({.bad_input = BadInput::quarantine}, 1);
  EXPECT_NO_THROW(boxes.check(wrong, 0, "box", 0));
  EXPECT_THROW(boxes.check(absent_box<2>(), 0, "box", 0), InvalidInput);
  boxes.set(0, wrong, nullptr);
  EXPECT_TRUE(is_absent(boxes.boxes()[0]));
}

TEST(BoxTable, RefusesVelocitiesThatItDoesNotPredictFrom) {
  EXPECT_THROW(table_of({}, 1).check_velocity({1, 1}, 0, "for slot", 0), std::logic_error);
  const auto boxes = table_of({.predicted_frames = 2}, 1);
  EXPECT_NO_THROW(boxes.check_velocity({1, 1}, 0, "for slot", 0));
  EXPECT_THROW(boxes.check_velocity({1, std::numeric_limits<float>::infinity()}, 0, "for slot", 0),
               InvalidInput);
}

TEST(BoxTable, KeepsFiltersFromTheFirstOneOn) {
  auto boxes = table_of({.margin = 1}, 2);
  EXPECT_EQ(boxes.filter_bytes(), 0u);
  boxes.reserve(0, true);
  boxes.use_filters();
  boxes.set_filter(1, {.mask = 0});
  EXPECT_EQ(boxes.filters().get(0), Filter{});
  EXPECT_EQ(boxes.filters().get(1).mask, 0u);
  EXPECT_EQ(listed(boxes.moved()), (Ids{BoxId{1}}));
  boxes.settle();
  boxes.shorten(1);
  EXPECT_EQ(boxes.filters().values().size(), 1u);
}

}  // namespace
}  // namespace broadside::world

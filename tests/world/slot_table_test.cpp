// SlotTable: which slots it hands out under which generations, and until when a removed box can be read.
#include "world/slot_table.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"

#include "tests/support/message.hpp"

namespace broadside::world {
namespace {

constexpr Box2 unit{{0, 0}, {1, 1}};

Handle add(SlotTable<2, float>& slots) {
  slots.reserve(1);
  return slots.add();
}

void remove(SlotTable<2, float>& slots, Handle handle) {
  slots.remove(std::span(&handle, 1), std::vector<Box2>(handle.slot + 1, unit));
}

TEST(SlotTable, KeepsARemovedBoxReadableForAnUpdateAndThenUsesItsSlotAgain) {
  SlotTable<2, float> slots(0);
  const Handle first = add(slots);
  const Handle second = add(slots);
  remove(slots, first);
  EXPECT_FALSE(slots.is_live(first));
  EXPECT_EQ(slots.live(), 1u);
  EXPECT_TRUE(slots.is_paired(first.slot));
  ASSERT_NE(slots.removed_box(first.slot), nullptr);
  slots.recycle();
  EXPECT_EQ(*slots.removed_box(slots.readable_slot(first)), unit);
  EXPECT_FALSE(slots.is_paired(first.slot));
  EXPECT_EQ(slots.next(), 2u) << "the slot can still be read";
  slots.recycle();
  EXPECT_THROW(slots.readable_slot(first), InvalidHandle);
  EXPECT_EQ(add(slots), (Handle{0, 1}));
  EXPECT_EQ(slots.removed_box(second.slot), nullptr);
}

TEST(SlotTable, SeesTheHandleThatIsNotLiveInALongList) {
  SlotTable<2, float> slots(0);
  std::vector<Handle> handles;
  for (int i = 0; i < 200; ++i) handles.push_back(add(slots));
  EXPECT_TRUE(slots.are_live(handles));
  EXPECT_TRUE(slots.are_live({}));
  for (const Handle wrong : {Handle{5, 1}, Handle{200, 0}, Handle{}}) {
    for (std::size_t place = 0; place < handles.size(); ++place) {
      const Handle right = std::exchange(handles[place], wrong);
      ASSERT_FALSE(slots.are_live(handles)) << place;
      handles[place] = right;
    }
  }
  std::swap(handles[3], handles[150]);
  EXPECT_TRUE(slots.are_live(handles)) << "in any order";
  remove(slots, {100, 0});
  EXPECT_FALSE(slots.are_live(handles));
}

TEST(SlotTable, HandsOutTheLowestFreeSlot) {
  SlotTable<2, float> slots(0);
  std::vector<Handle> handles;
  for (int i = 0; i < 5; ++i) handles.push_back(add(slots));
  for (const int i : {3, 1}) remove(slots, handles[static_cast<std::size_t>(i)]);
  slots.recycle();
  slots.recycle();
  EXPECT_EQ(slots.reserve(3), 1u) << "two are free";
  EXPECT_EQ(slots.add().slot, 1u);
  EXPECT_EQ(slots.add().slot, 3u);
  EXPECT_EQ(slots.add().slot, 5u);
}

TEST(SlotTable, RetiresASlotWhoseGenerationsAreUsedUp) {
  SlotTable<2, float> slots(std::numeric_limits<std::uint32_t>::max());
  const Handle last = add(slots);
  remove(slots, last);
  slots.recycle();
  slots.recycle();
  EXPECT_EQ(slots.state(last.slot), SlotState::retired);
  EXPECT_EQ(add(slots).slot, 1u);
}

TEST(SlotTable, RemovesAllOrNone) {
  SlotTable<2, float> slots(0);
  std::vector<Handle> handles;
  for (int i = 0; i < 3; ++i) handles.push_back(add(slots));
  const std::vector<Box2> boxes(3, unit);
  EXPECT_EQ(slots.remove(std::span(handles).first(1), boxes).size(), 1u);
  EXPECT_THROW(slots.remove(std::vector<Handle>{handles[1], handles[2], handles[1]}, boxes), InvalidHandle);
  EXPECT_THROW(slots.remove(std::vector<Handle>{handles[1], handles[0]}, boxes), InvalidHandle);
  EXPECT_TRUE(slots.is_live(handles[1]));
  EXPECT_EQ(slots.live(), 2u);
  EXPECT_EQ(slots.removed().size(), 1u);
  EXPECT_EQ(slots.remove(std::span(handles).subspan(1), boxes).front().slot, 1u);
}

TEST(SlotTable, NeverIssuesAHandleOfADroppedSlotAgain) {
  SlotTable<2, float> slots(0);
  std::vector<Handle> handles;
  for (int i = 0; i < 1000; ++i) handles.push_back(add(slots));
  for (int i = 10; i < 1000; ++i) remove(slots, handles[static_cast<std::size_t>(i)]);
  slots.recycle();
  EXPECT_FALSE(slots.trim());
  slots.recycle();
  EXPECT_TRUE(slots.trim());
  EXPECT_EQ(slots.size(), 10u);
  for (int i = 10; i < 1000; ++i) EXPECT_NE(add(slots), handles[static_cast<std::size_t>(i)]);
}

TEST(SlotTable, SaysWhyAHandleNamesNoBox) {
  SlotTable<2, float> slots(7);
  const Handle handle = add(slots);
  remove(slots, handle);
  const auto refusal = [&slots](Handle wrong) {
    return message_of<InvalidHandle>([&] { slots.live_slot(wrong, "move"); });
  };
  EXPECT_THAT(refusal(handle), names("slot 0, generation 7", "removed"));
  for (const Handle foreign : {Handle{0, 8}, Handle{0, 6}, Handle{1, 7}}) {
    EXPECT_NE(refusal(foreign).find("was never issued by this world"), std::string::npos);
  }
}

TEST(SlotTable, TakesTheSlotsOfASnapshot) {
  SlotTable<2, float> slots(0);
  using enum SlotState;
  slots.restore(4, {1, 2, 3, 4}, {live, free, removed, reported}, {{2, unit}}, {{3, unit}});
  EXPECT_EQ(slots.live(), 1u);
  EXPECT_EQ(slots.next(), 1u);
  EXPECT_EQ(slots.handle(BoxId{2}), (Handle{2, 3}));
  EXPECT_EQ(slots.removed_box(2), &slots.removed()[0].box);
  EXPECT_EQ(slots.removed_box(3), &slots.reported()[0].box);
  add(slots);
  EXPECT_EQ(add(slots), (Handle{4, 4}));
}

}  // namespace
}  // namespace broadside::world

// append_moved(): which changed boxes a structure has to look at, and what it is told of them.
#include <vector>

#include <gtest/gtest.h>

#include "algorithms/event_sinks.hpp"

namespace broadside::algorithm {
namespace {

constexpr Box2 here{{0, 0}, {1, 1}};
constexpr Box2 there{{4, 0}, {5, 2}};

/// Box 0 moves, 1 comes, 2 goes, 3 stays, and 4 was and is absent.
struct Moved {
  std::vector<Box2> before = {here, absent_box<2>(), there, here, absent_box<2>()};
  std::vector<Box2> now = {there, here, absent_box<2>(), here, absent_box<2>()};
  std::vector<BoxId> ids = {BoxId(0), BoxId(1), BoxId(2), BoxId(3), BoxId(4)};
  std::vector<std::uint8_t> flags = std::vector<std::uint8_t>(5, 1);
  std::vector<Filter> filters = std::vector<Filter>(5);
  Change<2> change{.before = before, .now = now, .changed = ids, .flags = flags};

  std::vector<core::MovedBox<2>> list() const {
    std::vector<core::MovedBox<2>> moved;
    append_moved(change, ids, moved);
    return moved;
  }
};

TEST(MovedBoxes, AreThoseWhoseBoxesDiffer) {
  const std::vector<core::MovedBox<2>> moved = Moved().list();
  ASSERT_EQ(moved.size(), 3U);
  EXPECT_EQ(moved[0].before, here);
  EXPECT_EQ(moved[0].now, there);
  EXPECT_EQ(moved[0].bounds, (Box2{{0, 0}, {5, 2}}));
  EXPECT_FALSE(moved[1].was_present);
  EXPECT_FALSE(overlap(moved[1].before, moved[1].before)) << "a box of NaNs overlaps nothing";
  EXPECT_EQ(moved[1].bounds, here);
  EXPECT_FALSE(moved[2].is_present);
  EXPECT_EQ(moved[2].bounds, there);
}

TEST(MovedBoxes, AreAlsoThoseWhoseFiltersDiffer) {
  Moved moved;
  std::vector<Filter> filters_now = moved.filters;
  filters_now[3].mask = 0;
  filters_now[4].mask = 0;
  moved.change.filters_before = moved.filters;
  moved.change.filters_now = filters_now;
  ASSERT_EQ(moved.list().size(), 4U) << "one that is absent before and now counts in no case";
  EXPECT_EQ(moved.list()[3].id, BoxId(3));
  EXPECT_TRUE(moved.list()[3].filter_changed);
  EXPECT_FALSE(moved.list()[0].filter_changed);
}

TEST(MovedBoxes, AreAllWhereCandidatesAreWanted) {
  Moved moved;
  moved.change.wants_candidates = true;
  ASSERT_EQ(moved.list().size(), 4U);
  EXPECT_TRUE(moved.list()[0].filter_changed);
}

}  // namespace
}  // namespace broadside::algorithm

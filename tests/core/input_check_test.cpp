// What a box must be, and the words with which others are refused.
#include "core/input_check.hpp"

#include <limits>
#include <locale>
#include <span>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"

#include "tests/support/boxes.hpp"
#include "tests/support/message.hpp"

namespace broadside {
namespace {

TEST(InputCheck, TakesPresentInfiniteAndAbsentBoxes) {
  const std::vector<Box2> boxes = {
      {{0, 0}, {1, 1}},
      {{1, 1}, {1, 1}},
      {{0.0f, 0.0f}, {-0.0f, -0.0f}},
      {{-infinity, -infinity}, {infinity, infinity}},
      {{infinity, -infinity}, {infinity, -infinity}},
      absent_box<2>(),
  };
  EXPECT_EQ(core::check_boxes(std::span<const Box2>(boxes)), 1u);
}

TEST(InputCheck, RefusesANanInAnyCoordinate) {
  for (int axis = 0; axis < 3; ++axis) {
    Box3 low{{0, 0, 0}, {1, 1, 1}};
    Box3 high = low;
    low.min[axis] = nan;
    high.max[axis] = nan;
    EXPECT_THROW(core::check_box(low, 0), InvalidInput) << axis;
    EXPECT_THROW(core::check_box(high, 0), InvalidInput) << axis;
  }
}

TEST(InputCheck, RefusesMinAboveMaxOnAnyAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    Box3 box{{0, 0, 0}, {1, 1, 1}};
    box.min[axis] = 2;
    EXPECT_THROW(core::check_box(box, 0), InvalidInput) << axis;
  }
}

TEST(InputCheck, RefusesABoxThatIsAbsentOnOneAxisOnly) {
  EXPECT_THROW(core::check_box(Box2{{infinity, 0}, {-infinity, 1}}, 0), InvalidInput);
}

TEST(InputCheck, NamesIndexAndValuesAndWhatIsExpected) {
  const std::vector<Box2> boxes = {
      absent_box<2>(), {{0, 0}, {1, 1}}, {{0.5f, 2}, {nan, -infinity}}, {{1, 1}, {0, 0}}};
  EXPECT_THAT(message_of<InvalidInput>([&] { core::check_boxes(std::span<const Box2>(boxes)); }),
              names("box 2", "(0.5, 2)", "(nan, -inf)", "min <= max"));
  try {
    core::check_boxes(std::span<const Box2>(boxes), 3);
    FAIL() << "nothing was thrown";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.index(), 3u);
  }
}

TEST(InputCheck, WritesNumbersTheSameWayInAnyLocale) {
  struct Thousands final : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Thousands));
  const std::string message = message_of<InvalidInput>([] {
    core::check_box(Box2{{123456, 0.5f}, {0, 1}}, 1000000);
  });
  std::locale::global(before);
  EXPECT_TRUE(message.starts_with("box 1000000 has min (123456, 0.5) and max (0, 1);")) << message;
}

TEST(InputCheck, RefusesMoreBoxesThanIds) {
  constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max();
  EXPECT_NO_THROW(core::check_count(most));
  EXPECT_THAT(message_of<InvalidFrame>([] { core::check_count(most + 1); }),
              names("4294967296", "4294967295"));
}

}  // namespace
}  // namespace broadside

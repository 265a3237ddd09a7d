// BoxView: a range over boxes in the caller's memory.
#include "broadside/box_view.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <ranges>
#include <span>
#include <type_traits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/boxes.hpp"

namespace broadside {
namespace {

using testing::ElementsAreArray;

static_assert(std::ranges::random_access_range<BoxView<2>> && std::ranges::sized_range<BoxView<2>>);
static_assert(std::ranges::view<BoxView<2>> && std::ranges::borrowed_range<BoxView<2>>);
static_assert(std::is_convertible_v<std::array<Box3, 2>, BoxView<3>>);
static_assert(std::is_convertible_v<const Box2 (&)[2], BoxView<2>>);
static_assert(std::is_convertible_v<std::span<Box2>, BoxView<2>>);
static_assert(!std::is_convertible_v<std::vector<Box3>, BoxView<2>>);
static_assert(!std::is_convertible_v<std::vector<DoubleBox2>, BoxView<2>>);
static_assert(!BoxRange<std::vector<int>> && !BoxRange<std::vector<Box<4>>> && !BoxRange<int>);

struct Labelled {
  char name;
  Box2 box;
};

const std::vector<Box2> three_boxes = {{{0, 0}, {1, 1}}, {{2, 0}, {3, 1}}, {{4, 0}, {5, 1}}};
const std::vector<Labelled> labelled = {{'a', three_boxes[0]}, {'b', three_boxes[1]}, {'c', three_boxes[2]}};
const std::array<BoxView<2>, 2> views_of_three = {
    BoxView<2>(three_boxes), BoxView<2>(&labelled[0].box, labelled.size(), sizeof(Labelled))};

TEST(BoxView, IsARange) {
  for (const BoxView<2>& view : views_of_three) {
    std::vector<Box2> seen;
    for (const Box2& box : view) seen.push_back(box);
    EXPECT_THAT(seen, ElementsAreArray(three_boxes));
    EXPECT_EQ(std::ranges::find(view, three_boxes[1]) - view.begin(), 1);
    EXPECT_EQ(std::vector<Box2>(view.begin(), view.end()), three_boxes);
  }
}

TEST(BoxView, IsReadInAnyOrder) {
  for (const BoxView<2>& view : views_of_three) {
    auto it = view.end();
    EXPECT_EQ(*--it, three_boxes[2]);
    EXPECT_EQ(*(it - 2), three_boxes[0]);
    EXPECT_EQ(view.begin()[1], three_boxes[1]);
    EXPECT_LT(view.begin(), it);
    EXPECT_EQ(*std::ranges::prev(it--), three_boxes[1]);
    EXPECT_EQ(*it++, three_boxes[1]);
  }
}

}  // namespace
}  // namespace broadside

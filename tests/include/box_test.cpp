// Box: what is made of boxes, and what absent and infinite ones do there.
#include "broadside/box.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/boxes.hpp"

namespace broadside {
namespace {

constexpr Box2 unit{{0, 0}, {1, 1}};
constexpr Box2 half_plane{{0, -infinity}, {infinity, infinity}};

TEST(BoxAround, ReachesAsFarOnBothSides) {
  EXPECT_EQ(Box2::around({1, 2}, {3, 0.5f}), (Box2{{-2, 1.5f}, {4, 2.5f}}));
  EXPECT_EQ(Box3::around({1, 2, 3}, 1), (Box3{{0, 1, 2}, {2, 3, 4}}));
  EXPECT_EQ(DoubleBox2::around({0.1, 0}, 0), (DoubleBox2{{0.1, 0}, {0.1, 0}}));
}

TEST(BoxContains, ItsBoundsAndNothingBeyond) {
  EXPECT_TRUE(contains(unit, {0, 1}));
  EXPECT_FALSE(contains(unit, {std::nextafter(1.0f, 2.0f), 1}));
  EXPECT_FALSE(contains(unit, {0.5f, nan}));
  EXPECT_TRUE(contains(half_plane, {0, -infinity}));
  EXPECT_FALSE(contains(absent_box<2>(), {0, 0}));
}

TEST(BoxContains, ABoxOfWhichNoPointIsOutside) {
  EXPECT_TRUE(contains(unit, unit));
  EXPECT_TRUE(contains(unit, Box2{{0, 0.5f}, {0, 1}}));
  EXPECT_FALSE(contains(unit, Box2{{0, 0}, {1, 2}}));
  EXPECT_TRUE(contains(half_plane, unit));
  EXPECT_FALSE(contains(unit, half_plane));
  EXPECT_TRUE(contains(unit, absent_box<2>()));
  EXPECT_FALSE(contains(absent_box<2>(), unit));
}

TEST(BoxesMerged, AreTheSmallestThatContainsBoth) {
  EXPECT_EQ(merged(unit, Box2{{-1, 0.5f}, {0, 3}}), (Box2{{-1, 0}, {1, 3}}));
  EXPECT_EQ(merged(unit, half_plane), half_plane);
  EXPECT_EQ(merged(absent_box<2>(), unit), unit);
  EXPECT_EQ(merged(unit, absent_box<2>()), unit);
  EXPECT_TRUE(is_absent(merged(absent_box<2>(), absent_box<2>())));
}

TEST(BoxEnlarged, ReachesFurtherOnEachSide) {
  EXPECT_EQ(enlarged(unit, 2), (Box2{{-2, -2}, {3, 3}}));
  EXPECT_EQ(enlarged(unit, -0.25f), (Box2{{0.25f, 0.25f}, {0.75f, 0.75f}}));
  EXPECT_FALSE(is_present(enlarged(unit, -1)));
  EXPECT_EQ(enlarged(half_plane, 1), (Box2{{-1, -infinity}, {infinity, infinity}}));
  EXPECT_TRUE(is_absent(enlarged(absent_box<2>(), 1)));
}

TEST(BoxTranslated, KeepsItsSides) {
  EXPECT_EQ(translated(unit, {1, -2}), (Box2{{1, -2}, {2, -1}}));
  EXPECT_EQ(translated(half_plane, {1, 1}), (Box2{{1, -infinity}, {infinity, infinity}}));
  EXPECT_TRUE(is_absent(translated(absent_box<2>(), {1, 1})));
}

TEST(BoxCentreAndExtent, AreThoseOfItsBounds) {
  EXPECT_EQ(centre(Box2{{1, -1}, {2, 5}}), (Point<2>{1.5f, 2}));
  EXPECT_EQ(extent(Box2{{1, -1}, {2, 5}}), (Point<2>{1, 6}));
  constexpr double max = std::numeric_limits<double>::max();
  EXPECT_EQ(centre(DoubleBox2{{max, 0}, {max, 0}}), (Point<2, double>{max, 0})) << "without overflow";
  EXPECT_EQ(extent(half_plane)[0], infinity);
}

TEST(HalfOpen, LowersEachMaximumAboveItsMinimumToTheNextNumber) {
  const auto max_of = []<typename Real>(Real min, Real max) {
    return half_open(Box<2, Real>{{min, 0}, {max, 0}}).max[0];
  };
  for (const float max : {1.0F, -1.0F, 0.0F, -0.0F, 1e-45F, -1e-45F, 3.4e38F, 1.17549435e-38F})
    EXPECT_EQ(max_of(-infinity, max), std::nextafter(max, -infinity)) << max;
  for (const double max : {1.0, -1.0, 0.0, 5e-324, -5e-324, 1e308})
    EXPECT_EQ(max_of(-double{infinity}, max), std::nextafter(max, -double{infinity})) << max;
  EXPECT_EQ(max_of(2.0F, 2.0F), 2.0F);
  EXPECT_EQ(max_of(-infinity, -infinity), -infinity);
  EXPECT_EQ(max_of(infinity, infinity), infinity);
  EXPECT_EQ(max_of(0.0F, infinity), infinity);
  EXPECT_TRUE(is_absent(half_open(absent_box<2>())));
  static_assert(half_open(Box2{{0, 1}, {1, 1}}) == Box2{{0, 1}, {0.99999994F, 1}});
}

}  // namespace
}  // namespace broadside

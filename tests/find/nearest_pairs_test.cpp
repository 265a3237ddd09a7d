// nearest_pairs(): for each box the nearest ones, as the definition says.
#include "broadside/nearest_pairs.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"

#include "tests/support/message.hpp"
#include "tests/support/rng.hpp"

namespace broadside {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The rows by the definition. `right` is null for one set.
template <int D, typename Real>
NearestPairs expected_pairs(const std::vector<Box<D, Real>>& left, const std::vector<Box<D, Real>>* right,
                            std::size_t k, const NearestPairsOptions& options) {
  NearestPairs expected{.k = k, .boxes = {}, .distances_squared = {}};
  const std::vector<Box<D, Real>>& others = right == nullptr ? left : *right;
  const auto filters = right == nullptr ? options.filters : options.right_filters;
  for (std::size_t i = 0; i < left.size(); ++i) {
    std::vector<Neighbour> row;
    for (std::size_t j = 0; j < others.size(); ++j) {
      if ((right == nullptr && i == j) || !is_present(left[i]) || !is_present(others[j])) continue;
      const Filter own = options.filters.empty() ? Filter{} : options.filters[i];
      if (!(options.filters.empty() && filters.empty()) &&
          !accepts(own, filters.empty() ? Filter{} : filters[j]))
        continue;
      const double squared = distance_squared(left[i], others[j]);
      if (squared <= options.max_distance * options.max_distance) row.push_back({BoxId(j), squared});
    }
    std::ranges::stable_sort(row, {}, &Neighbour::distance_squared);
    row.resize(k, {no_box, std::numeric_limits<double>::infinity()});
    for (const Neighbour& one : row) {
      expected.boxes.push_back(one.box);
      expected.distances_squared.push_back(one.distance_squared);
    }
  }
  return expected;
}

/// Boxes with many exact ties: points of a small grid, duplicates, boxes that touch, infinite and absent
/// ones.
template <int D, typename Real>
std::vector<Box<D, Real>> tied_boxes(Rng& rng, std::size_t count) {
  const int places = rng.whole(1, 12);
  const bool are_points = rng.one_in(2);
  const Real unit = rng.one_in(3) ? Real(1) / 3 : Real(1);
  std::vector<Box<D, Real>> boxes(count);
  for (Box<D, Real>& box : boxes) {
    for (std::size_t axis = 0; axis < box.min.size(); ++axis) {
      box.min[axis] = Real(rng.whole(0, places)) * unit;
      box.max[axis] = are_points ? box.min[axis] : box.min[axis] + Real(rng.whole(0, 2)) * unit;
      if (rng.one_in(200)) box.max[axis] = std::numeric_limits<Real>::infinity();
    }
    if (rng.one_in(50)) box = absent_box<D, Real>();
  }
  return boxes;
}

template <typename Case>
class NearestPairsLaw : public testing::Test {};

template <int Dimension, typename Coordinate>
struct BoxesOf {
  static constexpr int dimension = Dimension;
  using Real = Coordinate;
};
using Kinds = testing::Types<BoxesOf<2, float>, BoxesOf<3, float>, BoxesOf<2, double>, BoxesOf<3, double>>;
TYPED_TEST_SUITE(NearestPairsLaw, Kinds);

TYPED_TEST(NearestPairsLaw, FindsWhatTheDefinitionSays) {
  constexpr int dimension = TypeParam::dimension;
  using Real = typename TypeParam::Real;
  Rng rng(7);
  for (int round = 0; round < 60; ++round) {
    const auto left = tied_boxes<dimension, Real>(rng, rng.below(round % 10 == 0 ? 600 : 60));
    const auto right = tied_boxes<dimension, Real>(rng, rng.below(90));
    const std::size_t n = rng.one_in(2) ? left.size() : right.size();
    const std::size_t k = rng.one_in(3) ? std::max<std::size_t>(n, 1) + rng.below(2) : 1 + rng.below(12);
    NearestPairsOptions options;
    if (rng.one_in(3)) options.max_distance = rng.whole(0, 3);
    std::vector<Filter> filters(left.size());
    std::vector<Filter> right_filters(right.size());
    for (Filter& filter : filters) filter.mask = rng.one_in(2) ? 1 : 2;
    for (Filter& filter : right_filters) filter = {.category = rng.one_in(2) ? 1U : 2U, .mask = rng.below(4)};
    if (rng.one_in(3)) options.filters = filters;
    for (const bool is_self : {true, false}) {
      if (!is_self) options.right_filters = right_filters;
      const auto expected = expected_pairs(left, is_self ? nullptr : &right, k, options);
      for (const std::size_t threads : {1, 2}) {
        options.threads = threads;
        const NearestPairs found =
            is_self ? nearest_pairs(left, k, options) : nearest_pairs(left, right, k, options);
        ASSERT_EQ(found.boxes, expected.boxes) << "round " << round << ", one set: " << is_self;
        ASSERT_EQ(found.distances_squared, expected.distances_squared) << "round " << round;
      }
    }
  }
}

/// More boxes than one thread takes, and squares that lose their last places or overflow.
TYPED_TEST(NearestPairsLaw, FindsTheSameWithThreadsAndAtEveryScale) {
  constexpr int dimension = TypeParam::dimension;
  using Real = typename TypeParam::Real;
  constexpr bool is_float = std::is_same_v<Real, float>;
  Rng rng(8);
  const auto points = tied_boxes<dimension, Real>(rng, 9000);
  const NearestPairs alone = nearest_pairs(points, 3);
  EXPECT_EQ(nearest_pairs(points, 3, {.threads = 2}).boxes, alone.boxes);
  EXPECT_EQ(nearest_pairs(points, points, 4).boxes.size(), 4 * points.size());
  for (const double scale : {is_float ? 1e-40 : 1e-162, is_float ? 1e-20 : 1e-155, is_float ? 1e36 : 1e154}) {
    auto scaled = tied_boxes<dimension, Real>(rng, 200);
    for (auto& box : scaled) {
      for (Real& at : box.min) at = static_cast<Real>(at * scale);
      for (Real& at : box.max) at = static_cast<Real>(at * scale);
    }
    const auto expected = expected_pairs<dimension, Real>(scaled, nullptr, 5, {});
    const NearestPairs found = nearest_pairs(scaled, 5);
    ASSERT_EQ(found.boxes, expected.boxes) << scale;
    ASSERT_EQ(found.distances_squared, expected.distances_squared) << scale;
  }
}

/// Clusters of points of doubles so far from each other that floats hardly tell those of one cluster apart.
TEST(NearestPairs, AreExactWhereFloatsAreCoarse) {
  Rng rng(10);
  for (const double size : {1e-1, 1e-3, 1e-4, 1e-5}) {
    std::vector<DoubleBox2> points(600);
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (double& number : points[i].min) number = (i % 3 == 0 ? 1000 : 0) + size * double{rng.unit()};
      points[i].max = points[i].min;
    }
    for (const std::size_t k : {1, 4}) {
      const auto expected = expected_pairs<2, double>(points, nullptr, k, {});
      EXPECT_EQ(nearest_pairs(points, k).boxes, expected.boxes) << size;
      EXPECT_EQ(nearest_pairs(points, points, k + 1).boxes, expected_pairs(points, &points, k + 1, {}).boxes)
          << size;
    }
  }
}

/// Sixteen queries are answered together, but these are far from each other: too many boxes come near one.
TEST(NearestPairs, AreExactWhereQueriesAreFewAndFarApart) {
  Rng rng(9);
  const auto drawn = [&rng](std::size_t count) {
    std::vector<Box3> points(count);
    for (Box3& point : points) {
      for (float& number : point.min) number = rng.unit();
      point.max = point.min;
    }
    return points;
  };
  const auto left = drawn(16);
  const auto right = drawn(20'000);
  EXPECT_EQ(nearest_pairs(left, right, 29).boxes, expected_pairs(left, &right, 29, {}).boxes);
}

/// The boxes of an index are asked for leaf by leaf, if they are the queries.
TYPED_TEST(NearestPairsLaw, SeesAQueryThatIsNoBoxOfTheIndex) {
  constexpr int dimension = TypeParam::dimension;
  using Real = typename TypeParam::Real;
  std::vector<Box<dimension, Real>> boxes(4);
  std::vector<BoxId> itself;
  for (const int x : {0, 1, 3, 20}) {
    auto& box = boxes[itself.size()];
    box.min[0] = box.max[0] = Real(x);
    itself.push_back(BoxId(itself.size()));
  }
  BoxIndex<dimension, Real> index;
  index.update({.boxes = boxes});
  std::vector<BoxId> found(4);
  std::vector<double> distances(4);
  index.nearest_of_each(boxes, 1, found, distances, {.except = itself});
  EXPECT_THAT(found, ElementsAre(BoxId(1), BoxId(0), BoxId(1), BoxId(2)));
  auto queries = boxes;
  queries[0].min[0] = queries[0].max[0] = Real(2.25);
  index.nearest_of_each(queries, 1, found, distances, {.except = itself});
  EXPECT_THAT(found, ElementsAre(BoxId(2), BoxId(0), BoxId(1), BoxId(2)));
}

TEST(NearestPairs, NamesTheNearestOfEachBox) {
  const std::vector<Box2> shops = {{{0, 0}, {1, 1}}, {{4, 0}, {5, 1}}, {{6, 0}, {7, 1}}};
  const std::vector<Box2> stops = {{{2, 0}, {2, 0}}, {{9, 1}, {9, 1}}};
  const NearestPairs found = nearest_pairs(shops, stops, 3);
  EXPECT_THAT(found.of(BoxId(0)), ElementsAre(BoxId(0), BoxId(1)));
  EXPECT_THAT(found.of(BoxId(2)), ElementsAre(BoxId(1), BoxId(0)));
  EXPECT_THAT(nearest_pairs(shops, 1).boxes, ElementsAre(BoxId(1), BoxId(2), BoxId(1)));
  EXPECT_THAT(nearest_pairs(shops, 1, {.max_distance = 1}).boxes, ElementsAre(no_box, BoxId(2), BoxId(1)));
}

TEST(NearestPairs, RefusesBadInputByName) {
  const std::vector<Box2> good(3, Box2{{0, 0}, {1, 1}});
  std::vector<Box2> bad = good;
  bad[1].max[0] = -1;
  const std::vector<Filter> filters(2);
  EXPECT_THAT(message_of<InvalidInput>([&] { static_cast<void>(nearest_pairs(bad, 1)); }),
              HasSubstr("box 1 has"));
  EXPECT_THAT(message_of<InvalidInput>([&] { static_cast<void>(nearest_pairs(bad, good, 1)); }),
              HasSubstr("left box 1 has"));
  EXPECT_THAT(message_of<InvalidInput>([&] { static_cast<void>(nearest_pairs(good, bad, 1)); }),
              HasSubstr("right box 1 has"));
  EXPECT_THAT(message_of<InvalidQuery>([&] { static_cast<void>(nearest_pairs(good, 0)); }),
              HasSubstr("k is 0"));
  EXPECT_THAT(
      message_of<InvalidQuery>([&] { static_cast<void>(nearest_pairs(good, 1, {.max_distance = -1})); }),
      HasSubstr("max_distance is -1"));
  EXPECT_THROW(static_cast<void>(nearest_pairs(good, 1, {.filters = filters})), InvalidFrame);
  EXPECT_THROW(static_cast<void>(nearest_pairs(good, 1, {.right_filters = filters})), InvalidFrame);
  EXPECT_THROW(static_cast<void>(nearest_pairs(good, good, 1, {.right_filters = filters})), InvalidFrame);
}

}  // namespace
}  // namespace broadside

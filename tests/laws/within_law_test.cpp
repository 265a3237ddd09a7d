// The law of pairs within a distance: the definition for every two boxes, where distances tie, and where
// coordinates are huge, tiny or infinite.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/components.hpp"
#include "broadside/keys.hpp"
#include "broadside/within.hpp"
#include "broadside/world.hpp"

#include "law_case.hpp"
#include "pair_reference.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/drawn_boxes.hpp"
#include "tests/support/model.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

/// Boxes of small whole numbers: distances tie with whole numbers and with each other. Many are points.
template <int D>
using Lattice = std::vector<std::array<int, 2 * D>>;

template <int D>
Lattice<D> drawn_lattice(Rng& rng, std::size_t count) {
  Lattice<D> lattice(count);
  for (auto& box : lattice) {
    const bool is_point = rng.one_in(2);
    for (int axis = 0; axis < D; ++axis) {
      box[axis] = rng.whole(0, D == 2 ? 60 : 24);
      box[axis + D] = box[axis] + (is_point ? 0 : rng.whole(0, 4));
    }
  }
  return lattice;
}

/// The boxes times 2^exponent, which no coordinate loses a bit by.
template <int D, typename Real>
Boxes<D, Real> scaled_boxes(const Lattice<D>& lattice, int exponent) {
  Boxes<D, Real> boxes(lattice.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      boxes[i].min[axis] = static_cast<Real>(std::ldexp(lattice[i][axis], exponent));
      boxes[i].max[axis] = static_cast<Real>(std::ldexp(lattice[i][axis + D], exponent));
    }
  }
  return boxes;
}

template <int D>
bool are_within(const std::array<int, 2 * D>& a, const std::array<int, 2 * D>& b, int distance) {
  int square = 0;
  for (int axis = 0; axis < D; ++axis) {
    const int gap = std::max({a[axis] - b[axis + D], b[axis] - a[axis + D], 0});
    square += gap * gap;
  }
  return square <= distance * distance;
}

/// The definition for any numbers: everything is scaled until the greatest number is about 1.
template <int D, typename Real>
bool are_within(const Box<D, Real>& a, const Box<D, Real>& b, double distance) {
  if (!is_present(a) || !is_present(b)) return false;
  std::array<double, D> gaps{};
  double greatest = distance;
  for (int axis = 0; axis < D; ++axis) {
    if (a.min[axis] > b.max[axis]) gaps[axis] = static_cast<double>(a.min[axis]) - b.max[axis];
    if (b.min[axis] > a.max[axis]) gaps[axis] = static_cast<double>(b.min[axis]) - a.max[axis];
    greatest = std::max(greatest, gaps[axis]);
  }
  if (std::isinf(greatest)) return false;
  if (greatest == 0) return true;
  const int exponent = -std::ilogb(greatest);
  double sum = 0;
  for (const double gap : gaps) sum += std::ldexp(gap, exponent) * std::ldexp(gap, exponent);
  const double limit = std::ldexp(distance, exponent);
  return distance == 0 ? false : sum <= limit * limit;
}

class WithinLaw : public Law {
 protected:
  FindOptions options() const { return {.algorithm = spec()}; }

  template <int D, typename Real>
  void find_on_lattice(Rng& rng, std::size_t count, int exponent) {
    const Lattice<D> lattice = drawn_lattice<D>(rng, count);
    const Boxes<D, Real> boxes = scaled_boxes<D, Real>(lattice, exponent);
    const std::span<const Box<D, Real>> all = boxes;
    const std::size_t left_count = count / 3;
    for (const int distance : {0, 1, 5}) {
      SCOPED_TRACE(distance);
      const double reach = std::ldexp(distance, exponent);
      const auto within = [&](std::size_t i, std::size_t j) {
        return are_within<D>(lattice[i], lattice[j], distance);
      };
      EXPECT_EQ(sorted(find_pairs_within(boxes, reach, options())), reference(count, 0, within));
      EXPECT_EQ(sorted(find_pairs_within(all.first(left_count), all.subspan(left_count), reach, options())),
                reference(count, left_count, within));
    }
    std::vector<int> whole(count);
    std::vector<double> radii(count);
    for (std::size_t i = 0; i < count; ++i) radii[i] = std::ldexp(whole[i] = rng.whole(0, 3), exponent);
    const auto within = [&](std::size_t i, std::size_t j) {
      return are_within<D>(lattice[i], lattice[j], whole[i] + whole[j]);
    };
    EXPECT_EQ(sorted(find_pairs_within(boxes, radii, options())), reference(count, 0, within));
    const std::span<const double> some = radii;
    EXPECT_EQ(sorted(find_pairs_within(all.first(left_count), all.subspan(left_count),
                                       {some.first(left_count), some.subspan(left_count)}, options())),
              reference(count, left_count, within));
  }

  template <int D, typename Real>
  void find_anywhere(Rng& rng, std::size_t count, bool are_points) {
    Boxes<D, Real> boxes(count);
    for (Box<D, Real>& box : boxes) {
      box = !are_points && rng.one_in(20) ? absent_box<D, Real>() : box_of_any_floats<D, Real>(rng);
      if (are_points) {
        for (Real& number : box.min) number = std::isfinite(number) ? number : 0;
        box.max = box.min;
      }
      if (rng.one_in(2) && is_present(box)) box.max = box.min;
    }
    for (const double distance : {0.0, 5e-324, 1e-45, 1e-20, 0.1, 1.0, 3.7, 1e6, 1e30, 3e38, 1e308}) {
      SCOPED_TRACE(distance);
      EXPECT_EQ(sorted(find_pairs_within(boxes, distance, options())),
                reference(count, 0, [&](std::size_t i, std::size_t j) {
                  return are_within(boxes[i], boxes[j], distance);
                }));
    }
    // A distance that is exactly one of them, and the next lower number.
    for (int time = 0; time < 10; ++time) {
      const Pair tie = random_pair(rng, count);
      if (!is_present(boxes[tie.first]) || !is_present(boxes[tie.second])) continue;
      const double exact = distance(boxes[tie.first], boxes[tie.second]);
      if (!(exact > 0) || std::isinf(exact)) continue;
      for (const double reach : {exact, std::nextafter(exact, 0)}) {
        EXPECT_EQ(sorted(find_pairs_within(boxes, reach, options())),
                  reference(count, 0, [&](std::size_t i, std::size_t j) {
                    return are_within(boxes[i], boxes[j], reach);
                  }));
      }
    }
  }
};

TEST_P(WithinLaw, FindsEachPairOfALatticeWhoseDistancesTie) {
  in_dimension([&]<int D>() {
    Rng rng(1);
    for (const int exponent : {0, -149, 118, -30}) find_on_lattice<D, float>(rng, reduced(160), exponent);
    for (const int exponent : {0, -1074, 1010, -600}) find_on_lattice<D, double>(rng, reduced(160), exponent);
  });
}

TEST_P(WithinLaw, FindsEachPairOfAnyNumbers) {
  in_dimension([&]<int D>() {
    Rng rng(2);
    for (const bool are_points : {false, true}) {
      find_anywhere<D, float>(rng, reduced(100), are_points);
      find_anywhere<D, double>(rng, reduced(100), are_points);
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, WithinLaw, testing::ValuesIn(cases_of(algorithms())), case_name);

/// Points in the unit cube.
std::vector<Box3> drawn_points(std::size_t count) {
  Rng rng(3);
  std::vector<Box3> points(count);
  for (Box3& point : points) {
    for (float& number : point.min) number = rng.unit();
    point.max = point.min;
  }
  return points;
}

/// So many boxes are sorted by place, unless they have filters. The second time, not all are points.
TEST(Within, GivesTheSamePairsInTheSameOrderWhateverTheThreads) {
  std::vector<Box3> points = drawn_points(33'000);
  std::vector<double> radii(points.size());
  for (std::size_t i = 0; i < radii.size(); ++i) radii[i] = 0.005 * static_cast<double>(i % 4);
  const std::vector<Filter> all(points.size());
  for (const Reach& reach : {Reach(0.02), Reach(radii)}) {
    const Pairs alone = find_pairs_within(points, reach, {.algorithm = "auto:threads=1"});
    EXPECT_GT(alone.size(), points.size() / 4);
    EXPECT_EQ(find_pairs_within(points, reach, {.algorithm = "auto:threads=4"}), alone);
    EXPECT_EQ(sorted(alone), sorted(find_pairs_within(points, reach, {.filters = all})));
    Components components(points.size());
    find_pairs_within(points, reach, static_cast<PairSink&>(components), {.algorithm = "auto:threads=4"});
    Components expected(points.size());
    for (const Pair pair : alone) expected.add(pair.first, pair.second);
    EXPECT_EQ(components.labels(), expected.labels());
    points[7].min[1] = -infinity;
    points[8].max[2] = infinity;
  }
}

TEST(Within, TakesFiltersKeysAndIgnoredPairs) {
  const std::vector<Box3> points = drawn_points(500);
  std::vector<int> keys(points.size());
  for (std::size_t i = 0; i < keys.size(); ++i) keys[i] = static_cast<int>(i % 3);
  const std::vector<Filter> filters = filters_of_keys(KeyRule::same, keys);
  Pairs expected = sorted(find_pairs_within(points, 0.1));
  std::erase_if(expected, [&](Pair pair) { return keys[pair.first] != keys[pair.second]; });
  ASSERT_GT(expected.size(), 10U);
  IgnoredPairs ignored;
  ignored.insert(expected[5]);
  expected.erase(expected.begin() + 5);
  EXPECT_EQ(sorted(find_pairs_within(points, 0.1, {.filters = filters, .ignored = &ignored})), expected);
}

TEST(Within, FindsBoxesWhoseGapIsRoundedToTheReach) {
  const double next = std::nextafter(0.5, 1.0);
  const std::vector<DoubleBox2> boxes = {{{-0.5, 0}, {-0.5, 0}}, {{next, 0}, {next, 0}}};
  ASSERT_TRUE(is_within(boxes[0], boxes[1], 1));
  EXPECT_EQ(find_pairs_within(boxes, 1), Pairs{pair(0, 1)});
}

TEST(Within, GivesDistancesOfAtMostTheReach) {
  const std::vector<Box3> points = drawn_points(500);
  const Pairs pairs = find_pairs_within(points, 0.1);
  const std::vector<double> found = distances(points, pairs);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    EXPECT_EQ(found[i], distance(points[pairs[i].first], points[pairs[i].second]));
    EXPECT_LE(found[i], 0.1);
  }
  EXPECT_EQ(distance(Box2{{0, 0}, {1, 1}}, Box2{{4, 5}, {6, 6}}), 5);
  EXPECT_EQ(distance(DoubleBox2{{0, 0}, {0, 0}}, DoubleBox2{{3e300, 4e300}, {4e300, 4e300}}), 5e300);
  EXPECT_EQ(distance(DoubleBox2{{0, 0}, {0, 0}}, DoubleBox2{{3e-320, 0}, {4e-320, 0}}), 3e-320);
  EXPECT_EQ(distance(Box2{{0, 0}, {infinity, 1}}, Box2{{infinity, 0}, {infinity, 1}}), 0);
  EXPECT_TRUE(is_within(Box2{{0, 0}, {1, 1}}, Box2{{4, 5}, {6, 6}}, 5));
  EXPECT_FALSE(is_within(Box2{{0, 0}, {1, 1}}, Box2{{4, 5}, {6, 6}}, std::nextafter(5.0, 0.0)));
  EXPECT_THROW(static_cast<void>(distances(points, Pairs{pair(0, 500)})), InvalidFrame);
}

TEST(Within, ListsNeighboursOnceOrTwice) {
  const std::vector<Box3> points = drawn_points(400);
  const Pairs pairs = find_pairs_within(points, 0.12);
  const Neighbours half = neighbours(pairs, points.size(), NeighbourLists::half);
  const Neighbours full = neighbours(pairs, points.size(), NeighbourLists::full);
  for (std::size_t i = 0; i < points.size(); ++i) {
    Ids greater;
    Ids all;
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (i == j || !is_within(points[i], points[j], 0.12)) continue;
      all.push_back(BoxId(j));
      if (j > i) greater.push_back(BoxId(j));
    }
    EXPECT_TRUE(std::ranges::equal(half.of(i), greater)) << i;
    EXPECT_TRUE(std::ranges::equal(full.of(i), all)) << i;
  }
  EXPECT_EQ(neighbours({}, 0, NeighbourLists::full).offsets, (std::vector<std::size_t>{0}));
  EXPECT_EQ(neighbours({pair(0, 9)}, 2, NeighbourLists::half).offsets, (std::vector<std::size_t>{0, 1, 1}));
  EXPECT_THROW(static_cast<void>(neighbours({pair(0, 2)}, 2, NeighbourLists::full)), InvalidFrame);
  EXPECT_THROW(static_cast<void>(neighbours({pair(2, 0)}, 2, NeighbourLists::half)), InvalidFrame);
}

template <typename Error, typename Call>
void expect_error(const Call& call, const std::string& text) {
  try {
    call();
    ADD_FAILURE() << "expected an exception: " << text;
  } catch (const Error& error) {
    EXPECT_EQ(error.what(), text);
  }
}

TEST(Within, RefusesReachesThatAreNone) {
  const std::vector<Box2> boxes = {{{0, 0}, {1, 1}}, {{2, 0}, {3, 1}}};
  PairCounter counter;
  PairSink& pairs = counter;
  const auto find = [&](const Reach& reach, const FindOptions& options = {}) {
    return [&, options] { find_pairs_within(boxes, reach, pairs, options); };
  };
  expect_error<InvalidQuery>(find(-1), "the distance is -1; expected a finite number of 0 or more");
  expect_error<InvalidQuery>(find(nan), "the distance is nan; expected a finite number of 0 or more");
  expect_error<InvalidQuery>(find(infinity), "the distance is inf; expected a finite number of 0 or more");
  const std::vector<double> wrong = {1, -2};
  expect_error<InvalidQuery>(find(wrong), "the radius of box 1 is -2; expected a finite number of 0 or more");
  const std::vector<double> many = {1, 2, 3};
  expect_error<InvalidFrame>(find(many), "3 radii for 2 boxes; expected one for each box");
  expect_error<InvalidFrame>(find({many, many}), "3 radii for 2 boxes; expected one for each box");
  const std::vector<double> two = {1, 2};
  expect_error<InvalidFrame>(find({two, two}), "2 radii for 0 right boxes; expected one for each box");
  expect_error<InvalidFrame>([&] { find_pairs_within(boxes, boxes, two, pairs); },
                             "0 radii for 2 right boxes; expected one for each box");
  expect_error<std::invalid_argument>(find(1, {.touching = false}),
                                      "touching is false for pairs within a distance; expected true");
  EXPECT_EQ(counter.count(), 0U);
}

TEST(Within, NamesInvalidBoxesByTheCallersNumbersAndQuarantinesThem) {
  const std::vector<Box2> boxes = {{{0, 0}, {1, 1}}, {{3, 0}, {2.5F, 1}}, {{1.5F, 0}, {2, 1}}};
  expect_error<InvalidInput>(
      [&] { static_cast<void>(find_pairs_within(boxes, 1)); },
      "box 1 has min (3, 0) and max (2.5, 1); expected numbers with min <= max on every "
      "axis, or the absent box (min = +inf, max = -inf)");
  std::vector<BoxId> quarantined;
  EXPECT_EQ(find_pairs_within(boxes, 1, {.quarantined = &quarantined}), Pairs{pair(0, 2)});
  EXPECT_EQ(quarantined, Ids{BoxId{1}});
}

TEST(Within, IsWhatAWorldOfEnlargedBoxesWithAPredicateReports) {
  const double reach = 0.125;
  std::vector<Box3> points = drawn_points(300);
  World3 world({.margin = 0.01});
  world.set_predicate([&](Handle a, Handle b) { return is_within(points[a.slot], points[b.slot], reach); });
  std::vector<Handle> handles;
  for (const Box3& point : points) handles.push_back(world.add(enlarged(point, 0.07F)));
  Rng rng(4);
  for (int frame = 0; frame < 10; ++frame) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      points[i].min[0] = points[i].max[0] = points[i].min[0] + 0.02F * (rng.unit() - 0.5F);
      world.move(handles[i], enlarged(points[i], 0.07F));
      world.refilter(handles[i]);
    }
    world.update();
    Pairs found;
    for (const HandlePair held : world.pairs()) found.push_back(ordered(held.first.slot, held.second.slot));
    EXPECT_EQ(sorted(found), sorted(find_pairs_within(points, reach))) << frame;
  }
}

}  // namespace
}  // namespace broadside::laws

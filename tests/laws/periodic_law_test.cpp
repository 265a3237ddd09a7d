// The law of space that repeats: the pairs of boxes that have images within the distance, each once.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/within.hpp"

#include "law_case.hpp"
#include "pair_reference.hpp"
#include "tests/support/model.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Boxes of small whole numbers in many cells. Many are points, some longer than a period.
template <int D>
using Lattice = std::vector<std::array<int, 2 * D>>;

template <int D>
Lattice<D> drawn_lattice(Rng& rng, std::size_t count) {
  Lattice<D> lattice(count);
  for (auto& box : lattice) {
    const bool is_point = rng.one_in(2);
    const int longest = rng.one_in(10) ? 30 : 4;
    for (int axis = 0; axis < D; ++axis) {
      box[axis] = rng.whole(-60, 60);
      box[axis + D] = box[axis] + (is_point ? 0 : rng.whole(0, longest));
    }
  }
  return lattice;
}

template <int D, typename Real>
Boxes<D, Real> boxes_of_lattice(const Lattice<D>& lattice) {
  Boxes<D, Real> boxes(lattice.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      boxes[i].min[axis] = static_cast<Real>(lattice[i][axis]);
      boxes[i].max[axis] = static_cast<Real>(lattice[i][axis + D]);
    }
  }
  return boxes;
}

/// The squared distance of the nearest of many images. A period of 0 means that the axis does not repeat.
template <int D>
int squared_distance(const std::array<int, 2 * D>& a, const std::array<int, 2 * D>& b,
                     const std::array<int, D>& periods) {
  int square = 0;
  for (int axis = 0; axis < D; ++axis) {
    int least = std::numeric_limits<int>::max();
    for (int image = -16; image <= 16; ++image) {
      const int shift = image * periods[axis];
      least = std::min(least, std::max({a[axis] - b[axis + D] - shift, b[axis] + shift - a[axis + D], 0}));
    }
    square += least * least;
  }
  return square;
}

template <int D>
std::array<double, D> as_periods(const std::array<int, D>& periods) {
  std::array<double, D> result;
  for (int axis = 0; axis < D; ++axis) result[axis] = periods[axis] == 0 ? infinity : periods[axis];
  return result;
}

class PeriodicLaw : public Law {
 protected:
  FindOptions options() const { return {.algorithm = spec()}; }

  template <int D, typename Real>
  void find_on_lattice(Rng& rng, const std::array<int, D>& whole_periods) {
    const std::size_t count = reduced(120);
    const Lattice<D> lattice = drawn_lattice<D>(rng, count);
    const Boxes<D, Real> boxes = boxes_of_lattice<D, Real>(lattice);
    const std::array<double, D> periods = as_periods<D>(whole_periods);
    const std::span<const Box<D, Real>> all = boxes;
    const std::size_t left_count = count / 3;
    const auto square = [&](std::size_t i, std::size_t j) {
      return squared_distance<D>(lattice[i], lattice[j], whole_periods);
    };
    for (const int distance : {0, 1, 3, 12}) {
      SCOPED_TRACE(distance);
      const auto within = [&](std::size_t i, std::size_t j) { return square(i, j) <= distance * distance; };
      const Reach reach = Reach(distance).periodic(periods);
      const Pairs found = sorted(find_pairs_within(boxes, reach, options()));
      ASSERT_EQ(found, reference(count, 0, within));
      EXPECT_EQ(sorted(find_pairs_within(all.first(left_count), all.subspan(left_count), reach, options())),
                reference(count, left_count, within));
      const std::vector<double> found_distances = distances(boxes, found, periods);
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_EQ(found_distances[i], std::sqrt(square(index(found[i].first), index(found[i].second))));
      }
    }
    std::vector<int> whole(count);
    std::vector<double> radii(count);
    for (std::size_t i = 0; i < count; ++i) radii[i] = whole[i] = rng.one_in(8) ? rng.whole(0, 9) : 0;
    EXPECT_EQ(sorted(find_pairs_within(boxes, Reach(radii).periodic(periods), options())),
              reference(count, 0, [&](std::size_t i, std::size_t j) {
                return square(i, j) <= (whole[i] + whole[j]) * (whole[i] + whole[j]);
              }));
  }

  template <int D, typename Real>
  void find_anywhere(Rng& rng) {
    const std::size_t count = reduced(120);
    Boxes<D, Real> boxes(count);
    for (Box<D, Real>& box : boxes) {
      for (int axis = 0; axis < D; ++axis) {
        box.min[axis] = static_cast<Real>(rng.between(-3, 3));
        box.max[axis] = box.min[axis] + static_cast<Real>(rng.between(0, 0.3));
      }
      if (rng.one_in(9)) box = absent_box<D, Real>();
    }
    std::array<double, D> periods;
    periods.fill(1.1);
    periods[0] = 0.7;
    for (const double reach : {0.0, 0.05, 0.4}) {
      EXPECT_EQ(sorted(find_pairs_within(boxes, Reach(reach).periodic(periods), options())),
                reference(count, 0, [&](std::size_t i, std::size_t j) {
                  if (!is_present(boxes[i]) || !is_present(boxes[j])) return false;
                  const double between = distance(boxes[i], boxes[j], periods);
                  EXPECT_EQ(between, distance(boxes[j], boxes[i], periods));
                  return between <= reach;
                }));
    }
  }
};

TEST_P(PeriodicLaw, FindsEachPairOfALatticeOnce) {
  in_dimension([&]<int D>() {
    Rng rng(1);
    std::array<int, D> periods;
    periods.fill(13);
    find_on_lattice<D, float>(rng, periods);
    find_on_lattice<D, double>(rng, periods);
    periods[0] = 8;
    periods[D - 1] = 0;
    find_on_lattice<D, float>(rng, periods);
  });
}

TEST_P(PeriodicLaw, FindsEachPairOfAnyNumbers) {
  in_dimension([&]<int D>() {
    Rng rng(2);
    find_anywhere<D, float>(rng);
    find_anywhere<D, double>(rng);
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, PeriodicLaw, testing::ValuesIn(cases_of(algorithms())), case_name);

TEST(Periodic, BoxesKeepTheirFiltersAndIgnoredPairs) {
  // All meet around the edge at 0 = 10.
  const std::vector<Box2> boxes = {
      {{9, 0}, {11, 1}}, {{0, 0}, {1, 1}}, {{-1, 0}, {0, 1}}, {{25, 0}, {26, 1}}};
  const Reach reach = Reach(0).periodic({10.0, infinity});
  EXPECT_EQ(sorted(find_pairs_within(boxes, reach)),
            (Pairs{{BoxId{0}, BoxId{1}}, {BoxId{0}, BoxId{2}}, {BoxId{1}, BoxId{2}}}));
  std::vector<Filter> filters(4);
  filters[0].group = filters[2].group = -7;
  EXPECT_EQ(sorted(find_pairs_within(boxes, reach, {.filters = filters})),
            (Pairs{{BoxId{0}, BoxId{1}}, {BoxId{1}, BoxId{2}}}));
  IgnoredPairs ignored;
  ignored.insert({BoxId{1}, BoxId{2}});
  EXPECT_EQ(sorted(find_pairs_within(boxes, reach, {.ignored = &ignored})),
            (Pairs{{BoxId{0}, BoxId{1}}, {BoxId{0}, BoxId{2}}}));
}

TEST(Periodic, InfiniteBoxesAndThoseOfAPeriodOrMoreAreTheWholeAxis) {
  const float infinite = std::numeric_limits<float>::infinity();
  const std::vector<Box2> boxes = {
      {{3, 0}, {13, 1}}, {{-infinite, 0}, {5, 1}}, {{7, 0}, {infinite, 1}}, {{1, 0}, {2, 1}}};
  EXPECT_EQ(find_pairs_within(boxes, Reach(0).periodic({10.0, 10.0})).size(), 6U);
}

TEST(Periodic, APointAtInfinityMeetsOnlyWhatIsThere) {
  const float infinite = std::numeric_limits<float>::infinity();
  const std::vector<Box2> boxes = {
      {{infinite, 0}, {infinite, 1}}, {{1, 0}, {2, 1}}, {{infinite, 0}, {infinite, 1}}};
  EXPECT_EQ(find_pairs_within(boxes, Reach(0).periodic({10.0, infinity})), (Pairs{{BoxId{0}, BoxId{2}}}));
}

std::string message_of(const Reach& reach) {
  try {
    static_cast<void>(find_pairs_within(std::vector<Box2>(2, Box2{{0, 0}, {1, 1}}), reach));
  } catch (const InvalidQuery& error) {
    return error.what();
  }
  return "nothing was thrown";
}

TEST(Periodic, RefusesOtherPeriods) {
  EXPECT_EQ(
      message_of(Reach(1).periodic({0.0, 1.0})),
      "the period of axis 0 is 0; expected a number above 0, or infinity for an axis that does not repeat");
  EXPECT_EQ(
      message_of(Reach(1).periodic({1.0, std::numeric_limits<double>::quiet_NaN()})),
      "the period of axis 1 is nan; expected a number above 0, or infinity for an axis that does not repeat");
  EXPECT_EQ(
      message_of(Reach(1).periodic(std::span<const double>())),
      "0 periods for boxes of 2 dimensions; expected 2, with infinity for an axis that does not repeat");
  EXPECT_EQ(
      message_of(Reach(1).periodic({1.0, 1.0, 1.0, 1.0})),
      "4 periods for boxes of 2 dimensions; expected 2, with infinity for an axis that does not repeat");
}

}  // namespace
}  // namespace broadside::laws

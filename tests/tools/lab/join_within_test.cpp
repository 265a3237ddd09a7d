// Pairs of boxes within a distance: exact where a sum of coordinates would round.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/sinks.hpp"

#include "lab/join.hpp"
#include "tests/support/boxes.hpp"

namespace broadside::lab {
namespace {

Entry only(std::string_view spec) {
  static const Catalogue catalogue;
  return catalogue.select(spec).at(0);
}

template <typename Real>
std::vector<Box<2, Real>> tenths(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Box<2, Real>> boxes(count);
  for (auto& box : boxes) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto from = static_cast<int>(random() % 40 + 1);
      box.min[axis] = static_cast<Real>(from / 10.0);
      box.max[axis] = static_cast<Real>((from + static_cast<int>(random() % 3)) / 10.0);
    }
  }
  boxes[count / 2] = absent_box<2, Real>();
  return boxes;
}

/// Their differences are exact in the 64 bits of a long double.
template <typename Real>
bool model(const Box<2, Real>& a, const Box<2, Real>& b, double distance) {
  bool within = !is_absent(a) && !is_absent(b);
  for (std::size_t axis = 0; within && axis < 2; ++axis) {
    within = static_cast<long double>(b.min[axis]) - static_cast<long double>(a.max[axis]) <= distance &&
             static_cast<long double>(a.min[axis]) - static_cast<long double>(b.max[axis]) <= distance;
  }
  return within;
}

template <typename Real>
void expect_exact(double distance) {
  const std::vector<Box<2, Real>> left = tenths<Real>(80, 1);
  const std::vector<Box<2, Real>> right = tenths<Real>(60, 2);
  std::vector<Pair> within;
  std::vector<Pair> between;
  for (std::uint32_t i = 0; i < left.size(); ++i) {
    for (std::uint32_t j = i + 1; j < left.size(); ++j) {
      if (model(left[i], left[j], distance)) within.push_back({BoxId(i), BoxId(j)});
    }
    for (std::uint32_t j = 0; j < right.size(); ++j) {
      if (model(left[i], right[j], distance)) between.push_back({BoxId(i), BoxId(j)});
    }
  }
  std::vector<Pair> found;
  PairCollector collector(found);
  join_within(left, distance, only("grid"), collector);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, within) << distance;
  found.clear();
  join_within(left, right, distance, only("sweep_and_prune"), collector);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, between) << distance;
}

TEST(JoinWithin, FindsThePairsWhoseGapIsAtMostTheDistanceOnEachAxis) {
  for (const double distance : {0.0, 0.1, 0.3, 0.7, 1e-300, 5e-324, 1e300}) {
    expect_exact<double>(distance);
    expect_exact<float>(distance);
  }
}

TEST(JoinWithin, TakesInfiniteBoxesAsTheyAre) {
  const std::vector<DoubleBox2> boxes = {{{0, 0}, {1, 1}},
                                         {{infinity, 0}, {infinity, 1}},
                                         {{1e308, 0}, {1.5e308, 1}},
                                         {{-infinity, 0}, {0.5, 1}}};
  std::vector<Pair> found;
  PairCollector collector(found);
  join_within(boxes, 1.7e308, only("brute_force"), collector);
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, (std::vector<Pair>{{BoxId(0), BoxId(2)}, {BoxId(0), BoxId(3)}, {BoxId(2), BoxId(3)}}));
}

}  // namespace
}  // namespace broadside::lab

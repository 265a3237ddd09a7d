// What boxes of doubles cost: as many tests at every scale, and few where floats about one origin coincide.
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "core/sample.hpp"
#include "law_case.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

constexpr std::size_t box_count = 20'000;

/// Boxes of up to `extent` anywhere in a cube of `side`, both in units by axis.
template <int D>
DoubleBoxes<D> uniform(double side, double extent, const std::array<double, 3>& units) {
  Rng rng(1);
  DoubleBoxes<D> boxes(box_count);
  for (Box<D, double>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = side * rng.unit() * units[axis];
      box.max[axis] = box.min[axis] + extent * rng.unit() * units[axis];
    }
  }
  return boxes;
}

template <int D>
DoubleBoxes<D> uniform(const std::array<double, 3>& units) {
  return uniform<D>(std::pow(static_cast<double>(box_count), 1.0 / D), 0.7, units);
}

/// Lines along all axes in turn, half as long as all is, that do not meet.
DoubleBoxes<3> lines() {
  DoubleBoxes<3> boxes = uniform<3>(1, 1e-12, {1, 1, 1});
  for (std::size_t i = 0; i < box_count; ++i) boxes[i].max[i % 3] += 0.5;
  return boxes;
}

/// Some 200 clusters of clusters of clusters: floats about one origin tell only the greatest apart.
template <int D>
DoubleBoxes<D> nested() {
  Rng rng(2);
  DoubleBoxes<D> boxes = uniform<D>(1e-12, 1e-14, {1, 1, 1});
  constexpr int last = D == 2 ? 3 : 1;
  for (Box<D, double>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      const double site = rng.whole(0, last) + 1e-6 * rng.whole(0, last) + 1e-10 * rng.whole(0, last);
      box.min[axis] += site;
      box.max[axis] += site;
    }
  }
  return boxes;
}

template <int D, typename Real>
std::uint64_t tests(const std::string& algorithm, std::span<const Box<D, Real>> boxes) {
  Finder<D, Real> finder(algorithm);
  PairCounter counter;
  return finder.find(boxes, counter)->tests;
}

template <int D>
std::uint64_t tests(const std::string& algorithm, const DoubleBoxes<D>& boxes) {
  return tests<D, double>(algorithm, boxes);
}

const std::vector<std::string> algorithms_that_count = {"auto", "grid", "sweep_and_prune", "quadtree", "bvh"};

template <int D>
void expect_the_same_at_every_scale(const std::string& algorithm) {
  constexpr std::array<std::array<double, 3>, 4> scales = {
      {{0x1p200, 0x1p200, 0x1p200}, {0x1p-200, 0x1p-200, 0x1p-200}, {1, 0x1p-900, 0x1p900}, {3, 3, 3}}};
  const std::uint64_t usual = tests<D>(algorithm, uniform<D>({1, 1, 1}));
  for (const std::array<double, 3>& units : scales) {
    const std::uint64_t scaled = tests<D>(algorithm, uniform<D>(units));
    // A power of two changes nothing, another factor some last bits.
    EXPECT_LE(scaled, units[0] == 3 ? usual + usual / 10 : usual) << algorithm << ", units of " << units[0];
  }
}

TEST(DoubleCost, IsTheSameAtEveryScale) {
  for (const std::string& algorithm : algorithms_that_count) {
    expect_the_same_at_every_scale<2>(algorithm);
    expect_the_same_at_every_scale<3>(algorithm);
  }
}

TEST(DoubleCost, OfLinesIsThatOfFloats) {
  const DoubleBoxes<3> boxes = lines();
  std::vector<Box3> floats;
  for (const DoubleBox3& box : boxes) {
    Box3& rounded = floats.emplace_back();
    for (int axis = 0; axis < 3; ++axis) {
      rounded.min[axis] = static_cast<float>(box.min[axis]);
      rounded.max[axis] = static_cast<float>(box.max[axis]);
    }
  }
  for (const std::string& algorithm : algorithms_that_count)
    EXPECT_LE(tests<3>(algorithm, boxes), 5 * (tests<3, float>(algorithm, floats)) / 4) << algorithm;
}

TEST(DoubleCost, IsLowWhereFloatsAboutOneOriginCoincide) {
  for (const std::string& algorithm : algorithms_that_count) {
    EXPECT_LE(tests<2>(algorithm, nested<2>()), 40 * box_count) << algorithm;
    EXPECT_LE(tests<3>(algorithm, nested<3>()), 100 * box_count) << algorithm;
  }
}

TEST(Quantiles, LeaveTheOrderOfPairsToTheBoxesAlone) {
  DoubleBoxes<2> boxes = nested<2>();
  for (DoubleBox2& box : boxes) box.max[0] += 1e-12;
  std::vector<Pair> of_one;
  std::vector<Pair> of_three;
  PairCollector first(of_one);
  PairCollector second(of_three);
  Finder<2, double>("grid:threads=1").find(boxes, first);
  Finder<2, double>("grid:threads=3").find(boxes, second);
  EXPECT_GT(of_one.size(), 100u);
  EXPECT_EQ(of_one, of_three);
}

/// Boxes are ordinary at the places that a sample of a fixed choice would look at, the others lie in a
/// heap.
TEST(DoubleCost, IsLowWhereASampleAtKnownPlacesIsFooled) {
  std::vector<bool> is_known(box_count);
  for (std::uint32_t i = 0; i < 512; ++i) is_known[core::sampled_place(i, box_count)] = true;
  DoubleBoxes<2> boxes = uniform<2>({1, 1, 1});
  Rng rng(3);
  for (std::size_t i = 0; i < box_count; ++i) {
    for (int axis = 0; axis < 2 && !is_known[i]; ++axis) {
      boxes[i].min[axis] = 1e6 + 1e-6 * rng.unit();
      boxes[i].max[axis] = boxes[i].min[axis] + 1e-9 * rng.unit();
    }
  }
  EXPECT_LE(tests<2>("bvh", boxes), 100 * box_count);
}

template <int D>
std::uint64_t tests_of_frames(double unit) {
  DoubleBoxes<D> boxes = uniform<D>({unit, unit, unit});
  Tracker<D, double> tracker("auto");
  PairCounter begun;
  PairCounter ended;
  tracker.update({boxes, {}}, begun, ended);
  std::uint64_t tests = 0;
  Rng rng(4);
  for (int frame = 0; frame < 4; ++frame) {
    std::vector<BoxId> changed;
    for (std::size_t i = frame; i < box_count; i += box_count / 100) {
      changed.push_back(BoxId(i));
      for (int axis = 0; axis < D; ++axis) {
        const double step = unit * rng.unit();
        boxes[i].min[axis] += step;
        boxes[i].max[axis] += step;
      }
    }
    tests += tracker.update({boxes, changed}, begun, ended)->tests;
  }
  return tests;
}

/// But for the boxes that a tracker tries its structures with, which depend on the coordinates' bits.
TEST(DoubleCost, OfAFrameIsTheSameAtEveryScale) {
  const auto flat = static_cast<double>(tests_of_frames<2>(1));
  const auto solid = static_cast<double>(tests_of_frames<3>(1));
  EXPECT_LE(flat, 200'000);
  EXPECT_LE(solid, 400'000);
  for (const double unit : {0x1p200, 0x1p-200, 0x1p-1010}) {
    EXPECT_NEAR(static_cast<double>(tests_of_frames<2>(unit)), flat, 0.02 * flat) << unit;
    EXPECT_NEAR(static_cast<double>(tests_of_frames<3>(unit)), solid, 0.02 * solid) << unit;
  }
}

/// Boxes that come where floats about the first ones' origin are one and the same: they are rounded
/// anew.
TEST(DoubleCost, OfAFrameIsLowWhereBoxesComeFromAfar) {
  DoubleBoxes<2> boxes = uniform<2>({1, 1, 1});
  const DoubleBoxes<2> others = uniform<2>({1e80, 1e80, 1e80});
  Tracker<2, double> tracker("auto:update=follow");
  PairCounter begun;
  PairCounter ended;
  tracker.update({boxes, {}}, begun, ended);
  std::uint64_t candidates = 0;
  for (std::size_t frame = 0; frame < 200; ++frame) {
    std::vector<BoxId> changed;
    for (std::size_t i = frame; i < box_count; i += 200) {
      changed.push_back(BoxId(i));
      boxes[i] = others[i];
    }
    candidates += tracker.update({boxes, changed}, begun, ended)->hits;
  }
  EXPECT_LE(candidates, 60 * box_count);
}

}  // namespace
}  // namespace broadside::laws

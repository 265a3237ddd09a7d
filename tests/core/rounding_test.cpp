// Doubles as floats: their order must stay, whatever they are.
#include "core/rounding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

namespace broadside::core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();
constexpr double smallest = std::numeric_limits<double>::denorm_min();

/// Numbers of every magnitude with both signs, each with its neighbours, ascending.
std::vector<double> numbers() {
  std::vector<double> numbers = {-infinity, -largest, -smallest, -0.0, 0.0, smallest, largest, infinity};
  for (int exponent = -1074; exponent < 1024; exponent += 3) {
    for (const double mantissa : {1.0, 1.3, 1 + 0x1p-24, 1 + 0x1p-40}) {
      const double number = std::ldexp(mantissa, exponent);
      for (const double near : {std::nextafter(number, 0), number, std::nextafter(number, infinity)}) {
        numbers.push_back(near);
        numbers.push_back(-near);
      }
    }
  }
  std::ranges::sort(numbers);
  return numbers;
}

template <typename Rounding>
void expect_order(const Rounding& rounding) {
  float before = -std::numeric_limits<float>::infinity();
  for (const double number : numbers()) {
    const float rounded = rounding(number);
    ASSERT_TRUE(std::isfinite(rounded)) << number;
    ASSERT_GE(rounded, before) << number;
    before = rounded;
  }
}

TEST(LinearRounding, KeepsTheOrderOfAllNumbers) {
  for (const double origin : {0.0, 1.0, -1e60, 1e-60, smallest, largest, -largest}) {
    for (const double distance : {0.0, 1.0, 1e60, 1e-60, smallest, largest}) {
      expect_order(LinearRounding(origin, distance));
      if (testing::Test::HasFatalFailure()) FAIL() << origin << ", " << distance;
    }
  }
}

TEST(LinearRounding, KeepsTheUnitInWhichTunablesAreGiven) {
  for (const double distance : {1e-9, 0.3, 250.0, 1e9}) {
    const LinearRounding rounding(5, distance);
    EXPECT_EQ(rounding(5 + 2.5), 2.5F) << distance;
  }
}

TEST(LinearRounding, TellsNeighboursApartAtEveryScale) {
  for (const double unit : {1.0, 1e60, 1e-60, 1e-300, 1e300}) {
    const LinearRounding rounding(5e6 * unit, unit);
    EXPECT_LT(rounding(5'000'000.0 * unit), rounding(5'000'000.001 * unit)) << unit;
    EXPECT_NEAR(rounding.back(rounding(5'000'000.25 * unit)) / unit, 5'000'000.25, 1e-6) << unit;
  }
}

TEST(QuantileRounding, KeepsTheOrderOfAllNumbers) {
  const std::vector<std::vector<double>> all_knots = {{},
                                                      {1},
                                                      {1, 1, 1},
                                                      {-smallest, smallest},
                                                      {-largest, largest},
                                                      {-largest, -1, 0, 1, largest},
                                                      {largest, std::nextafter(largest, 0)},
                                                      {0, smallest, 1e-300, 1e-60, 1, 1e60, 1e300}};
  for (const std::vector<double>& knots : all_knots) {
    expect_order(QuantileRounding(knots));
    if (testing::Test::HasFatalFailure()) FAIL() << testing::PrintToString(knots);
  }
  std::vector<double> finite = numbers();
  std::erase_if(finite, [](double number) { return std::isinf(number); });
  expect_order(QuantileRounding(finite));
}

TEST(QuantileRounding, TellsApartWhatLiesBetweenKnots) {
  const QuantileRounding rounding({0, 1e-60, 1, 1e60});
  for (const double unit : {1e-60, 1.0, 1e60})
    EXPECT_LT(rounding(0.5 * unit), rounding(0.501 * unit)) << unit;
  EXPECT_LT(rounding(2e60), rounding(2.001e60));
  EXPECT_LT(rounding(-2.001e60), rounding(-2e60));
}

template <int D>
void expect_fit_for(double unit) {
  std::vector<Box<D, double>> boxes(100);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    boxes[i].min.fill(unit * static_cast<double>(i));
    boxes[i].max.fill(unit * (static_cast<double>(i) + 0.5));
  }
  boxes[7] = absent_box<D, double>();
  boxes[50].max.fill(infinity);
  boxes[51].min.fill(-infinity);
  for (const LinearRounding& rounding : fit_linear<D>(boxes))
    EXPECT_LT(rounding(unit * 99), rounding(unit * 99.001));
}

TEST(FitLinear, SuitsTheBoxesThatArePresent) {
  for (const double unit : {1.0, 1e60, 1e-60, 1e-305, 1e305}) {
    expect_fit_for<2>(unit);
    expect_fit_for<3>(unit);
  }
}

}  // namespace
}  // namespace broadside::core

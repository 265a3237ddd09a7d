// What a list of measured times comes to.
#include "lab/measure/samples.hpp"

#include <numeric>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace broadside::lab {
namespace {

TEST(Median, IsTheMiddleWhateverTheOrder) {
  EXPECT_EQ(median(std::vector{5.0}), 5);
  EXPECT_EQ(median(std::vector{9.0, 1.0, 4.0}), 4);
  EXPECT_EQ(median(std::vector{8.0, 1.0, 4.0, 2.0}), 3);
}

TEST(Percentile, IsASampleThatEnoughAreNotAbove) {
  std::vector<double> samples(200);
  std::iota(samples.rbegin(), samples.rend(), 1.0);
  EXPECT_EQ(percentile(samples, 0.99), 198);
  EXPECT_EQ(percentile(samples, 0.5), 100);
  EXPECT_EQ(percentile(samples, 1), 200);
  EXPECT_EQ(percentile(std::vector{3.0, 7.0}, 0.99), 7);
}

TEST(GeometricMean, OfAHalfAndItsDoubleIsOne) {
  EXPECT_DOUBLE_EQ(geometric_mean(std::vector{0.5, 2.0}), 1);
  EXPECT_DOUBLE_EQ(geometric_mean(std::vector{3.0}), 3);
}

TEST(Samples, MustNotBeNone) {
  const std::vector<double> none;
  EXPECT_THROW(median(none), std::invalid_argument);
  EXPECT_THROW(percentile(none, 0.99), std::invalid_argument);
  EXPECT_THROW(geometric_mean(none), std::invalid_argument);
}

}  // namespace
}  // namespace broadside::lab

// Estimates of what would take too long.
#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/measure/rounds.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

/// An algorithm whose time is known.
struct Clockwork {
  double seconds_per_box;
  double exponent;
  std::vector<std::size_t> tried{};

  std::optional<Estimate> estimate(double budget, std::size_t boxes) {
    return estimate_above(budget, boxes, [this](std::size_t count) {
      tried.push_back(count);
      return seconds_per_box * std::pow(static_cast<double>(count), exponent);
    });
  }
};

TEST(Estimate, TriesNothingOnFewBoxes) {
  Clockwork slow{1, 2};
  EXPECT_FALSE(slow.estimate(1, boxes_worth_estimating));
  EXPECT_TRUE(slow.tried.empty());
}

TEST(Estimate, LetsAFastAlgorithmRunAfterOneTry) {
  Clockwork fast{1e-9, 1};
  EXPECT_FALSE(fast.estimate(1, 100'000));
  EXPECT_EQ(fast.tried, (std::vector<std::size_t>{5'000}));
}

TEST(Estimate, ScalesQuadraticTimeByTheSquare) {
  Clockwork quadratic{4.1e-9, 2};
  const auto estimate = quadratic.estimate(10, 100'000);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->seconds, 41, 1e-9);
  EXPECT_EQ(estimate->from, 20'000u);
  EXPECT_EQ(estimate->exponent, 2);
  EXPECT_THAT(text(*estimate), names("41.0 s", "20,000 boxes", "n^2.00"));
}

TEST(Estimate, LooksTwiceWhereQuadraticGrowthWouldPassTheBudget) {
  Clockwork linear{1e-3, 1};  // 100 s on all; squared from a twentieth, 2,000 s
  EXPECT_FALSE(linear.estimate(110, 100'000));
  EXPECT_EQ(linear.tried, (std::vector<std::size_t>{5'000, 20'000}));
  const auto estimate = linear.estimate(90, 100'000);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->seconds, 100, 1e-6);
  EXPECT_NEAR(estimate->exponent, 1, 1e-9);
}

TEST(Estimate, TakesNearlyQuadraticForQuadraticAndNothingForMore) {
  EXPECT_EQ(Clockwork({1e-9, 1.85}).estimate(0.1, 100'000)->exponent, 2);
  EXPECT_EQ(Clockwork({1e-12, 3}).estimate(40, 100'000)->exponent, 2);
}

TEST(Estimate, StopsAtATwentiethWhereAFifthIsTooMuch) {
  Clockwork slow{1e-6, 2};  // 25 s on a twentieth
  const auto estimate = slow.estimate(10, 100'000);
  ASSERT_TRUE(estimate);
  EXPECT_EQ(slow.tried, (std::vector<std::size_t>{5'000}));
  EXPECT_EQ(estimate->from, 5'000u);
  EXPECT_NEAR(estimate->seconds, 10'000, 1e-6);
}

}  // namespace
}  // namespace broadside::lab

#include "core/number_text.hpp"

#include <cmath>
#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace broadside::core {
namespace {

constexpr double too_large = std::numeric_limits<double>::infinity();

TEST(NumberInText, IsInfiniteWhereItIsTooLargeWithItsSign) {
  for (const char* const text : {"1e999", "1E999", "1e+999", "17.5e400"})
    EXPECT_EQ(number_in(text), too_large) << text;
  for (const char* const text : {"-1e999", "-1E+999"}) EXPECT_EQ(number_in(text), -too_large) << text;
  EXPECT_EQ(number_in(std::string(400, '9')), too_large);
}

TEST(NumberInText, IsZeroWhereItIsTooSmallWithItsSign) {
  for (const char* const text : {"1e-999", "1E-999", "0.5e-400"}) EXPECT_EQ(number_in(text), 0) << text;
  EXPECT_TRUE(std::signbit(number_in("-1E-999")));
  EXPECT_EQ(number_in("0." + std::string(400, '0') + "1"), 0);
}

TEST(NumberInText, IsNoNumberWhereMoreFollows) {
  for (const char* const text : {"", "1x", "1 ", "e5"}) EXPECT_TRUE(std::isnan(number_in(text))) << text;
}

}  // namespace
}  // namespace broadside::core

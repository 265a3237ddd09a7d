// Numbers as people read them.
#include "lab/numbers.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace broadside::lab {
namespace {

TEST(Grouped, PutsACommaBetweenThousands) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1'000), "1,000");
  EXPECT_EQ(grouped(1'234'567), "1,234,567");
}

TEST(Whole, IsTheNearestWholeNumber) {
  EXPECT_EQ(whole(1234.5), "1,235");
  EXPECT_EQ(whole(-3), "0");
}

TEST(Whole, TakesWhatNoIntegerHolds) {
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(whole(1e300), "1.00e+300");
  EXPECT_EQ(whole(infinity), "inf");
  EXPECT_EQ(whole(-infinity), "0");
  EXPECT_EQ(rounded(1e300), "1.00e+300");
  EXPECT_EQ(rounded(-std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(bytes(1e300), "1.00e+291 GB");
}

TEST(Rounded, KeepsThreeDigits) {
  EXPECT_EQ(rounded(0), "0");
  EXPECT_EQ(rounded(7.1234e-9), "7.12e-09");
  EXPECT_EQ(rounded(0.071234), "0.0712");
  EXPECT_EQ(rounded(4.2149), "4.21");
  EXPECT_EQ(rounded(41.24), "41.2");
  EXPECT_EQ(rounded(412.4), "412");
  EXPECT_EQ(rounded(41234.5), "41,235");
}

TEST(Rounded, LosesADigitWhereRoundingAddsOne) {
  EXPECT_EQ(rounded(0.99996), "1.00");
  EXPECT_EQ(rounded(9.9996), "10.0");
  EXPECT_EQ(rounded(99.96), "100");
}

TEST(Duration, HasTheUnitThatSuitsIt) {
  EXPECT_EQ(duration(71.2e-6), "71.2 us");
  EXPECT_EQ(duration(4.21e-3), "4.21 ms");
  EXPECT_EQ(duration(0.9999), "1.00 s");
  EXPECT_EQ(duration(4100), "4,100 s");
}

TEST(Bytes, HaveTheUnitThatSuitsThem) {
  EXPECT_EQ(bytes(512), "512 B");
  EXPECT_EQ(bytes(71'234), "71.2 kB");
  EXPECT_EQ(bytes(999'600), "1.00 MB");
  EXPECT_EQ(bytes(1'300'000'000), "1.30 GB");
}

TEST(Counted, SaysOneAndManyAsPeopleDo) {
  EXPECT_EQ(counted(0, "box", "boxes"), "0 boxes");
  EXPECT_EQ(counted(1, "box", "boxes"), "1 box");
  EXPECT_EQ(counted(1234, "box", "boxes"), "1,234 boxes");
}

}  // namespace
}  // namespace broadside::lab

// The signals of boxes made up by hand, to the last digit.
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/advise/signals.hpp"
#include "tests/support/boxes.hpp"

namespace broadside::lab {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(Signals, CountsBoxesByWhatTheyAre) {
  const Signals signals = signals_of(History<2>{{{{0, 0}, {1, 2}},
                                                 absent_box<2>(),
                                                 {{5, 5}, {5, 5}},
                                                 {{7, 7}, {9, 7}},
                                                 {{0, -infinity}, {1, infinity}}},
                                                {}});
  EXPECT_EQ(signals.dimension, 2);
  EXPECT_EQ(signals.precision, Precision::float32);
  EXPECT_EQ(signals.boxes, 4u);
  EXPECT_EQ(signals.absent, 1u);
  EXPECT_EQ(signals.infinite, 1u);
  EXPECT_EQ(signals.points, 1u);
  EXPECT_EQ(signals.flat, 1u);
  EXPECT_EQ(signals.motion, std::nullopt);
}

TEST(Signals, TellsLongestSidesByTheirShares) {
  History<3> history;
  for (int i = 1; i <= 200; ++i) history.boxes.push_back({{0, 0, 0}, {1, static_cast<float>(i), 0}});
  const Signals signals = signals_of(history);
  EXPECT_THAT(signals.sizes, ElementsAre(2, 50, 100, 150, 198));
  EXPECT_EQ(signals.largest, 200);
}

TEST(Signals, CountsTheTestsOfASweepAlongEachAxis) {
  // Along x only the first two overlap, along y all three pairs do, and touching counts.
  const Signals signals = signals_of(History<2>{{{{0, 0}, {2, 2}}, {{2, 1}, {3, 3}}, {{5, 2}, {6, 6}}}, {}});
  EXPECT_THAT(signals.axis_tests, ElementsAre(DoubleEq(1.0 / 3), DoubleEq(1.0)));
  EXPECT_EQ(signals.best_axis(), 0u);
}

TEST(Signals, KnowsEvenlySpreadBoxesFromClusters) {
  History<2> even;
  History<2> clusters;
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const auto x = static_cast<float>(i);
      const auto y = static_cast<float>(j);
      even.boxes.push_back({{x, y}, {x + 1, y + 1}});
      // Sixteen heaps along a diagonal, each in a part of its own.
      const float heap = static_cast<float>(i % 16) * 100;
      clusters.boxes.push_back({{heap, heap}, {heap + 1, heap + 1}});
    }
  }
  // A box is not near itself, which with sixteen boxes a part is felt.
  EXPECT_NEAR(signals_of(even).clustering, 15.0 / 16, 0.01);
  // On each axis a sixteenth of the pairs is near, and so it is on both.
  EXPECT_NEAR(signals_of(clusters).clustering, 16, 0.1);
}

TEST(Signals, TellsWhetherFloatsHoldAllCoordinates) {
  EXPECT_TRUE(signals_of(History<2, double>{{{{0, 0}, {0.5, 1}}}, {}}).floats_hold_all);
  const Signals signals = signals_of(History<2, double>{{{{0, 0}, {0.1, 1}}}, {}});
  EXPECT_FALSE(signals.floats_hold_all);
  EXPECT_EQ(signals.precision, Precision::float64);
}

TEST(Signals, TellsHowBoxesMove) {
  const Box<2> unit = {{0, 0}, {1, 1}};
  const Box<2> other = {{10, 0}, {12, 1}};
  History<2> history{{unit, other, unit, unit}, {}};
  // One drifts by half its side, one is listed but stays, one comes.
  history.steps.push_back({5, {BoxId(0), BoxId(2), BoxId(4)}, {{{0.5, 0}, {1.5, 1}}, unit, unit}});
  // Two move, one of them by ten of its sides; one goes, and the array loses the last.
  history.steps.push_back(
      {4, {BoxId(0), BoxId(1), BoxId(3)}, {{{1.5, 0}, {2.5, 1}}, {{30, 0}, {32, 1}}, absent_box<2>()}});
  const Signals signals = signals_of(history);
  ASSERT_TRUE(signals.motion);
  EXPECT_EQ(signals.motion->frames, 2u);
  EXPECT_DOUBLE_EQ(signals.motion->min_moving, 1.0 / 4);
  EXPECT_DOUBLE_EQ(signals.motion->max_moving, 2.0 / 5);
  EXPECT_DOUBLE_EQ(signals.motion->moving, (1.0 / 4 + 2.0 / 5) / 2);
  EXPECT_DOUBLE_EQ(*signals.motion->drift, 1);
  EXPECT_DOUBLE_EQ(signals.motion->jumps, 1.0 / 3);
  EXPECT_DOUBLE_EQ(signals.motion->added, 0.5);
  EXPECT_DOUBLE_EQ(signals.motion->removed, 1);
  // The fullest frame is the second.
  EXPECT_EQ(signals.boxes, 5u);
}

TEST(Signals, AreThereForNoBoxesAndForOne) {
  const Signals none = signals_of(History<2>{});
  EXPECT_EQ(none.boxes, 0u);
  EXPECT_EQ(none.clustering, 1);
  EXPECT_THAT(none.axis_tests, ElementsAre(0, 0));
  EXPECT_THAT(text_of(none), HasSubstr("0 boxes in 2D, as floats."));
  EXPECT_EQ(signals_of(History<3, double>{{{{0, 0, 0}, {1, 1, 3}}}, {}}).largest, 3);
}

}  // namespace
}  // namespace broadside::lab

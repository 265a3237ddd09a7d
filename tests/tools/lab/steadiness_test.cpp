// Which measurements are unsteady, by their samples alone, and what tables say of them.
#include "lab/measure/steadiness.hpp"

#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/report/table.hpp"

namespace broadside::lab {
namespace {

using testing::HasSubstr;
using testing::Not;

Case searched(std::size_t seeds) {
  Case of;
  of.scene = "uniform";
  of.boxes = 1'000;
  of.seeds.resize(seeds);
  return of;
}

Case tracked(std::size_t seeds, std::size_t frames) {
  Case of = searched(seeds);
  of.mode = Mode::track;
  of.frames = frames;
  return of;
}

Measurement with_samples(std::vector<double> samples) {
  Measurement measurement;
  measurement.algorithm = "grid";
  measurement.outcome = samples.empty() ? Outcome::skipped : Outcome::verified;
  measurement.samples_ms = std::move(samples);
  return measurement;
}

TEST(Spread, IsTheMedianOverTheLeastOfTheSameBoxes) {
  EXPECT_EQ(spread(std::vector{2.0, 3.0, 6.0, 3.0}, 1), 1.5);
  // Three boxes in turn: 1 and 1, 10 and 10, 100 and 300. The stall in the last is one of three.
  EXPECT_EQ(spread(std::vector{1.0, 10.0, 100.0, 1.0, 10.0, 300.0}, 3), 1);
  EXPECT_EQ(spread(std::vector{1.0, 10.0, 100.0, 1.0, 30.0, 300.0}, 3), 2);
  EXPECT_EQ(spread(std::vector{0.0, 0.0, 0.0, 0.0}, 1), 1);
}

TEST(Spread, IsNoneWithoutThreeRepetitions) {
  EXPECT_EQ(spread(std::vector<double>{}, 1), std::nullopt);
  EXPECT_EQ(spread(std::vector{1.0, 9.0, 9.0}, 1), std::nullopt);
  EXPECT_EQ(spread(std::vector{1.0, 1.0, 9.0, 9.0}, 2), std::nullopt);
}

TEST(Unsteady, IsASearchWhoseTimesOfTheSameBoxesAreFarApart) {
  EXPECT_FALSE(is_unsteady(searched(1), with_samples({1, 1.5, 1.5, 9})));
  EXPECT_TRUE(is_unsteady(searched(1), with_samples({1, 1.6, 1.6, 1.7})));
  // One seed's boxes take three times as long as the other's, each time.
  EXPECT_FALSE(is_unsteady(searched(2), with_samples({1, 3, 1, 3, 1, 3})));
}

TEST(Unsteady, IsNoSearchBecauseItsBoxesDiffer) {
  EXPECT_FALSE(is_unsteady(searched(100), with_samples({1, 2.1, 2.2, 9, 3, 4})));
}

TEST(Unsteady, IsNoHistoryBecauseItsFramesDiffer) {
  EXPECT_FALSE(is_unsteady(tracked(1, 3), with_samples({1, 5, 9})));
  EXPECT_FALSE(is_unsteady(tracked(1, 3), with_samples({1, 5, 9, 1, 5, 9})));
  EXPECT_FALSE(is_unsteady(tracked(2, 3), with_samples({1, 5, 9, 2, 10, 18})));
  EXPECT_TRUE(is_unsteady(tracked(1, 3), with_samples({1, 5, 9, 3, 15, 27})));
}

TEST(Unsteady, AreCountedAmongWhatHasTimes) {
  const CaseResult result = {
      searched(1),
      {with_samples({1, 1, 1, 1}), with_samples({1, 4, 4, 4}), with_samples({}), with_samples({7})}};
  EXPECT_EQ(steadiness_of(result), (Steadiness{3, 1}));
}

TEST(Unsteady, AreNamedAtTheEndOfTheTablesWhereThereAreAny) {
  Comparison comparison;
  comparison.cases = {{searched(1), {with_samples({1, 1, 1, 1}), with_samples({1, 1, 1, 4})}}};
  EXPECT_THAT(summary_of(comparison), Not(HasSubstr("unsteady")));
  comparison.cases.push_back({searched(1), {with_samples({1, 4, 4, 4})}});
  EXPECT_THAT(summary_of(comparison), testing::EndsWith("least times (min_ms in --json)\n"));
  EXPECT_THAT(summary_of(comparison), HasSubstr("\nunsteady: 1 of 3 measurements, "));
}

}  // namespace
}  // namespace broadside::lab

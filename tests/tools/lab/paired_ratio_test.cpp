// Ratios of paired times and their intervals, on numbers made for it.
#include "lab/measure/paired_ratio.hpp"

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/measure/ranking.hpp"

namespace broadside::lab {
namespace {

Measurement with(std::string algorithm, std::vector<double> samples, std::size_t samples_per_round = 1) {
  Measurement measurement;
  measurement.algorithm = std::move(algorithm);
  measurement.outcome = Outcome::verified;
  measurement.samples_ms = std::move(samples);
  measurement.samples_per_round = samples_per_round;
  return measurement;
}

TEST(RoundTimes, AreTheCallsOrTheMeansOfAHistorysFrames) {
  EXPECT_THAT(round_times(with("grid", {3, 1, 2})), testing::ElementsAre(3, 1, 2));
  EXPECT_THAT(round_times(with("grid", {1, 3, 5, 9}, 2)), testing::ElementsAre(2, 7));
}

TEST(RatiosBySeed, PairWhatWasMeasuredInTheSameRound) {
  // A machine that slows down by ten in the middle changes no ratio.
  const RatiosBySeed ratios(std::vector<double>{2, 4, 20, 40}, std::vector<double>{1, 2, 10, 20}, 1);
  EXPECT_DOUBLE_EQ(ratios.median(), 2);
  EXPECT_EQ(ratios.rounds(), 4u);
}

TEST(RatiosBySeed, CompareAnEntryThatLeftEarlyOnTheFirstRoundsAlone) {
  const RatiosBySeed ratios(std::vector<double>{6, 6}, std::vector<double>{1, 1, 3, 3, 3, 3, 3}, 1);
  EXPECT_DOUBLE_EQ(ratios.median(), 6);
  EXPECT_EQ(ratios.rounds(), 2u);
  EXPECT_FALSE(ratios.interval());
}

TEST(RatiosBySeed, TakeTheMedianOverSeedsOfEachSeedsMedian) {
  // Seed 0: ratios 1, 1, 9; seed 1: 4, 4; seed 2: 5, 5. Over all rounds the median is 4 as well; without the
  // seeds' medians the mean of rounds would not be.
  const RatiosBySeed ratios(std::vector<double>{1, 4, 5, 1, 4, 5, 9}, std::vector<double>(7, 1.0), 3);
  EXPECT_DOUBLE_EQ(ratios.median(), 4);
  const RatiosBySeed uneven(std::vector<double>{1, 5, 1, 5, 1}, std::vector<double>(5, 1.0), 2);
  EXPECT_DOUBLE_EQ(uneven.median(), std::sqrt(5));
}

TEST(RatiosBySeed, AreReciprocalsTheOtherWayRound) {
  const std::vector<double> times{1, 4, 5, 2};
  const std::vector<double> others{3, 1, 2, 9};
  for (const std::size_t seeds : {1u, 2u, 3u})
    EXPECT_DOUBLE_EQ(
        RatiosBySeed(times, others, seeds).median() * RatiosBySeed(others, times, seeds).median(), 1);
}

TEST(RatiosBySeed, RefuseWhatWasNeverInARoundTogether) {
  EXPECT_THROW(RatiosBySeed(std::vector<double>{}, std::vector<double>{1}, 1), std::invalid_argument);
  EXPECT_THROW(RatiosBySeed(std::vector<double>{1}, std::vector<double>{1}, 0), std::invalid_argument);
}

TEST(RatiosBySeed, GiveTheSameIntervalEveryTime) {
  const RatiosBySeed ratios(std::vector<double>{1, 2, 3, 4, 5, 6}, std::vector<double>(6, 1.0), 6);
  const Interval once = ratios.interval().value();
  const Interval again = ratios.interval().value();
  EXPECT_EQ(once.low, again.low);
  EXPECT_EQ(once.high, again.high);
  EXPECT_LE(once.low, ratios.median());
  EXPECT_GE(once.high, ratios.median());
}

TEST(RatiosBySeed, HaveIntervalsThatHoldTheTruthAboutAsOftenAsTheySay) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.1);
  std::size_t held = 0;
  constexpr std::size_t trials = 200;
  for (std::size_t trial = 0; trial < trials; ++trial) {
    std::vector<double> times;
    for (int round = 0; round < 30; ++round) times.push_back(2 * std::exp(noise(random)));
    const Interval interval = RatiosBySeed(times, std::vector<double>(30, 1.0), 30).interval().value();
    if (interval.includes(2)) ++held;
  }
  EXPECT_GE(held, trials * 90 / 100);
  EXPECT_LT(held, trials);
}

TEST(RatiosBySeed, KnowLessOfOneSeedRepeatedThanOfManySeeds) {
  // Two seeds whose ratios are 1 and 3: however often each is measured, two seeds is all there is.
  std::vector<double> times;
  for (int round = 0; round < 40; ++round) times.push_back(round % 2 == 0 ? 1 : 3);
  const Interval interval = RatiosBySeed(times, std::vector<double>(40, 1.0), 2).interval().value();
  EXPECT_DOUBLE_EQ(interval.low, 1);
  EXPECT_DOUBLE_EQ(interval.high, 3);
}

TEST(GeometricMean, AveragesNoiseOutOverCases) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.1);
  std::vector<RatiosBySeed> pairs;
  for (int i = 0; i < 20; ++i) {
    std::vector<double> times;
    for (int round = 0; round < 10; ++round) times.push_back(2 * std::exp(noise(random)));
    pairs.emplace_back(times, std::vector<double>(10, 1.0), 10);
  }
  const MeanRatio mean = geometric_mean(pairs);
  const Interval one = pairs[0].interval().value();
  EXPECT_NEAR(mean.mean, 2, 0.1);
  EXPECT_LT(mean.interval.high - mean.interval.low, (one.high - one.low) / 2);
  EXPECT_TRUE(mean.interval.includes(2));
}

TEST(PairedRatio, ComesWithTheTimesOfTheRoundsThatItIsOf) {
  // The entry is faster once the other one, which left early, is gone.
  Case of;
  of.seeds = {1};
  const PairedRatio ratio = paired_ratio(of, with("a", {2, 2, 1, 1, 1}), with("b", {6, 6}));
  EXPECT_DOUBLE_EQ(ratio.ms, 2);
  EXPECT_DOUBLE_EQ(ratio.of_ms, 6);
  EXPECT_DOUBLE_EQ(ratio.median, ratio.ms / ratio.of_ms);
}

TEST(AddRatios, ComparesWithTheFastestOurBestAndTheFastestPeer) {
  CaseResult result{{},
                    {with("auto", {2}), with("auto:cell=1", {1.5}), with("grid", {3}), with("peer", {6})}};
  result.measurements[3].kind = AlgorithmKind::peer;
  result.measurements.push_back(with("failed", {}));
  add_ratios(result);
  EXPECT_EQ(best_own_of(result)->algorithm, "grid");
  EXPECT_EQ(auto_of(result)->algorithm, "auto:cell=1");
  EXPECT_EQ(result.measurements[2].to_fastest->of, "auto:cell=1");
  EXPECT_EQ(result.measurements[2].to_fastest->median, 2);
  EXPECT_EQ(result.measurements[3].to_best_own->of, "grid");
  EXPECT_EQ(result.measurements[3].to_best_own->median, 2);
  EXPECT_EQ(result.measurements[0].to_fastest_peer->median, 2.0 / 6);
  EXPECT_FALSE(result.measurements[4].to_fastest);
}

}  // namespace
}  // namespace broadside::lab

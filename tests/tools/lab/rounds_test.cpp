// In how many rounds an algorithm takes part, by what was measured of it.
#include "lab/measure/rounds.hpp"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace broadside::lab {
namespace {

Measurement timed(AlgorithmKind kind, std::vector<double> samples_ms, std::size_t samples_per_round = 1) {
  Measurement measurement;
  measurement.kind = kind;
  measurement.outcome = Outcome::verified;
  measurement.samples_ms = std::move(samples_ms);
  measurement.samples_per_round = samples_per_round;
  return measurement;
}

const Effort effort{
    .share_seconds = 0.01, .min_rounds = 3, .max_rounds = 5, .slow_rounds = 2, .far_rounds = 1};

TEST(Rounds, GoOnUntilAShareOfTimeIsSpent) {
  EXPECT_TRUE(has_another_round(timed(AlgorithmKind::own, {9, 9}), effort, no_limit));      // the least
  EXPECT_FALSE(has_another_round(timed(AlgorithmKind::own, {9, 9, 9}), effort, no_limit));  // the share
  EXPECT_TRUE(has_another_round(timed(AlgorithmKind::own, {1, 1, 1, 1}), effort, no_limit));
  EXPECT_FALSE(has_another_round(timed(AlgorithmKind::own, {1, 1, 1, 1, 1}), effort, no_limit));  // the most
  EXPECT_FALSE(has_another_round(timed(AlgorithmKind::own, {1, 1}), effort, 2));
  EXPECT_TRUE(has_another_round(timed(AlgorithmKind::own, {99}), effort, 2));
  // Two frames a round.
  EXPECT_TRUE(has_another_round(timed(AlgorithmKind::own, {9, 9, 9, 9}, 2), effort, no_limit));
}

TEST(Rounds, TakeTurnsOnInputsThatTogetherAreTooManyToBeLearned) {
  EXPECT_EQ(inputs_in_rotation(0), 32u);
  EXPECT_EQ(inputs_in_rotation(100), 32u);
  EXPECT_EQ(inputs_in_rotation(10'000), 10u);
  EXPECT_EQ(inputs_in_rotation(499'999), 4u);
  EXPECT_EQ(inputs_in_rotation(500'000), 1u);
}

TEST(Rounds, EndWithAFailure) {
  Measurement failed = timed(AlgorithmKind::own, {});
  failed.outcome = Outcome::failed;
  EXPECT_FALSE(has_another_round(failed, effort, no_limit));
}

TEST(Rounds, AreFewForWhatIsFarBehindTheFastestPeerAndOurFastest) {
  const std::vector<Measurement> all = {timed(AlgorithmKind::own, {3}), timed(AlgorithmKind::own, {50}),
                                        timed(AlgorithmKind::peer, {20}), timed(AlgorithmKind::peer, {29}),
                                        timed(AlgorithmKind::peer, {31})};
  std::vector<std::size_t> limits;
  for (const Measurement& measurement : all) limits.push_back(round_limit(measurement, all, effort, 60));
  EXPECT_EQ(limits, (std::vector<std::size_t>{no_limit, 1, no_limit, no_limit, 1}));
}

TEST(Rounds, AreNotFewForOursWhereAPeerIsFaster) {
  const std::vector<Measurement> all = {timed(AlgorithmKind::own, {40}), timed(AlgorithmKind::peer, {10})};
  EXPECT_EQ(round_limit(all[0], all, effort, 60), no_limit);
}

TEST(Rounds, OfAHistoryDoNotCountItsFirstFrame) {
  // What builds slowly and then follows fast is not far behind: its samples are the later frames.
  std::vector<Measurement> all = {timed(AlgorithmKind::peer, {3, 3}, 2),
                                  timed(AlgorithmKind::peer, {4, 4}, 2)};
  all[1].build_ms = 900;
  EXPECT_EQ(round_limit(all[1], all, effort, 60), no_limit);
}

TEST(Rounds, AreFewForASlowSearchWherePeersAreNone) {
  const std::vector<Measurement> all = {timed(AlgorithmKind::own, {1}), timed(AlgorithmKind::own, {200})};
  EXPECT_EQ(round_limit(all[0], all, effort, 0.1), no_limit);
  EXPECT_EQ(round_limit(all[1], all, effort, 0.1), 2u);
}

}  // namespace
}  // namespace broadside::lab

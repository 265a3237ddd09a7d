// Which algorithm is chosen, from measurements made up by hand.
#include <deque>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/advise/advise.hpp"
#include "lab/advise/algorithm_choice.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// Rivals, each with the same time in ten rounds.
class Field {
 public:
  Field& add(const std::string& spec, double milliseconds, bool is_variant = false) {
    Measurement measurement;
    measurement.algorithm = spec;
    measurement.outcome = Outcome::verified;
    measurement.samples_ms.assign(10, milliseconds);
    measurements_.push_back(measurement);
    candidates_.push_back({&measurements_.back(), milliseconds, is_variant});
    return *this;
  }
  Field& variant(const std::string& spec, double milliseconds) { return add(spec, milliseconds, true); }
  Measurement& last() { return measurements_.back(); }

  std::optional<AlgorithmChoice> choice(bool by_time = true) const { return choose(candidates_, by_time); }
  std::string chosen() const {
    const auto choice = choose(candidates_);
    return choice ? candidates_[choice->chosen].measurement->algorithm : "";
  }

 private:
  std::deque<Measurement> measurements_;
  std::vector<Candidate> candidates_;
};

TEST(AlgorithmChoice, TakesTheFastest) {
  Field field;
  field.add("bvh", 3).add("grid", 2).add("quadtree", 4);
  EXPECT_EQ(field.chosen(), "grid");
  EXPECT_EQ(field.choice()->why, ChoiceReason::fastest);
}

TEST(AlgorithmChoice, TakesTheFirstOfTwoThatAreEquallyFast) {
  EXPECT_EQ(Field().add("bvh", 2).add("grid", 2).chosen(), "bvh");
}

TEST(AlgorithmChoice, PrefersAutoWhereItIsHardlySlower) {
  Field near;
  near.add("grid", 1).add("auto", 1.03);
  EXPECT_EQ(near.chosen(), "auto");
  EXPECT_EQ(near.choice()->why, ChoiceReason::automatic);
  EXPECT_EQ(near.choice()->fastest_plain, 0u);
  EXPECT_EQ(Field().add("grid", 1).add("auto", 1.05).chosen(), "grid");
  // Under the clock's own noise all are the same.
  EXPECT_EQ(Field().add("brute_force", 0.0001).add("auto", 0.00025).chosen(), "auto");
}

TEST(AlgorithmChoice, TakesAutoWhereTimesSayNothing) {
  Field field;
  field.add("grid", 1).add("auto", 3).variant("grid:cell=2", 0.1);
  EXPECT_EQ(field.choice(false)->chosen, 1u);
  EXPECT_EQ(field.choice(false)->why, ChoiceReason::automatic);
  EXPECT_EQ(Field().add("bvh", 2).choice(false)->chosen, 0u);
}

TEST(AlgorithmChoice, TakesAVariantOnlyIfItIsClearlyFasterThanAllPlainOnes) {
  EXPECT_EQ(Field().add("grid", 1).variant("grid:cell=2", 0.96).chosen(), "grid");
  Field clear;
  clear.add("bvh", 1).add("grid", 1.2).variant("grid:cell=2", 0.9).variant("grid:cell=4", 0.92);
  EXPECT_EQ(clear.chosen(), "grid:cell=2");
  EXPECT_EQ(clear.choice()->why, ChoiceReason::variant);
  EXPECT_EQ(Field().add("bvh", 1).add("grid", 1.2).variant("grid:cell=2", 1.1).chosen(), "bvh");
}

TEST(AlgorithmChoice, DoesNotTakeAVariantThatIsFasterInFewRounds) {
  Field field;
  field.add("grid", 1).variant("grid:cell=2", 0.8);
  field.last().samples_ms = {2, 2, 2, 2, 0.8, 0.8, 0.8, 0.8, 0.8, 0.8};
  EXPECT_EQ(field.chosen(), "grid");
  field.last().samples_ms[0] = 0.8;
  EXPECT_EQ(field.chosen(), "grid:cell=2");
}

TEST(AlgorithmChoice, LeavesOutWhatFailedAndWhatWasSkipped) {
  Field field;
  field.add("grid", 1);
  field.last().outcome = Outcome::failed;
  EXPECT_EQ(field.choice(), std::nullopt);
  field.add("bvh", 2);
  field.last().outcome = Outcome::skipped;
  EXPECT_EQ(field.choice(), std::nullopt);
  field.add("quadtree", 3);
  EXPECT_EQ(field.chosen(), "quadtree");
}

TEST(AlgorithmChoice, NamesAPeerThatIsFasterAndAdvisesOneOfOurs) {
  Field field;
  field.add("grid", 2).add("boost_rtree", 1);
  field.last().kind = AlgorithmKind::peer;
  EXPECT_EQ(field.chosen(), "grid");
  EXPECT_EQ(field.choice()->peer, 1u);
  Field slow;
  slow.add("grid", 2).add("boost_rtree", 3);
  slow.last().kind = AlgorithmKind::peer;
  EXPECT_EQ(slow.choice()->peer, std::nullopt);
  Field alone;
  alone.add("boost_rtree", 3);
  alone.last().kind = AlgorithmKind::peer;
  EXPECT_EQ(alone.choice(), std::nullopt);
}

TEST(AlgorithmChoice, AutoWithThreadsIsAuto) {
  EXPECT_EQ(Field().add("grid:threads=2", 1).add("auto:threads=2", 1.01).chosen(), "auto:threads=2");
}

TEST(PartOfRounds, CountsTheRoundsThatBothTookPartIn) {
  Measurement a;
  Measurement b;
  EXPECT_EQ(part_of_rounds(a, b), 0);
  a.samples_ms = {1, 2, 3, 4, 5};
  b.samples_ms = {2, 2, 4, 4};
  EXPECT_EQ(part_of_rounds(a, b), 0.5);
}

TEST(PartOfRounds, TakesAHistoryAsOneRound) {
  // Slower in two of three frames, faster in each pass: half the boxes stay, then all jump.
  Measurement rebuild;
  Measurement follow;
  rebuild.samples_ms = {2, 2, 3, 2, 2, 3};
  follow.samples_ms = {1, 1, 9, 1, 1, 9};
  rebuild.samples_per_round = follow.samples_per_round = 3;
  EXPECT_EQ(part_of_rounds(rebuild, follow), 1);
}

/// Advice by hand: two algorithms on still boxes.
Advice made_up() {
  Advice advice;
  advice.signals.boxes = 1000;
  advice.signals.axis_tests = {88, 120};
  advice.milliseconds = 1;
  for (const auto& [spec, time, tests] : std::vector<std::tuple<std::string, double, std::uint64_t>>{
           {"grid", 1, 4000}, {"sweep_and_prune", 3.1, 88'000}}) {
    RankedAlgorithm ranked;
    ranked.measurement.algorithm = spec;
    ranked.measurement.outcome = Outcome::verified;
    ranked.measurement.samples_ms.assign(5, time);
    ranked.measurement.statistics = Statistics{.tests = tests};
    ranked.measurement.peak_bytes = spec == "grid" ? 4'000'000 : 1'000'000;
    ranked.milliseconds = time;
    ranked.is_finalist = true;
    advice.ranking.push_back(ranked);
  }
  advice.choice = AlgorithmChoice{0, ChoiceReason::fastest, 0};
  return advice;
}

TEST(Reasons, SayHonestlyThatAPeerIsFaster) {
  Advice advice = made_up();
  advice.ranking.push_back(advice.ranking[0]);
  advice.ranking[2].measurement.algorithm = "boost_rtree";
  advice.ranking[2].measurement.kind = AlgorithmKind::peer;
  advice.ranking[2].milliseconds = 0.5;
  advice.choice->peer = 2;
  EXPECT_THAT(
      reasons_of(advice),
      Contains("boost_rtree, which is not part of Broadside's library, is faster here: grid takes 2.0 "
               "times as long as it"));
}

TEST(Changes, NameWhatHoldsLessMemory) {
  Advice advice = made_up();
  EXPECT_THAT(changes_of(advice), Contains(HasSubstr("sweep_and_prune holds at most 1.00 MB where grid holds "
                                                     "4.00 MB, at 3.1 times the time")));
  advice.ranking[1].measurement.peak_bytes = 3'900'000;
  EXPECT_THAT(changes_of(advice), IsEmpty());
}

TEST(Changes, TellFromWhichFractionOnFollowingDoesNotPay) {
  Advice advice = made_up();
  advice.ranking[1].measurement.peak_bytes.reset();
  advice.mode = Mode::track;
  advice.signals.motion = MotionSignals{.frames = 10, .moving = 0.1};
  advice.ranking[0].measurement.algorithm = "auto:update=follow";
  advice.ranking[1].measurement.algorithm = "auto:update=rebuild";
  EXPECT_THAT(changes_of(advice), Contains(HasSubstr("from about 31 % moving on")));
}

}  // namespace
}  // namespace broadside::lab

// Advice on boxes: what is measured of them, and what is tried.
#include "lab/advise/advise.hpp"

#include <map>
#include <span>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "broadside/executor.hpp"
#include "broadside/finder.hpp"

#include "lab/advise/algorithm_choice.hpp"
#include "lab/measure/cases.hpp"
#include "lab/measure/samples.hpp"
#include "lab/scenes/motion.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Key;
using testing::Not;
using testing::StartsWith;

AdviseOptions quickly(const std::string& algorithms) {
  AdviseOptions options;
  options.algorithms = algorithms;
  options.budget_seconds = 0.05;
  return options;
}

/// A row of boxes, each of which overlaps the next, and farther apart than floats can tell.
History<2, double> row(int count) {
  History<2, double> history;
  for (int i = 0; i < count; ++i) history.boxes.push_back({{i + 0.1, 0}, {i + 1.1, 1}});
  return history;
}

/// Finds nothing.
class Blind final : public Searcher<2> {
 public:
  std::optional<Statistics> search(const SearchInput<2>&, PairSink&) override { return std::nullopt; }
};

std::vector<std::string> texts(const std::vector<Entry>& entries) {
  std::vector<std::string> specs;
  for (const Entry& entry : entries) specs.push_back(entry.spec.text());
  return specs;
}

TEST(Variants, AreOfTunablesThatTheUserLeftOpen) {
  const Catalogue catalogue;
  Signals signals = signals_of(History<2>{{{{0, 0}, {2, 2}}, {{2, 1}, {3, 3}}}, {}});
  EXPECT_THAT(texts(variants_of(catalogue.select("grid")[0], signals)),
              AllOf(Contains("grid:cell=2"), Contains("grid:cell=32"), Not(Contains(HasSubstr("update")))));
  EXPECT_THAT(variants_of(catalogue.select("grid:cell=3")[0], signals), IsEmpty());
  EXPECT_THAT(texts(variants_of(catalogue.select("sweep_and_prune")[0], signals)),
              AllOf(Contains("sweep_and_prune:axis=y"), Not(Contains("sweep_and_prune:axis=z"))));
  EXPECT_THAT(variants_of(catalogue.select("paper_grid")[0], signals), IsEmpty());
  signals.motion = MotionSignals{};
  EXPECT_THAT(texts(variants_of(catalogue.select("grid:threads=2")[0], signals)),
              Contains("grid:threads=2:update=follow"));
}

TEST(Advise, MeasuresBoxesOfDoublesInDouble) {
  const Advice advice = advise(Catalogue(), "row", row(50), quickly("own"));
  EXPECT_TRUE(advice.all_verified());
  EXPECT_EQ(advice.mode, Mode::find);
  EXPECT_EQ(advice.signals.precision, Precision::float64);
  EXPECT_DOUBLE_EQ(*advice.signals.overlaps, 2 * 49.0 / 50);
  EXPECT_THAT(advice.snippet, HasSubstr("DoubleBox2"));
  for (const RankedAlgorithm& ranked : advice.ranking)
    EXPECT_EQ(ranked.measurement.pairs, 49u) << ranked.measurement.algorithm;
}

TEST(Advise, MeasuresMotionAndTriesBothWaysOfAuto) {
  const Advice advice =
      advise(Catalogue(), "churn", random_history<3>({.boxes = 40, .frames = 20}), quickly("own"));
  EXPECT_TRUE(advice.all_verified());
  EXPECT_EQ(advice.mode, Mode::track);
  EXPECT_EQ(advice.frames, 20u);
  EXPECT_THAT(advice.snippet, HasSubstr("World3"));
  std::vector<std::string> specs;
  for (const RankedAlgorithm& ranked : advice.ranking) specs.push_back(ranked.measurement.algorithm);
  EXPECT_THAT(specs, AllOf(Contains("auto:update=rebuild"), Contains("auto:update=follow"), Contains("bvh")));
}

TEST(Advise, MeasuresAPartOfALongHistoryFromItsMiddle) {
  History<2> history = {{{{0, 0}, {1, 1}}, {{3, 0}, {4, 1}}}, {}};
  for (int i = 1; i <= 1000; ++i)
    history.steps.push_back({2, {BoxId(0)}, {{{static_cast<float>(i), 0}, {static_cast<float>(i) + 1, 1}}}});
  const Advice advice = advise(Catalogue(), "long", history, quickly("brute_force,auto"));
  EXPECT_TRUE(advice.all_verified());
  EXPECT_EQ(advice.frames, 240u);
  EXPECT_EQ(advice.first_frame, 380u);
  EXPECT_EQ(advice.signals.motion->frames, 1000u);
  EXPECT_THAT(text_of(advice), HasSubstr("Measured on the 240 frames from frame 381 on"));
}

TEST(Advise, MeasuresFramesInWhichAsMuchMovesAsInAll) {
  // 600 frames at rest, then 400 in motion: of 240 about 96 are to be in motion, and it is 87 as soon as may
  // be.
  History<2> history = {{{{0, 0}, {1, 1}}, {{3, 0}, {4, 1}}}, {}};
  for (int i = 1; i <= 1000; ++i) {
    const auto x = static_cast<float>(i);
    history.steps.push_back(i <= 600 ? Step<2>{2, {}, {}} : Step<2>{2, {BoxId(0)}, {{{x, 0}, {x + 1, 1}}}});
  }
  const Advice advice = advise(Catalogue(), "long", history, quickly("brute_force,auto"));
  EXPECT_TRUE(advice.all_verified());
  EXPECT_EQ(advice.frames, 240u);
  EXPECT_EQ(advice.first_frame, 447u);
}

TEST(Advise, OffersNothingWhereNothingIsVerified) {
  Catalogue catalogue;
  Algorithm blind{.name = "blind", .summary = {}, .source = {}};
  blind.in_2d.searcher = make_strategy<Blind>;
  catalogue.add(blind);
  const History<2> two = {{{{0, 0}, {1, 1}}, {{1, 1}, {2, 2}}}, {}};
  const Advice advice = advise(catalogue, "two", two, quickly("blind"));
  EXPECT_FALSE(advice.choice);
  EXPECT_FALSE(advice.all_verified());
  EXPECT_THAT(text_of(advice), AllOf(HasSubstr("nothing to advise"), HasSubstr("FAILED")));
  EXPECT_TRUE(nlohmann::json::parse(json_of(advice, {}))["advice"].is_null());
}

TEST(Advise, IsWithheldOnABusyMachineAndSaysSoFirst) {
  Advice advice = advise(Catalogue(), "row", row(50), quickly("grid,auto"));
  advice.processor_share = 0.5;
  EXPECT_THAT(text_of(advice), AllOf(StartsWith("busy: "), HasSubstr("\nAdvice: ")));
  advice.is_withheld = true;
  EXPECT_THAT(text_of(advice), AllOf(StartsWith("No advice: "), HasSubstr("\nbusy: "), HasSubstr("grid"),
                                     Not(HasSubstr("Advice: "))));
  EXPECT_TRUE(nlohmann::json::parse(json_of(advice, {}))["advice"].is_null());
}

TEST(Advise, MeasuresOneThreadWhateverThreadsAreAllowed) {
  if (standard_executor() == nullptr) GTEST_SKIP() << "built without threads";
  AdviseOptions options = quickly("grid,auto");
  options.threads = {0};
  const Advice advice = advise(Catalogue(), "row", row(50), options);
  EXPECT_TRUE(advice.all_verified());
  std::map<std::string, bool> is_variant;
  for (const RankedAlgorithm& ranked : advice.ranking)
    is_variant[ranked.measurement.algorithm] = ranked.is_variant;
  ASSERT_THAT(is_variant,
              AllOf(Contains(Key("grid")), Contains(Key("auto")), Contains(Key("auto:threads=0"))));
  EXPECT_FALSE(is_variant["auto"]);
  EXPECT_TRUE(is_variant["auto:threads=0"]);
}

TEST(Advise, StopsWhenTheWatchSaysSo) {
  AdviseOptions options = quickly("own");
  options.watch.stop = [] { return true; };
  EXPECT_THROW(advise(Catalogue(), "row", row(10), options), Stopped);
}

TEST(MeasureFind, RefusesPairsOfFloatsForBoxesOfDoubles) {
  // Two boxes that only doubles tell apart: what finds them in float is wrong.
  const std::vector<History<2, double>> inputs = {{{{{0, 0}, {1, 1}}, {{1 + 1e-12, 0}, {2, 1}}}, {}}};
  const Catalogue catalogue;
  const auto entries = catalogue.select("grid");
  const Case of{.scene = "two", .parameters = {}, .seeds = {1}, .dimension = 2, .boxes = 2};
  const CaseResult result = measure_find<2, double>(of, inputs, {entries, catalogue.algorithms(), {}, {}});
  EXPECT_EQ(result.measurements[0].outcome, Outcome::verified);
  EXPECT_EQ(result.measurements[0].pairs, 0u);
  EXPECT_THAT(result.floor_ms, IsEmpty());
}

TEST(Undisturbed, IsTheMedianOfTheInputsLeastSamples) {
  EXPECT_EQ(undisturbed(std::vector<double>{1, 20, 300, 10, 2, 3}, 3), 2);
  EXPECT_EQ(undisturbed(std::vector<double>{5, 7}, 3), 6);
  EXPECT_THROW(undisturbed(std::vector<double>{}, 3), std::invalid_argument);
}

TEST(Undisturbed, IsTheMeanOverFramesThatDiffer) {
  EXPECT_EQ(undisturbed_mean(std::vector<double>{1, 20, 300, 10, 2, 3}, 3), 2);
  EXPECT_EQ(undisturbed_mean(std::vector<double>{1, 1, 1, 97}, 4), 25);
  EXPECT_THROW(undisturbed_mean(std::vector<double>{}, 3), std::invalid_argument);
}

}  // namespace
}  // namespace broadside::lab

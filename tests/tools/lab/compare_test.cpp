// The comparison: what is measured, that nothing wrong passes, and what is skipped.
#include "lab/measure/compare.hpp"

#include <algorithm>
#include <chrono>
#include <new>
#include <stdexcept>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/sinks.hpp"

#include "lab/measure/paired_ratio.hpp"
#include "lab/scenes/scene.hpp"
#include "lab/verify/verify.hpp"
#include "tests/support/message.hpp"
#include "tests/support/use.hpp"
#include "tests/support/wrong_algorithm.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const CaseRequest small_still{.scene = "uniform", .dimension = 2, .boxes = 300};
const CaseRequest small_moving{.scene = "uniform", .dimension = 3, .boxes = 300, .moving = 0.2, .frames = 5};

CompareOptions options_for(std::string algorithms, std::vector<CaseRequest> plan) {
  CompareOptions options;
  options.algorithms = std::move(algorithms);
  options.plan = std::move(plan);
  options.effort.share_seconds = 0.001;
  return options;
}

Measurement only(const Comparison& comparison) {
  EXPECT_EQ(comparison.cases.size(), 1u);
  EXPECT_EQ(comparison.cases.at(0).measurements.size(), 1u);
  return comparison.cases.at(0).measurements.at(0);
}

TEST(Compare, VerifiesAndTimesEveryAlgorithmOnAStillScene) {
  const Catalogue catalogue;
  const Comparison comparison = compare(catalogue, options_for("own", {small_still}));
  ASSERT_EQ(comparison.cases.size(), 1u);
  const CaseResult& result = comparison.cases[0];
  EXPECT_EQ(result.of.scene, "uniform");
  EXPECT_EQ(result.of.boxes, 300u);
  EXPECT_EQ(result.of.mode, Mode::find);
  EXPECT_EQ(result.of.seeds.size(), 32u);
  ASSERT_EQ(result.measurements.size(), catalogue.select("own").size());
  const std::vector<Box2> boxes =
      make_history<2>(find_scene("uniform").scene, Spec{"uniform", {}}, {.boxes = 300, .seed = 1}).boxes;
  PairHasher hasher;
  Finder<2>("brute_force").find(boxes, hasher);
  for (const Measurement& measurement : result.measurements) {
    EXPECT_EQ(measurement.outcome, Outcome::verified) << measurement.reason;
    ASSERT_TRUE(measurement.evidence);
    EXPECT_EQ(measurement.evidence->text(), "by definition");
    EXPECT_EQ(measurement.evidence->structures, result.measurements.size() - 1) << "all but auto";
    EXPECT_EQ(measurement.evidence->libraries, 1u);
    EXPECT_GE(measurement.samples_ms.size(), 3u);
    EXPECT_EQ(measurement.pairs, hasher.count());
    EXPECT_EQ(measurement.pair_hash, hasher.hash());
  }
  EXPECT_TRUE(comparison.all_verified());
}

TEST(Compare, JoinsTwoSetsByWhatHasAJoin) {
  CaseRequest request = small_still;
  request.left = 0.25;
  for (const std::size_t definition_boxes : {1'000, 100}) {
    CompareOptions options = options_for("own,serpa_kd_tree", {request});
    options.effort.definition_boxes = definition_boxes;
    const CaseResult result = compare(Catalogue(), options).cases.at(0);
    EXPECT_EQ(result.of.left, 0.25);
    const Measurement& first = result.measurements.at(0);
    EXPECT_GT(first.pairs.value_or(0), 0u);
    // Boxes are drawn at random, so 2 * 0.25 * 0.75 of all pairs are across the sets.
    EXPECT_NEAR(static_cast<double>(*first.pairs), 0.375 * 600, 60);
    for (const Measurement& measurement : result.measurements) {
      const bool joins = measurement.kind == AlgorithmKind::own;
      EXPECT_EQ(measurement.outcome, joins ? Outcome::verified : Outcome::skipped) << measurement.reason;
      if (joins) {
        EXPECT_EQ(measurement.pair_hash, first.pair_hash);
      } else {
        EXPECT_THAT(measurement.reason, HasSubstr("has no join of two sets"));
      }
    }
  }
}

TEST(Compare, JoinsAnEmptySet) {
  CaseRequest request = small_still;
  request.left = 0.0001;
  const CaseResult result = compare(Catalogue(), options_for("own", {request})).cases.at(0);
  for (const Measurement& measurement : result.measurements) {
    EXPECT_EQ(measurement.outcome, Outcome::verified) << measurement.reason;
    EXPECT_EQ(measurement.pairs, 0u);
  }
}

TEST(Compare, TracksAMovingScene) {
  const Catalogue catalogue;
  const Comparison comparison = compare(catalogue, options_for("own", {small_moving}));
  const CaseResult& result = comparison.cases.at(0);
  EXPECT_EQ(result.of.mode, Mode::track);
  EXPECT_EQ(result.of.frames, 5u);
  EXPECT_NEAR(result.of.moving, 0.2, 0.01);
  for (const Measurement& measurement : result.measurements) {
    EXPECT_EQ(measurement.outcome, Outcome::verified) << measurement.reason;
    EXPECT_EQ(measurement.samples_ms.size() % 5, 0u);
    EXPECT_GT(measurement.build_ms.value_or(0), 0);
    EXPECT_EQ(measurement.pair_hash, result.measurements[0].pair_hash);
  }
  History<3> history = make_history<3>(find_scene("uniform").scene, Spec{"uniform", {}},
                                       {.boxes = 300, .seed = 1, .frames = 5, .moving = 0.2});
  for (const Step<3>& step : history.steps) apply(step, history.boxes);
  EXPECT_EQ(result.measurements[0].pairs, reference_pairs<3>(history.boxes).size());
}

TEST(Compare, CountsWhatAgreesWhereTheDefinitionIsTooDear) {
  Algorithm peer = *find_algorithm("brute_force");
  peer.name = "peer";
  peer.kind = AlgorithmKind::peer;
  peer.version = "Another 1.2";
  Catalogue catalogue;
  catalogue.add(peer);
  for (const CaseRequest& request : {small_still, small_moving}) {
    CompareOptions options = options_for("grid,grid:cell=2,auto,bvh,peer", {request});
    options.effort.definition_boxes = 100;
    const Comparison comparison = compare(catalogue, options);
    for (const Measurement& measurement : comparison.cases.at(0).measurements) {
      ASSERT_EQ(measurement.outcome, Outcome::verified) << measurement.reason;
      // grid, bvh, the peer, and the quadtree that they were compared with.
      EXPECT_EQ(measurement.evidence->text(), "cross-checked by 4 structures of 2 libraries");
    }
    options.effort.definition_boxes = 300;
    EXPECT_EQ(compare(catalogue, options).cases.at(0).measurements.at(0).evidence->text(), "by definition");
  }
}

TEST(Compare, LetsBoxesJumpWhereItIsAskedTo) {
  CaseRequest request = small_moving;
  request.teleport = 1;
  request.drift = 0;
  const Catalogue catalogue;
  const Comparison jumping = compare(catalogue, options_for("brute_force,bvh", {request, small_moving}));
  EXPECT_TRUE(jumping.all_verified());
  EXPECT_EQ(jumping.cases.at(0).of.teleport, 1);
  EXPECT_EQ(jumping.cases.at(0).of.drift, 0);
  EXPECT_EQ(jumping.cases.at(1).of.teleport, 0);
  EXPECT_NE(jumping.cases[0].measurements[0].pair_hash, jumping.cases[1].measurements[0].pair_hash);
}

TEST(Compare, RefusesMoreMotionThanCanBeKept) {
  const CaseRequest request{
      .scene = "uniform", .dimension = 3, .boxes = 1'000'000, .moving = 1, .frames = 10'000};
  const Catalogue catalogue;
  EXPECT_THAT(message_of<std::runtime_error>([&] { compare(catalogue, options_for("grid", {request})); }),
              HasSubstr("10000 frames of 1000000 boxes that move"));
}

TEST(Compare, ShowsEveryWayOfBeingWrong) {
  for (const CaseRequest& request : {small_still, small_moving}) {
    std::vector<std::pair<Algorithm, std::string>> wrong = {
        {misses_per_pair(), "is missing"}, {mistakes_per_pair(), "is reported; expected not"}};
    if (request.frames == 0) wrong.emplace_back(repeats_a_pair(), "is reported more than once");
    for (const auto& [algorithm, what] : wrong) {
      Catalogue catalogue;
      catalogue.add(algorithm);
      const Comparison comparison = compare(catalogue, options_for("grid," + algorithm.name, {request}));
      const Measurement& measurement = comparison.cases.at(0).measurements.at(1);
      EXPECT_EQ(measurement.outcome, Outcome::failed) << algorithm.name;
      EXPECT_THAT(measurement.reason,
                  AllOf(HasSubstr(algorithm.name + ": frame 0"), HasSubstr(what), HasSubstr("box ")));
      EXPECT_TRUE(measurement.samples_ms.empty());
      EXPECT_EQ(comparison.cases[0].measurements[0].outcome, Outcome::verified);
      EXPECT_FALSE(comparison.all_verified());
    }
  }
}

TEST(Compare, SeesWhatGoesWrongOnlyLater) {
  Catalogue catalogue;
  catalogue.add(spoilt("late", [](std::vector<Pair>& pairs, std::size_t searches) {
    if (searches == 20) mistakes_per_pair(pairs);
  }));
  CompareOptions options = options_for("late", {small_still});
  options.effort.share_seconds = 60;
  options.effort.max_rounds = 30;
  const Measurement still = only(compare(catalogue, options));
  EXPECT_EQ(still.outcome, Outcome::failed);
  EXPECT_THAT(still.reason,
              HasSubstr("search of seed 20: pair"));  // the one untimed call, then the seeds in turn
}

TEST(Compare, LetsASlowAlgorithmTakePartInTheFirstRoundsOfTheOthers) {
  for (const CaseRequest& request : {small_still, small_moving}) {
    Catalogue catalogue;
    catalogue.add(spoilt("slow", [](std::vector<Pair>&, std::size_t) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }));
    CompareOptions options = options_for("grid,slow", {request});
    options.effort.share_seconds = 0.01;
    options.effort.slow_seconds = options.effort.slow_history_seconds = 0.01;
    options.effort.slow_rounds = 2;
    options.effort.max_rounds = 8;
    const Comparison comparison = compare(catalogue, options);
    const CaseResult& result = comparison.cases.at(0);
    const std::size_t a_round = std::max<std::size_t>(result.of.frames, 1);
    EXPECT_EQ(result.measurements[0].samples_ms.size(), 8 * a_round);
    EXPECT_EQ(result.measurements[1].samples_ms.size(), 2 * a_round);
    ASSERT_TRUE(result.measurements[1].to_fastest);
    EXPECT_EQ(result.measurements[1].to_fastest->of, "grid");
    EXPECT_EQ(result.measurements[1].to_fastest->rounds, 2u);
    EXPECT_FALSE(result.measurements[1].to_fastest->interval);
  }
}

TEST(Compare, LetsEveryAlgorithmTakePartInTheLeastOfRounds) {
  CompareOptions options = options_for("own", {small_still, small_moving});
  options.effort.share_seconds = 0;
  options.effort.min_rounds = 6;
  for (const CaseResult& result : compare(Catalogue(), options).cases) {
    for (const Measurement& measurement : result.measurements)
      EXPECT_EQ(round_times(measurement).size(), 6u) << measurement.algorithm;
  }
}

TEST(Compare, TakesWhatAnAlgorithmThrowsForItsFailure) {
  for (const CaseRequest& request : {small_still, small_moving}) {
    Catalogue catalogue;
    catalogue.add(
        spoilt("throws", [](std::vector<Pair>&, std::size_t) { throw std::runtime_error("full"); }));
    const Measurement measurement = only(compare(catalogue, options_for("throws", {request})));
    EXPECT_EQ(measurement.outcome, Outcome::failed);
    EXPECT_EQ(measurement.reason, "throws threw: full");
  }
}

TEST(Compare, SkipsAnAlgorithmThatRunsOutOfMemory) {
  for (const CaseRequest& request : {small_still, small_moving}) {
    Catalogue catalogue;
    catalogue.add(spoilt("greedy", [](std::vector<Pair>&, std::size_t) { throw std::bad_alloc(); }));
    const Measurement measurement = only(compare(catalogue, options_for("greedy", {request})));
    EXPECT_EQ(measurement.outcome, Outcome::skipped);
    EXPECT_EQ(measurement.reason, "out of memory; expected fewer boxes or pairs");
  }
}

TEST(Compare, LeavesOutBoxesThatAreBeyondDeclaredLimits) {
  Algorithm limited = *find_algorithm("grid");
  limited.name = "limited";
  limited.limits.max_coordinate = 1;
  for (const CaseRequest& request : {small_still, small_moving}) {
    Catalogue catalogue;
    catalogue.add(limited);
    const Measurement measurement = only(compare(catalogue, options_for("limited", {request})));
    EXPECT_EQ(measurement.outcome, Outcome::skipped);
    EXPECT_EQ(measurement.reason, "does not take coordinates beyond 1");
  }
}

TEST(Compare, CountsNoMemoryWhereItCannotAllBeCounted) {
  Algorithm own_allocator = *find_algorithm("grid");
  own_allocator.name = "own_allocator";
  own_allocator.own_allocator = true;
  for (const CaseRequest& request : {small_still, small_moving}) {
    Catalogue catalogue;
    catalogue.add(own_allocator);
    const Measurement measurement = only(compare(catalogue, options_for("own_allocator", {request})));
    EXPECT_EQ(measurement.outcome, Outcome::verified);
    EXPECT_FALSE(measurement.own_bytes.has_value());
    EXPECT_FALSE(measurement.peak_bytes.has_value());
  }
}

TEST(Compare, SkipsWhatIsTooSlowForTheBudgetAndEstimatesIt) {
  for (const std::size_t frames : {std::size_t{0}, std::size_t{2}}) {
    CompareOptions options = options_for("brute_force,grid", {{"uniform", 2, 5'100, 0.1, frames}});
    options.effort.budget_seconds = options.effort.history_seconds = 1e-9;
    const Comparison comparison = compare(Catalogue(), options);
    const Measurement& measurement = comparison.cases.at(0).measurements.at(0);
    EXPECT_EQ(measurement.outcome, Outcome::skipped);
    EXPECT_THAT(measurement.reason,
                AllOf(HasSubstr("estimated "), HasSubstr(" from 255 boxes, scaled by n^2.00"),
                      HasSubstr("; budget 1e-09 s")));
    EXPECT_GT(measurement.estimated_ms, 0);
    EXPECT_TRUE(measurement.samples_ms.empty());
    EXPECT_FALSE(measurement.pairs);
    EXPECT_FALSE(comparison.all_verified());
  }
}

TEST(Compare, SaysWhichDimensionAndWhichBoxesAnAlgorithmDoesNotDo) {
  Algorithm flat = spoilt("flat", [](std::vector<Pair>&, std::size_t) {});
  flat.in_3d.searcher = nullptr;
  Catalogue catalogue;
  catalogue.add(flat);
  const Comparison comparison = compare(catalogue, options_for("flat", {small_still, small_moving}));
  EXPECT_EQ(comparison.cases.at(0).measurements.at(0).outcome, Outcome::verified);
  EXPECT_EQ(comparison.cases.at(1).measurements.at(0).outcome, Outcome::skipped);
  EXPECT_EQ(comparison.cases.at(1).measurements.at(0).reason, "does not support 3D");
}

TEST(Compare, SkipsWhatIsGivenMoreBoxesThanItTakes) {
  Algorithm small = spoilt("small", [](std::vector<Pair>&, std::size_t) {});
  for (const std::size_t most : {299, 300}) {
    small.limits.max_boxes = most;
    Catalogue catalogue;
    catalogue.add(small);
    for (const CaseRequest& request : {small_still, small_moving}) {
      const Measurement measurement = only(compare(catalogue, options_for("small", {request})));
      EXPECT_EQ(measurement.outcome, most < 300 ? Outcome::skipped : Outcome::verified) << measurement.reason;
      EXPECT_EQ(measurement.reason, most < 300 ? "does not take more than 299 boxes" : "");
    }
  }
}

TEST(Compare, CountsTheMemoryThatAnAlgorithmKeeps) {
  struct Keeper final : Searcher<2> {
    std::optional<Statistics> search(const SearchInput<2>&, PairSink&) override {
      kept.assign(1'000'000, 1);
      const std::vector<char> dropped(500'000, 1);
      use(dropped.data());
      return std::nullopt;
    }
    std::vector<char> kept;
  };
  Algorithm algorithm;
  algorithm.name = "keeper";
  algorithm.in_2d.searcher = make_strategy<Keeper>;
  Catalogue catalogue;
  catalogue.add(algorithm);
  // Boxes so small that none touch: a keeper that finds nothing is right.
  const Measurement measurement =
      only(compare(catalogue, options_for("keeper", {{"uniform:neighbours=0.000001", 2, 300}})));
  ASSERT_EQ(measurement.outcome, Outcome::verified) << measurement.reason;
  if (!measurement.own_bytes) GTEST_SKIP() << "this build does not count allocations";
  EXPECT_GE(*measurement.own_bytes, 1'000'000u);
  EXPECT_LE(*measurement.own_bytes, 1'020'000u);
  EXPECT_GE(*measurement.peak_bytes, 1'500'000u);
  EXPECT_LE(*measurement.peak_bytes, 1'520'000u);
}

TEST(Compare, CountsTheMemoryThatATrackerComesToKeep) {
  struct Keeper final : Follower<2> {
    std::optional<Statistics> follow(const Change<2>&, PairSink&, PairSink&) override {
      kept.emplace_back(200'000, 1);
      return std::nullopt;
    }
    std::vector<std::vector<char>> kept;
  };
  Algorithm algorithm = spoilt("keeper", [](std::vector<Pair>&, std::size_t) {});
  algorithm.in_2d.followers = {{.name = "keeper", .make = make_strategy<Keeper>}};
  Catalogue catalogue;
  catalogue.add(algorithm);
  const Measurement measurement =
      only(compare(catalogue, options_for("keeper", {{"uniform:neighbours=0.000001", 2, 300, 0.1, 4}})));
  ASSERT_EQ(measurement.outcome, Outcome::verified) << measurement.reason;
  if (!measurement.own_bytes) GTEST_SKIP() << "this build does not count allocations";
  EXPECT_GE(*measurement.own_bytes, 5 * 200'000u);
  EXPECT_LE(*measurement.own_bytes, 5 * 200'000u + 50'000);
  EXPECT_GE(*measurement.peak_bytes, *measurement.own_bytes);
}

TEST(Compare, StopsBetweenTwoSamplesAndKeepsWhatIsWhole) {
  CompareOptions options = options_for("own", {small_still, small_moving});
  std::size_t finished = 0;
  options.finished = [&](const CaseResult&) { ++finished; };
  options.watch.stop = [&] { return finished == 1; };
  const Comparison comparison = compare(Catalogue(), options);
  EXPECT_TRUE(comparison.stopped);
  EXPECT_EQ(comparison.cases.size(), 1u);
}

TEST(Compare, RefusesWhatIsUnknownBeforeAnythingIsMeasured) {
  CompareOptions options = options_for("own", {small_still, {"nowhere", 2, 100}});
  options.finished = [](const CaseResult&) { ADD_FAILURE() << "measured"; };
  EXPECT_THAT(message_of<InvalidSpec>([&] { compare(Catalogue(), options); }), HasSubstr("'nowhere'"));
  options.algorithms = "nothing";
  EXPECT_THAT(message_of<InvalidSpec>([&] { compare(Catalogue(), options); }), HasSubstr("'nothing'"));
}

TEST(Compare, SkipsASpecWhereItMakesNoSense) {
  const Comparison comparison = compare(Catalogue(), options_for("sweep_and_prune:axis=z", {small_still}));
  ASSERT_EQ(comparison.cases.size(), 1u);
  const Measurement& measurement = comparison.cases[0].measurements.at(0);
  EXPECT_EQ(measurement.outcome, Outcome::skipped);
  EXPECT_THAT(measurement.reason, HasSubstr("expected x, y or auto in 2D"));
  EXPECT_FALSE(comparison.all_verified());
}

TEST(Compare, ReportsAPlannedSceneThatIsNotThere) {
  CaseRequest missing{"nowhere", 2, 100};
  missing.required = false;
  const Comparison comparison = compare(Catalogue(), options_for("grid", {missing, small_still}));
  EXPECT_EQ(comparison.cases.size(), 1u);
  ASSERT_EQ(comparison.not_compared.size(), 1u);
  EXPECT_EQ(comparison.not_compared[0].request.scene, "nowhere");
  EXPECT_THAT(comparison.not_compared[0].reason, HasSubstr("unknown scene 'nowhere'"));
}

TEST(Compare, RefusesMorePairsThanCanBeKept) {
  const std::string message = message_of<std::runtime_error>([] {
    compare(Catalogue(), options_for("grid", {{"one_point", 2, 100'000}}));
  });
  EXPECT_THAT(message, HasSubstr("100,000 boxes with about 5.0e+09 pairs; expected at most 2.5e+08"));
}

}  // namespace
}  // namespace broadside::lab

// Peers that are broken on purpose: each is reported as failed, with its message, and the others are
// measured.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/measure/compare.hpp"
#include "lab/platform/child_process.hpp"
#include "tests/support/wrong_algorithm.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::StartsWith;

const CaseRequest broken_still{.scene = "uniform", .dimension = 2, .boxes = 300};
const CaseRequest broken_moving{.scene = "uniform", .dimension = 2, .boxes = 300, .moving = 0.2, .frames = 5};

bool has_child_processes() {
  return platform::run_in_child([](platform::ChildNote&) { return "x"; },
                                [](const platform::ChildNote&) { return true; })
      .has_value();
}

Algorithm peer(Algorithm algorithm) {
  algorithm.kind = AlgorithmKind::peer;
  return algorithm;
}

/// A peer that calls `breaks` in a search.
Algorithm broken(std::string name, void (*breaks)()) {
  return peer(spoilt(std::move(name), [breaks](std::vector<Pair>&, std::size_t) { breaks(); }));
}

void fail_an_assertion() {
  std::fputs("a warning\ntree.cpp:12: Assertion `height < 64' failed.\n", stderr);
  std::abort();
}

void write_nowhere() {
  volatile int* volatile nowhere = nullptr;
  *nowhere = 1;
}

void loop_for_ever() {
  while (true) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// Finds all pairs, and aborts when it is destroyed after a search.
class AbortsInTheEnd final : public Searcher<2> {
 public:
  AbortsInTheEnd() = default;
  AbortsInTheEnd(const AbortsInTheEnd&) = delete;
  AbortsInTheEnd& operator=(const AbortsInTheEnd&) = delete;
  ~AbortsInTheEnd() override {
    if (has_searched_) std::abort();
  }

  std::optional<Statistics> search(const SearchInput<2>& input, PairSink& sink) override {
    has_searched_ = true;
    return Finder<2>("brute_force").find(input.boxes, sink);
  }

 private:
  bool has_searched_ = false;
};

CompareOptions quick_options(std::string algorithms, std::vector<CaseRequest> plan) {
  CompareOptions options;
  options.algorithms = std::move(algorithms);
  options.plan = std::move(plan);
  options.effort.share_seconds = 0;
  options.effort.budget_seconds = options.effort.history_seconds = 0.2;  // a busy machine stalls
  options.effort.limit_seconds = 2;
  options.effort.min_rounds = 2;
  return options;
}

TEST(GuardedCase, ReportsEveryWayInWhichAPeerCanFailAndMeasuresTheOthers) {
  if (!has_child_processes()) GTEST_SKIP() << "this system cannot copy a process";
  const std::vector<std::pair<Algorithm, std::string>> peers = {
      {peer(misses_per_pair()), "frame 0.*is missing"},
      {broken("throws", [] { throw std::runtime_error("full"); }), "threw: full"},
      {broken("aborts", fail_an_assertion),
       "ended the process: signal 6, .*: a warning; tree.cpp:12: Assertion `height < 64' failed. \\(in "
       "'aborts, "},
      {broken("writes_nowhere", write_nowhere), "ended the process: "},
      {broken("exits", [] { std::exit(0); }), "ended the process: exit status 0 \\(in 'exits, "},
      {broken("loops", loop_for_ever), "did not return within 2[.0]* s \\(in 'loops, "},
  };
  Catalogue catalogue;
  std::string algorithms = "grid,aborts_in_the_end";
  for (const auto& [algorithm, what] : peers) {
    catalogue.add(algorithm);
    algorithms += "," + algorithm.name;
  }
  Algorithm in_the_end = peer(spoilt("aborts_in_the_end", [](std::vector<Pair>&, std::size_t) {}));
  in_the_end.in_2d.searcher = make_strategy<AbortsInTheEnd>;
  catalogue.add(in_the_end);
  const Comparison comparison = compare(catalogue, quick_options(algorithms, {broken_moving, broken_still}));
  ASSERT_EQ(comparison.cases.size(), 2u);
  for (const CaseResult& result : comparison.cases) {
    const std::vector<Measurement>& measurements = result.measurements;
    ASSERT_EQ(measurements.size(), peers.size() + 2);
    EXPECT_EQ(measurements[0].outcome, Outcome::verified) << measurements[0].reason;
    EXPECT_FALSE(measurements[0].samples_ms.empty());
    EXPECT_EQ(measurements[1].outcome, Outcome::failed);
    EXPECT_THAT(measurements[1].reason, AllOf(StartsWith("aborts_in_the_end ended the process: signal 6, "),
                                              HasSubstr("(in 'aborts_in_the_end, tearing down')")));
    for (std::size_t i = 0; i < peers.size(); ++i) {
      const Measurement& measurement = measurements[i + 2];
      EXPECT_EQ(measurement.algorithm, peers[i].first.name);
      EXPECT_TRUE(measurement.samples_ms.empty());
      if (measurement.algorithm == "loops" && result.of.mode == Mode::find) {
        EXPECT_EQ(measurement.outcome, Outcome::skipped);
        EXPECT_EQ(measurement.reason, "did not return in an earlier case");
        continue;
      }
      EXPECT_EQ(measurement.outcome, Outcome::failed) << measurement.algorithm;
      EXPECT_THAT(measurement.reason,
                  AllOf(StartsWith(measurement.algorithm), ContainsRegex(peers[i].second)));
    }
  }
  EXPECT_FALSE(comparison.all_verified());
}

TEST(GuardedCase, ReportsADoubledPairOfAPeer) {
  Catalogue catalogue;
  catalogue.add(peer(repeats_a_pair()));
  const Comparison comparison = compare(catalogue, quick_options("grid,repeats", {broken_still}));
  EXPECT_THAT(comparison.cases.at(0).measurements.at(1).reason, HasSubstr("is reported more than once"));
  EXPECT_EQ(comparison.cases[0].measurements[0].outcome, Outcome::verified);
}

TEST(GuardedCase, StopsWhileAPeerDoesNotReturn) {
  if (!has_child_processes()) GTEST_SKIP() << "this system cannot copy a process";
  Catalogue catalogue;
  catalogue.add(broken("loops", loop_for_ever));
  CompareOptions options = quick_options("grid,loops", {broken_still});
  options.effort.limit_seconds = 1e9;
  bool loops = false;
  options.watch.progress = [&](std::string_view what) { loops |= what.find("loops, ") != what.npos; };
  options.watch.stop = [&] { return loops; };
  EXPECT_TRUE(compare(catalogue, options).stopped);
}

TEST(GuardedCase, BringsBackAllThatIsMeasuredWithoutPeers) {
  Catalogue catalogue;
  catalogue.add(peer(spoilt("peer", [](std::vector<Pair>&, std::size_t) {})));
  for (CaseRequest request : {broken_still, broken_moving}) {
    request.boxes = 1'000;  // the fewest with a floor
    CompareOptions options = quick_options("auto,paper_grid", {request});
    options.measure_options = {.times = false, .phases = true};
    const CaseResult alone = compare(catalogue, options).cases.at(0);
    options.algorithms += ",peer";
    const CaseResult guarded = compare(catalogue, options).cases.at(0);
    EXPECT_EQ(guarded.floor_ms.size(), alone.floor_ms.size());
    for (std::size_t i = 0; i < 2; ++i) {
      const Measurement& a = alone.measurements.at(i);
      const Measurement& b = guarded.measurements.at(i);
      EXPECT_EQ(b.outcome, Outcome::verified) << b.reason;
      EXPECT_EQ(b.algorithm, a.algorithm);
      EXPECT_EQ(b.version, a.version);
      EXPECT_EQ(b.target, a.target);
      EXPECT_EQ(b.samples_ms.size(), a.samples_ms.size());
      EXPECT_EQ(b.samples_per_round, a.samples_per_round);
      EXPECT_EQ(b.build_ms.has_value(), a.build_ms.has_value());
      EXPECT_EQ(b.pairs, a.pairs);
      EXPECT_EQ(b.pair_hash, a.pair_hash);
      ASSERT_EQ(b.statistics_by_seed.size(), a.statistics_by_seed.size());
      for (std::size_t seed = 0; seed < a.statistics_by_seed.size(); ++seed) {
        ASSERT_TRUE(b.statistics_by_seed[seed]);
        EXPECT_EQ(b.statistics_by_seed[seed]->tests, a.statistics_by_seed[seed]->tests);
      }
      EXPECT_EQ(b.phases.size(), a.phases.size());
      EXPECT_EQ(b.explanation, a.explanation);
      EXPECT_EQ(b.own_bytes.has_value(), a.own_bytes.has_value());
      EXPECT_TRUE(b.evidence);
    }
  }
}

TEST(ChildProcess, CountsItsProcessorTimeForItsParent) {
  if (!has_child_processes()) GTEST_SKIP() << "this system cannot copy a process";
  const double before = platform::processor_seconds();
  platform::run_in_child(
      [](platform::ChildNote&) -> std::string {
        while (std::clock() < CLOCKS_PER_SEC / 10) {
        }
        return "done";
      },
      [](const platform::ChildNote&) { return true; });
  EXPECT_GE(platform::processor_seconds() - before, 0.09);
}

}  // namespace
}  // namespace broadside::lab

// Lists of cases: what they say, what they refuse before anything runs, and what is measured of them.
#include "lab/measure/case_list.hpp"

#include <filesystem>
#include <fstream>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "broadside/executor.hpp"

#include "lab/formats/format.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::Each;
using testing::HasSubstr;

nlohmann::json listed(const nlohmann::json& changes = {}) {
  nlohmann::json one = {{"name", "small"}, {"scene", "uniform"}, {"boxes", 200}, {"specs", {"paper_grid"}}};
  if (!changes.is_null()) one.merge_patch(changes);
  return one;
}

std::vector<ListedCase> read(const nlohmann::json& cases, const nlohmann::json& effort = {}) {
  static const Catalogue catalogue;
  // Braces around a single case copy it, so that it is no list.
  const nlohmann::json all = cases.is_array() ? cases : nlohmann::json::array({cases});
  nlohmann::json list = {{"schema", "broadside.cases/1"}, {"cases", all}};
  if (!effort.is_null()) list["effort"] = effort;
  return read_case_list(list.dump(), "list.json", catalogue, scene_finder({}));
}

CaseResult measured(const nlohmann::json& changes) {
  static const Catalogue catalogue;
  const nlohmann::json effort = {{"share_seconds", 0}, {"min_rounds", 2}, {"max_rounds", 2}};
  Comparison all = measure_cases(catalogue, read({listed(changes)}, effort), {});
  EXPECT_TRUE(all.all_verified());
  return std::move(all.cases.at(0));
}

TEST(CaseList, JoinsTwoSetsAndTakesFilters) {
  const auto pairs = [](const nlohmann::json& changes) {
    return measured(changes).measurements.at(0).pairs.value();
  };
  const nlohmann::json grid = {{"specs", {"grid"}}, {"seeds", 1}};
  nlohmann::json joined = grid;
  joined["left"] = 0.5;
  nlohmann::json filtered = grid;
  filtered["filtered"] = true;
  EXPECT_LT(pairs(joined), pairs(grid));
  EXPECT_LT(pairs(filtered), pairs(grid));
  EXPECT_GT(pairs(joined), 0u);
  EXPECT_GT(pairs(filtered), 0u);
}

TEST(CaseList, GivesEachCaseItsBoxesAlgorithmsAndEffort) {
  const std::vector<ListedCase> cases = read({listed(), listed({{"name", "moving"},
                                                                {"dimension", 3},
                                                                {"specs", {"bvh", "grid:update=follow"}},
                                                                {"seed", 7},
                                                                {"seeds", 3},
                                                                {"frames", 4},
                                                                {"moving", 0.5},
                                                                {"drift", 2},
                                                                {"teleport", 0.25},
                                                                {"effort", {{"max_rounds", 9}}}})},
                                             {{"min_rounds", 3}, {"max_rounds", 5}});
  ASSERT_EQ(cases.size(), 2u);
  EXPECT_EQ(cases[0].algorithms, "paper_grid");
  EXPECT_EQ(cases[0].request, (CaseRequest{.scene = "uniform", .boxes = 200}));
  EXPECT_EQ(cases[0].effort.max_rounds, 5u);
  EXPECT_EQ(cases[1].algorithms, "bvh,grid:update=follow");
  EXPECT_EQ(cases[1].request, (CaseRequest{.scene = "uniform",
                                           .dimension = 3,
                                           .boxes = 200,
                                           .moving = 0.5,
                                           .frames = 4,
                                           .drift = 2,
                                           .teleport = 0.25}));
  EXPECT_EQ(cases[1].seed, 7u);
  EXPECT_EQ(cases[1].seeds, 3u);
  EXPECT_EQ(cases[1].effort.min_rounds, 3u);
  EXPECT_EQ(cases[1].effort.max_rounds, 9u);
}

TEST(CaseList, RefusesABadCaseByItsNameWhatItSaysAndWhatWasExpected) {
  struct Bad {
    nlohmann::json changes;
    std::vector<std::string> message;
  };
  const std::vector<Bad> all = {
      {{{"boxes", 0}}, {"cases 2 'bad': boxes is '0'", "from 1"}},
      {{{"boxes", -5}}, {"boxes is '-5'", "whole number"}},
      {{{"boxes", "many"}}, {"boxes is '\"many\"'", "whole number"}},
      {{{"boxes", nullptr}}, {"has no 'boxes'"}},
      {{{"boxs", 10}}, {"has a field 'boxs'", "boxes"}},
      {{{"name", ""}}, {"name is '\"\"'", "a name"}},
      {{{"name", "small"}}, {"name is '\"small\"'", "no other case has"}},
      {{{"scene", "unifrom"}}, {"cases 2 'bad': scene: unknown scene 'unifrom'", "uniform"}},
      {{{"scene", "no/such.csv"}}, {"scene:", "no/such.csv"}},
      {{{"scene", {"uniform"}}}, {"scene 1 is '\"uniform\"'", "a file of boxes at rest"}},
      {{{"dimension", 4}}, {"dimension is '4'", "from 2 to 3"}},
      {{{"dimension", 3}}, {"specs 1 is '\"paper_grid\"'", "for 3D", "does not support 3D"}},
      {{{"specs", nlohmann::json::array()}}, {"specs is '[]'", "at least one"}},
      {{{"specs", {"grid:cell=-1"}}}, {"cases 2 'bad': specs 1: ", "cell", "-1"}},
      {{{"specs", {"gird"}}}, {"specs 1: ", "'gird'", "grid"}},
      {{{"moving", 0.5}}, {"moving is '0.5'", "frames as well"}},
      {{{"moving", 2}, {"frames", 3}}, {"moving is '2'", "from 0 to 1"}},
      {{{"frames", 3}}, {"frames is '3'", "moving"}},
      {{{"left", 2}}, {"left is '2'", "from 0 to 1"}},
      {{{"left", 0.5}, {"frames", 3}, {"moving", 1}}, {"left is '0.5'", "none where boxes move"}},
      {{{"scene", "churn"}, {"filtered", true}}, {"filtered is 'true'", "none where boxes move"}},
      {{{"left", 0.5}, {"filtered", true}}, {"filtered is 'true'", "two sets"}},
      {{{"scene", "churn"}, {"frames", 3}, {"moving", 0.5}}, {"moving is '0.5'", "'churn' moves by itself"}},
      {{{"scene", "integers"}, {"seeds", 0}}, {"seeds is '0'", "from 1"}},
      {{{"take", {"colour"}}}, {"take 1 is '\"colour\"'", "time, counts, memory or phases"}},
      {{{"take", {"phases"}}, {"specs", {"grid"}}}, {"specs is '[\"grid\"]'", "a listing of the paper"}},
      {{{"take", {"phases"}}, {"specs", {"paper_brute_force"}}, {"frames", 2}, {"moving", 1}},
       {"specs is '[", "phases"}},
      {{{"made_anew", true}, {"frames", 2}, {"moving", 1}}, {"made_anew is 'true'", "keeps its structure"}},
      {{{"instruction_set", "AVX9"}}, {"instruction_set is '\"AVX9\"'", instruction_set()}},
      {{{"effort", {{"min_rounds", 50}, {"max_rounds", 5}}}}, {"effort is", "max_rounds"}},
      {{{"effort", {{"seconds", 5}}}}, {"effort has a field 'seconds'", "share_seconds"}},
  };
  for (const Bad& bad : all) {
    nlohmann::json changes = {{"name", "bad"}};
    changes.update(bad.changes);
    const std::string message = message_of<FileError>([&] { read({listed(), listed(changes)}); });
    EXPECT_THAT(message, HasSubstr("list.json"));
    for (const std::string& part : bad.message) EXPECT_THAT(message, HasSubstr(part)) << changes;
  }
  EXPECT_THAT(message_of<FileError>([] { read(nlohmann::json::array()); }), HasSubstr("at least one case"));
  const Catalogue catalogue;
  for (const auto& [text, part] :
       {std::pair("{\"schema\": \"broadside.cases/9\", \"cases\": []}", "broadside.cases/1"),
        std::pair("[]", "an object"), std::pair("{", "expected JSON")}) {
    EXPECT_THAT(message_of<FileError>(
                    [&, &list = text] { read_case_list(list, "list.json", catalogue, scene_finder({})); }),
                AllOf(HasSubstr("list.json"), HasSubstr(part)));
  }
}

TEST(CaseList, MeasuresTheAlgorithmsOfACaseInTheSameRoundsOnItsSeeds) {
  const CaseResult result = measured({{"specs", {"paper_grid", "grid"}}, {"seed", 5}, {"seeds", 2}});
  EXPECT_EQ(result.of.name, "small");
  EXPECT_EQ(result.of.seeds, (std::vector<std::uint64_t>{5, 6}));
  ASSERT_EQ(result.measurements.size(), 2u);
  for (const Measurement& measurement : result.measurements) {
    EXPECT_EQ(measurement.samples_ms.size(), 2u);
    EXPECT_TRUE(measurement.phases.empty());
    ASSERT_EQ(measurement.statistics_by_seed.size(), 2u);
    EXPECT_EQ(measurement.statistics_by_seed[0]->tests, measurement.statistics->tests);
    EXPECT_NE(measurement.statistics_by_seed[1]->tests, measurement.statistics->tests);
  }
}

TEST(CaseList, HoldsACaseToItsInstructionSet) {
  for (const std::string& set : instruction_sets()) {
    const Measurement measurement =
        measured({{"specs", {"grid"}}, {"instruction_set", set}}).measurements.at(0);
    EXPECT_EQ(measurement.target, set);
  }
  EXPECT_EQ(instruction_set(), instruction_sets().front());
}

TEST(CaseList, RunsOnceOnEachSeedWhereOnlyCountsAreTaken) {
  const nlohmann::json counts = {{"take", {"counts"}}, {"seeds", 3}};
  EXPECT_EQ(measured(counts).measurements.at(0).samples_ms.size(), 3u);
}

TEST(CaseList, TakesThePhasesOfAListingsSearchWithinItsTime) {
  for (const char* const spec :
       {"paper_brute_force", "paper_grid", "paper_sweep_and_prune", "paper_quadtree"}) {
    const nlohmann::json phases = {{"take", {"phases"}}, {"specs", {spec}}, {"made_anew", true}};
    const Measurement measurement = measured(phases).measurements.at(0);
    ASSERT_EQ(measurement.phases.size(), measurement.samples_ms.size());
    for (std::size_t i = 0; i < measurement.phases.size(); ++i) {
      const paper::Phases& sample = measurement.phases[i];
      EXPECT_GT(sample.adding_ms, 0) << spec;
      EXPECT_GT(sample.searching_ms, 0) << spec;
      EXPECT_LE(sample.initializing_ms + sample.adding_ms + sample.searching_ms, measurement.samples_ms[i]);
    }
  }
}

TEST(CaseList, TakesThePhasesOfAListingsFrameWithinItsTime) {
  const Measurement measurement = measured({{"take", {"phases"}},
                                            {"specs", {"paper_sweep_and_prune:update=insertion"}},
                                            {"frames", 3},
                                            {"moving", 0.5}})
                                      .measurements.at(0);
  ASSERT_EQ(measurement.samples_ms.size(), 6u) << "two rounds of three frames";
  ASSERT_EQ(measurement.phases.size(), 6u);
  for (std::size_t i = 0; i < measurement.phases.size(); ++i) {
    const paper::Phases& sample = measurement.phases[i];
    EXPECT_EQ(sample.movers, 100u);
    EXPECT_GT(sample.mending_ms, 0);
    EXPECT_LE(sample.detecting_ms + sample.mending_ms + sample.searching_ms + sample.comparing_ms,
              measurement.samples_ms[i]);
  }
}

TEST(CaseList, TakesSeveralFilesAsInputsInRotation) {
  const std::filesystem::path folder = testing::TempDir();
  std::vector<std::string> files;
  for (const int boxes : {2, 3}) {
    files.push_back((folder / ("case_list_" + std::to_string(boxes) + ".csv")).string());
    std::ofstream file(files.back());
    file << "min_x,min_y,max_x,max_y\n";
    for (int i = 0; i < boxes; ++i) file << "0,0," << i + 1 << ",1\n";
  }
  nlohmann::json one = listed({{"scene", files}, {"specs", {"paper_brute_force"}}});
  one.erase("boxes");
  const Catalogue catalogue;
  const Comparison all = measure_cases(catalogue, read({one}), {});
  const Measurement& measurement = all.cases.at(0).measurements.at(0);
  EXPECT_EQ(measurement.outcome, Outcome::verified) << measurement.reason;
  ASSERT_EQ(measurement.statistics_by_seed.size(), 2u);
  EXPECT_EQ(measurement.statistics_by_seed[0]->tests, 1u);
  EXPECT_EQ(measurement.statistics_by_seed[1]->tests, 3u);
}

TEST(CaseList, StopsBetweenCasesAndKeepsThoseThatHadEnded) {
  const Catalogue catalogue;
  bool has_ended = false;
  const Watch watch{.stop = [&] { return has_ended; }};
  const Comparison all = measure_cases(catalogue, read({listed(), listed({{"name", "second"}})}), watch,
                                       [&](const CaseResult&) { has_ended = true; });
  EXPECT_TRUE(all.stopped);
  EXPECT_EQ(all.cases.size(), 1u);
}

}  // namespace
}  // namespace broadside::lab

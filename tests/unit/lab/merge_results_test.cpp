// Results files merged: one machine's as further processes, others side by side, and what is refused.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "lab/formats/format.hpp"
#include "lab/measure/paired_ratio.hpp"
#include "lab/report/json.hpp"
#include "lab/report/results.hpp"
#include "lab/report/table.hpp"
#include "tests/support/message.hpp"
#include "tests/support/text_of.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::ordered_json;

/// Files made of the fixture, which disappear with it.
class MergeResults : public testing::Test {
 protected:
  MergeResults() : folder_(std::filesystem::temp_directory_path()) {
    folder_ /= "broadside-merge-" + std::to_string(::getpid());
    std::filesystem::create_directories(folder_);
  }
  ~MergeResults() override { std::filesystem::remove_all(folder_); }

  /// The fixture's results with every time of `algorithm` multiplied, which makes them another run's.
  static Json run(double factor, const std::string& algorithm = "grid") {
    Json json = Json::parse(text_of(BROADSIDE_SOURCE_DIR "/tests/fixtures/results_v2.json"));
    for (Json& measurement : json["measurements"]) {
      if (measurement["algorithm"] != algorithm) continue;
      for (Json& sample : measurement["samples_ms"]) sample = sample.get<double>() * factor;
    }
    return json;
  }

  std::string put(const std::string& name, const Json& json) const {
    std::ofstream(folder_ / name) << json.dump();
    return (folder_ / name).string();
  }

  std::string put(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return (folder_ / name).string();
  }

  /// What merging the fixture with a file that `change` has changed is refused with.
  template <typename Change>
  std::string refusal(Change change) const {
    Json other = run(2);
    change(other);
    const std::vector<std::string> files = {put("a.json", run(1)), put("b.json", other)};
    return message_of<FileError>([&] { merge_results(files); });
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(MergeResults, ReadsAFileOfTheSchemaAsItWasBefore) {
  const std::vector<Results> machines = read_results(BROADSIDE_SOURCE_DIR "/tests/fixtures/results_v2.json");
  ASSERT_EQ(machines.size(), 1u);
  EXPECT_EQ(machines[0].machine.cpu, "AMD EPYC");
  EXPECT_EQ(machines[0].processes.size(), 1u);
  const CaseResult& result = machines[0].comparison.cases.at(0);
  ASSERT_EQ(result.measurements.size(), 3u);
  EXPECT_EQ(result.measurements[0].samples_ms.size(), 100u);
  EXPECT_TRUE(result.measurements[0].evidence->by_definition);
  const Json written = Json::parse(text_of(BROADSIDE_SOURCE_DIR "/tests/fixtures/results_v2.json"));
  const Json& ratio = written["measurements"][0]["ratio_to_fastest"];
  EXPECT_EQ(result.measurements[0].to_fastest->of, ratio["of"]);
  // Computed anew from the samples: that version's medians were not of logarithms.
  EXPECT_NEAR(result.measurements[0].to_fastest->median, ratio["median"], 0.05);
  EXPECT_NEAR(result.measurements[0].to_fastest->interval->low, ratio["low"], 0.05);
}

TEST_F(MergeResults, TakesFilesOfOneMachineForItsProcesses) {
  const std::vector<std::string> files = {put("a.json", run(1)), put("b.json", run(4))};
  const std::vector<Results> machines = merge_results(files);
  ASSERT_EQ(machines.size(), 1u);
  EXPECT_EQ(machines[0].processes.size(), 2u);
  const Measurement& grid = machines[0].comparison.cases.at(0).measurements.at(0);
  EXPECT_EQ(grid.samples_ms.size(), 200u);
  EXPECT_THAT(grid.rounds_of_processes, testing::ElementsAre(100, 100));
  const double first = read_results(files[0])[0].comparison.cases[0].measurements[0].to_fastest->median;
  EXPECT_NEAR(grid.to_fastest->median, 2 * first, 1e-9);  // the geometric mean of 1 and 4 times as long
  EXPECT_EQ(grid.to_fastest->processes, 2u);
  EXPECT_GT(grid.to_fastest->interval->high, 100) << "two processes that differ say little";
}

TEST_F(MergeResults, ReadsWhatItWroteAndAddsMore) {
  const std::vector<std::string> two = {put("a.json", run(1)), put("b.json", run(2))};
  const std::string merged = put("merged.json", json_of(merge_results(two)));
  const std::string third = put("c.json", run(3));
  const std::vector<std::string> all = {two[0], two[1], third};
  const std::vector<std::string> by_parts = {merged, third};
  EXPECT_EQ(json_of(merge_results(by_parts)), json_of(merge_results(all)));
  const std::vector<std::string> again = {merged, two[1]};
  EXPECT_THAT(message_of<FileError>([&] { merge_results(again); }),
              AllOf(HasSubstr("b.json: holds a run that is in "), HasSubstr("merged.json")));
}

TEST_F(MergeResults, PutsMachinesSideBySide) {
  Json other = run(2);
  other["machine"]["cpu"] = "Another";
  other["build"]["compiler"] = "Clang 14.0.6";
  const std::vector<std::string> files = {put("a.json", run(1)), put("b.json", other)};
  const std::vector<Results> machines = merge_results(files);
  ASSERT_EQ(machines.size(), 2u);
  EXPECT_EQ(machines[1].machine.cpu, "Another");
  EXPECT_THAT(leads_of(machines),
              AllOf(HasSubstr("AMD EPYC, 2 cores, AVX-512"), HasSubstr("Another, 2 cores")));
  const Json json = Json::parse(json_of(machines, Samples::leave_out));
  EXPECT_EQ(json["machine"]["cpu"], "AMD EPYC");
  EXPECT_EQ(json["other_machines"][0]["machine"]["cpu"], "Another");
  EXPECT_TRUE(json["measurements"][0]["samples_ms"].is_null());
  const std::vector<std::string> archive = {put("archive.json", json_of(machines))};
  EXPECT_EQ(json_of(merge_results(archive)), json_of(machines));
}

TEST_F(MergeResults, RefusesWhatDoesNotBelongTogether) {
  EXPECT_THAT(refusal([](Json& json) { json["build"]["revision"] = "abc1234"; }),
              AllOf(HasSubstr("b.json: build.revision is 'abc1234'; expected 'ffed0c6-dirty', as in "),
                    HasSubstr("a.json")));
  EXPECT_THAT(refusal([](Json& json) { json["build"]["flags"] = "-O2"; }),
              HasSubstr("b.json: build.flags is '-O2'; expected '-O3 -DNDEBUG', as in "));
  EXPECT_THAT(refusal([](Json& json) { json["command"].push_back("--long"); }),
              HasSubstr("b.json: command is 'broadside compare uniform"));
  EXPECT_THAT(refusal([](Json& json) { json["measurements"][2]["boxes"] = 999; }),
              HasSubstr("b.json: case 2 is 'uniform 2D:neighbours=4, 999 boxes"));
  EXPECT_THAT(
      refusal([](Json& json) { json["measurements"].erase(2); }),
      AllOf(HasSubstr("b.json: algorithm 3 of uniform 2D"), HasSubstr("is 'none'; expected 'brute_force (")));
  EXPECT_THAT(refusal([](Json& json) {
                for (Json& measurement : json["measurements"]) measurement["pair_hash"] = "0123456789abcdef";
              }),
              AllOf(HasSubstr("b.json: the number of pairs of uniform"),
                    HasSubstr("hash 0123456789abcdef'; expected '1986, hash 4e83e7ceaec27c04'")));
  EXPECT_THAT(refusal([](Json& json) { json["schema"] = "broadside.results/1"; }),
              HasSubstr("b.json: schema is '\"broadside.results/1\"'; expected \"broadside.results/2\""));
  EXPECT_THAT(refusal([](Json& json) { json = run(1); }), HasSubstr("b.json: holds a run that is in "));
  EXPECT_THAT(refusal([](Json& json) { json["stopped"] = true; }),
              HasSubstr("b.json: stopped is 'true'; expected "));
  EXPECT_THAT(refusal([](Json& json) { json["measurements"][1]["samples_ms"] = nullptr; }),
              HasSubstr("b.json: measurements 2: samples_ms is 'null'; expected the samples"));
  EXPECT_THAT(refusal([](Json& json) { json["measurements"][1]["rounds"] = 7; }),
              HasSubstr("b.json: measurements 2: samples_ms is "));
  EXPECT_THAT(
      refusal([](Json& json) { json["measurements"][0]["samples_ms"][3] = "soon"; }),
      HasSubstr("b.json: measurements 1: samples_ms 4 is '\"soon\"'; expected a number of at least 0"));
}

TEST_F(MergeResults, FailWhatFailedInOneProcess) {
  Json other = run(2);
  Json& grid = other["measurements"][0];
  grid["verified"] = false;
  grid["skipped"] = "grid: frame 0: pair (1, 2) is missing";
  grid["samples_ms"] = nullptr;
  grid["rounds"] = 0;
  const std::vector<std::string> files = {put("a.json", run(1)), put("b.json", other)};
  const Measurement merged = merge_results(files).at(0).comparison.cases.at(0).measurements.at(0);
  EXPECT_EQ(merged.outcome, Outcome::failed);
  EXPECT_TRUE(merged.samples_ms.empty());
  EXPECT_EQ(merged.reason, "grid: frame 0: pair (1, 2) is missing");
}

}  // namespace
}  // namespace broadside::lab

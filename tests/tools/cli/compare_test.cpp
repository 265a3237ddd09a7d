// broadside compare: its table, its JSON, its exit status, and that an interruption leaves nothing behind.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "broadside/algorithm.hpp"

#include "process.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Json = nlohmann::json;

const std::vector<std::string> small = {"compare",      "--scenes", "uniform,lattice", "-n", "200,300",
                                        "--algorithms", "own"};

std::vector<std::string> with(std::vector<std::string> arguments, const std::vector<std::string>& more) {
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(CompareVerb, PrintsALineForEachCaseAndASummary) {
  const Ended ended = run(small);
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, AllOf(testing::StartsWith("case "), HasSubstr("\nuniform, 2D, 200 boxes  "),
                                  HasSubstr("\nlattice, 3D, 300 boxes  "), HasSubstr("  by definition\n"),
                                  HasSubstr("All 8 cases"), HasSubstr("measurements, all verified\n"),
                                  HasSubstr("\ndetails: --details prints each case's table; ")));
  EXPECT_THAT(ended.output, Not(AnyOf(HasSubstr("ns a box"), HasSubstr("\x1b"))));
  EXPECT_THAT(ended.errors, IsEmpty()) << "no progress where there is no terminal";
}

TEST(CompareVerb, PrintsATableForEachCaseWhereDetailsAreAskedFor) {
  const Ended ended = run(with(small, {"--details"}));
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, AllOf(HasSubstr("uniform, 2D, 200 boxes, "),
                                  HasSubstr("lattice, 3D, 300 boxes, "), HasSubstr("verified by definition"),
                                  HasSubstr("All 8 cases"), HasSubstr("measurements, all verified\n")));
}

TEST(CompareVerb, WritesJsonWithAMeasurementForEachLineOfTheTable) {
  const TemporaryFolder folder;
  const Ended ended = run(with(small, {"--json", folder.file("out.json")}));
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out.json"});
  const Json json = Json::parse(text_of(folder.file("out.json")));
  EXPECT_EQ(json["schema"], "broadside.results/2");
  EXPECT_EQ(json["command"][1], "compare");
  const auto own = std::ranges::count(algorithms(), AlgorithmKind::own, &Algorithm::kind);
  EXPECT_EQ(json["measurements"].size(), 8u * static_cast<std::size_t>(own));
  for (const Json& measurement : json["measurements"]) {
    EXPECT_EQ(measurement["verified"], true);
    EXPECT_EQ(measurement["mode"], "find");
    EXPECT_GT(measurement["median_ms"], 0);
  }
}

TEST(CompareVerb, JoinsTwoSets) {
  const TemporaryFolder folder;
  const Ended ended = run(with(small, {"--left", "0.1", "--json", folder.file("out.json")}));
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("\nuniform, 2D, 200 boxes, 10 % joined with 90 %  "));
  const Json json = Json::parse(text_of(folder.file("out.json")));
  for (const Json& measurement : json["measurements"]) EXPECT_EQ(measurement["left"], 0.1);
  EXPECT_THAT(run(with(small, {"--left", "1"})).errors,
              HasSubstr("--left is 1; expected a fraction above 0"));
  EXPECT_THAT(run(with(small, {"--left", "0.5", "--moving", "0.1"})).errors,
              HasSubstr("--left compares boxes at rest"));
}

TEST(CompareVerb, GivesBoxesFilters) {
  const TemporaryFolder folder;
  const std::string all = folder.file("all.json");
  const std::string some = folder.file("some.json");
  ASSERT_EQ(run(with(small, {"--json", all})).status, 0);
  const Ended ended = run(with(small, {"--filtered", "--json", some}));
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("\nuniform, 2D, 200 boxes, filtered  "));
  const Json unfiltered = Json::parse(text_of(all));
  const Json filtered = Json::parse(text_of(some));
  for (std::size_t i = 0; i < filtered["measurements"].size(); ++i) {
    const Json& measurement = filtered["measurements"][i];
    EXPECT_EQ(measurement["filtered"], true);
    EXPECT_EQ(measurement["verified"], true);
    const double share =
        measurement["pairs"].get<double>() / unfiltered["measurements"][i]["pairs"].get<double>();
    EXPECT_GT(share, 0.4);
    EXPECT_LT(share, 0.9);
  }
  EXPECT_THAT(run(with(small, {"--filtered", "--left", "0.5"})).errors, HasSubstr("--left with --filtered"));
  EXPECT_THAT(run(with(small, {"--filtered", "--frames", "5"})).errors,
              HasSubstr("--filtered compares boxes at rest"));
}

TEST(CompareVerb, MeasuresWithColdCaches) {
  const Ended ended = run({"compare", "uniform", "--dimension", "3", "-n", "30k", "--moving", "0,1",
                           "--frames", "2", "--algorithms", "grid", "--cold"});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("measurements, all verified\n"));
}

TEST(CompareVerb, TracksWhatMovesAndReadsNumbersAsPeopleWriteThem) {
  const TemporaryFolder folder;
  const Ended ended =
      run({"compare", "--scenes", "uniform:neighbours=2", "-n", "0.2k", "--moving", "0,0.5", "--frames", "4",
           "--dimension", "3", "--algorithms", "grid:cell=2.5,paper_sweep_and_prune", "--seed", "7", "--json",
           folder.file("out.json")});
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const Json measurements = Json::parse(text_of(folder.file("out.json")))["measurements"];
  ASSERT_EQ(measurements.size(), 4u);
  EXPECT_EQ(measurements[0]["mode"], "find");
  EXPECT_EQ(measurements[0]["seeds"][0], 7);
  EXPECT_EQ(measurements[0]["algorithm"], "grid:cell=2.5");
  EXPECT_EQ(measurements[0]["scene"], "uniform:neighbours=2");
  EXPECT_EQ(measurements[0]["scene_parameters"]["neighbours"], "2");
  EXPECT_EQ(measurements[3]["mode"], "track");
  EXPECT_EQ(measurements[3]["frames"], 4);
  EXPECT_EQ(measurements[3]["moving"], 0.5);
  EXPECT_EQ(measurements[3]["drift"], 0.2);
  EXPECT_GT(measurements[3]["build_ms"], 0);
  EXPECT_LE(measurements[3]["p99_ms"], measurements[3]["max_ms"]);
  EXPECT_EQ(measurements[3]["boxes"], 200);
}

TEST(CompareVerb, ComparesOnAFileThatSceneWrote) {
  const TemporaryFolder folder;
  const std::string file = folder.file("boxes.csv");
  EXPECT_EQ(run({"scene", "lattice", "-n", "100", "-o", file}).status, 0);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"boxes.csv"});
  const Ended ended = run({"compare", "--scenes", file, "--algorithms", "own"});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("boxes.csv, 2D, 100 boxes  "));
}

TEST(CompareVerb, RefusesAFileThatIsNone) {
  const TemporaryFolder folder;
  std::ofstream(folder.file("bad.csv")) << "not,a,number,here\n1,2,3,4\n";
  const Ended ended = run({"compare", "--scenes", folder.file("bad.csv")});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.errors, HasSubstr("bad.csv"));
}

/// Interrupts a comparison that would take minutes once its first case is done.
Ended interrupted(int signal, const std::string& json) {
  Process process({"compare", "--scenes", "uniform", "-n", "200,100k", "--algorithms", "brute_force",
                   "--budget", "600", "--json", json});
  for (int i = 0; i < 600 && process.output().empty(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  process.signal(signal);
  return process.wait();
}

TEST(CompareVerb, WritesTheCasesThatHadEndedWhenItIsInterrupted) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder;
    const Ended ended = interrupted(signal, folder.file("out.json"));
    EXPECT_EQ(ended.status, 130);
    EXPECT_THAT(ended.output, HasSubstr("stopped before the end"));
    EXPECT_THAT(ended.errors, HasSubstr("stopped; wrote the "));
    EXPECT_EQ(folder.names(), std::vector<std::string>{"out.json"});
    const Json json = Json::parse(text_of(folder.file("out.json")));
    EXPECT_EQ(json["stopped"], true);
    EXPECT_GE(json["measurements"].size(), 1u);
  }
}

TEST(CompareVerb, LeavesAnOlderFileAsItWasWhenNoCaseHadEnded) {
  const TemporaryFolder folder;
  const std::string file = folder.put("out.json", "older");
  Process process({"compare", "--scenes", "uniform", "-n", "100k", "--algorithms", "grid,brute_force",
                   "--budget", "600", "--json", file});
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  process.signal(SIGINT);
  const Ended ended = process.wait();
  EXPECT_EQ(ended.status, 130);
  EXPECT_THAT(ended.errors, HasSubstr("nothing is written to"));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out.json"});
  EXPECT_EQ(text_of(file), "older");
}

TEST(CompareVerb, NamesWhatToUseInsteadOfOptionsThatItHadOnce) {
  EXPECT_THAT(run({"compare", "--merge", "1.json"}).errors,
              HasSubstr("'--merge' is no longer there; expected `python3 -m tools.paper compare`"));
  EXPECT_THAT(run({"compare", "uniform", "--samples=s.json"}).errors,
              HasSubstr("'--samples' is no longer there; expected --json"));
}

TEST(CompareVerb, RefusesACheckThatIsNone) {
  EXPECT_THAT(run({"compare", "uniform", "--check", "all"}).errors,
              HasSubstr("--check is 'all'; expected definition= and a number of boxes"));
}

TEST(CompareVerb, TakesItsBoxesFromStandardInput) {
  const Ended ended = shell(
      "$BROADSIDE scene lattice -n 100 --dimension 3 -o - --to trace | "
      "$BROADSIDE compare --scenes - --algorithms own");
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("-, 3D, 100 boxes  "));
}

TEST(SceneVerb, LeavesNothingHalfDoneWheneverItIsInterrupted) {
  for (const int milliseconds : {1, 30, 100, 200, 400}) {
    const TemporaryFolder folder;
    Process process({"scene", "uniform", "-n", "100k", "--moving", "0.1", "--frames", "10", "--dimension",
                     "3", "-o", folder.file("boxes.btrace")});
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    process.signal(SIGINT);
    const Ended ended = process.wait();
    if (folder.names().empty()) {
      EXPECT_EQ(ended.status, 130);
    } else {
      EXPECT_EQ(folder.names(), std::vector<std::string>{"boxes.btrace"});
      EXPECT_THAT(run({"info", folder.file("boxes.btrace")}).output,
                  HasSubstr("100,000 boxes in 3D, as floats, 11 frames"));
    }
  }
}

}  // namespace
}  // namespace broadside::cli

// Reports: the table's shape, the summary's verdict, the JSON's fields.
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lab/measure/paired_ratio.hpp"
#include "lab/report/aligned_columns.hpp"
#include "lab/report/json.hpp"
#include "lab/report/table.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Measurement timed(std::string algorithm, std::vector<double> samples_ms) {
  Measurement measurement;
  measurement.algorithm = std::move(algorithm);
  measurement.version = "0.1.0";
  measurement.outcome = Outcome::verified;
  measurement.evidence = Evidence{true, 3, 2};
  measurement.samples_ms = std::move(samples_ms);
  measurement.pairs = 1'234;
  measurement.pair_hash = 0xfedcba9876543210U;
  measurement.statistics = Statistics{50'000, 10'000};
  measurement.own_bytes = 64'000;
  measurement.peak_bytes = 65'000;
  return measurement;
}

Measurement failed(std::string algorithm) {
  Measurement measurement;
  measurement.algorithm = std::move(algorithm);
  measurement.outcome = Outcome::failed;
  measurement.evidence = Evidence{true, 3, 2};
  measurement.reason = "mine: frame 0, search of seed 1: pair (3, 7) is missing; expected to be reported";
  return measurement;
}

Measurement skipped(std::string algorithm) {
  Measurement measurement;
  measurement.algorithm = std::move(algorithm);
  measurement.reason = "estimated 41.0 s from 20,000 boxes, scaled by n^2.00; budget 10 s";
  measurement.estimated_ms = 41'000;
  return measurement;
}

CaseResult still_case(std::vector<Measurement> measurements) {
  Case of;
  of.scene = "uniform";
  of.parameters = {{"neighbours", "4"}};
  of.seeds = {1, 2};
  of.dimension = 2;
  of.boxes = 10'000;
  CaseResult result{of, std::move(measurements)};
  add_ratios(result);
  return result;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(AlignedColumns, AlignsEachAsItIsToldAndLeavesNoSpaceAtTheEnd) {
  AlignedColumns columns("<>>");
  columns.add({"a", "1", ""});
  columns.add({"bbb", "1,000", "x"});
  EXPECT_EQ(columns.text("  "), "  a        1\n  bbb  1,000  x\n");
  EXPECT_THROW(columns.add({"too few"}), std::invalid_argument);
}

TEST(AlignedColumns, PrintsPartsThatFitEachWithTheFirstColumn) {
  AlignedColumns columns("<>><");
  columns.add({"name", "one", "two", ""});
  columns.add({"a", "1", "22", "skipped: it would take far too long"});
  columns.add_line("others:");
  columns.add({"bb", "1", "2", "verified"});
  EXPECT_EQ(columns.text("  ", 30),
            "  name  one  two\n"
            "  a       1   22\n"
            "  others:\n"
            "  bb      1    2\n"
            "\n"
            "  name\n"
            "  a     skipped: it would take\n"
            "        far too long\n"
            "  others:\n"
            "  bb    verified\n");
}

TEST(Folded, WrapsLongLinesAndIndentsWhatContinuesThem) {
  EXPECT_EQ(folded("  - one two three four\nfive\n\nsix", 14), "  - one two\n    three four\nfive\n\nsix");
  EXPECT_EQ(folded("  a    b    c\n", 13), "  a    b    c\n");
}

TEST(CaseLine, FoldsAllCasesAtTheSameColumns) {
  const CaseResult result = still_case({timed("grid", {1, 1, 1})});
  const auto heading = lines_of(case_line_heading(80));
  const auto lines = lines_of(case_line(result, 80));
  ASSERT_EQ(heading.size(), 3u);
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(heading[0].find("best of ours"), lines[0].find("grid"));
  for (const std::string& line : heading) EXPECT_LE(line.size(), 80u);
  EXPECT_EQ(lines_of(case_line(result)).size(), 1u);
}

TEST(Table, PutsTheFastestFirstAndThoseWithoutATimeLast) {
  const auto lines = lines_of(table_of(still_case(
      {skipped("slow"), timed("second", {8, 9, 10}), failed("wrong"), timed("first", {4, 4.5, 5})})));
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_THAT(lines[0], names("uniform", "2D", "10,000 boxes", "1,234 pairs", "definition"));
  EXPECT_THAT(lines[2], StartsWith("  first "));
  EXPECT_THAT(lines[3], StartsWith("  second "));
  EXPECT_THAT(lines[4], StartsWith("  wrong "));
  EXPECT_THAT(lines[5], StartsWith("  slow "));
}

TEST(Table, ShowsTheIntervalOfARatioOrThatTwoAreLevel) {
  const auto lines = lines_of(
      table_of(still_case({timed("first", {4, 4, 4, 4, 4, 4}), timed("close", {3.9, 4.1, 4.2, 3.8, 4.3, 4.1}),
                           timed("second", {8, 8, 8, 9, 9, 8})})));
  EXPECT_THAT(lines[2], testing::MatchesRegex("  first +4.00 +1.0  - .*"));
  EXPECT_THAT(lines[3], testing::MatchesRegex("  close +4.10 +1.0  level .*"));
  EXPECT_THAT(lines[4], testing::MatchesRegex("  second +8.00 +2.[01]  2.0 to 2.[123] .*"));
}

TEST(Table, EndsWithTheFloorAndCountsInFloors) {
  CaseResult result = still_case({timed("second", {9}), timed("first", {4.5}), failed("wrong")});
  result.floor_ms = {1.4, 1.6, 1.5};
  const auto lines = lines_of(table_of(result));
  ASSERT_EQ(lines.size(), 6u);
  EXPECT_THAT(lines[1], StartsWith("  algorithm    ms  ratio  95 % interval  floors  ns a box "));
  EXPECT_THAT(lines[2], StartsWith("  first      4.50    1.0  -                 3.0       450 "));
  EXPECT_THAT(lines[3], StartsWith("  second     9.00    2.0  -                 6.0       900 "));
  EXPECT_THAT(lines[4], StartsWith("  wrong         -      -  -                   -         - "));
  EXPECT_THAT(lines[5], StartsWith("  the floor  1.50   0.33  -                 1.0       150 "));
  EXPECT_THAT(lines[5], HasSubstr("  1.40..1.60  boxes moved into parts and read back, pairs written"));
}

TEST(Table, EndsWithOurLeadOverTheFastestPeer) {
  CaseResult result =
      still_case({timed("ours", {2}), timed("slower", {3}), timed("theirs", {9}), timed("another", {8})});
  EXPECT_EQ(lines_of(table_of(result)).size(), 6u);
  result.measurements[2].kind = AlgorithmKind::peer;
  result.measurements[3].kind = AlgorithmKind::peer;
  add_ratios(result);
  EXPECT_THAT(lines_of(table_of(result)).back(), names("ours", "4.0 times", "another"));
}

TEST(CaseLine, NamesOurBestAutoTheFastestPeerTheLeadAndTheCheck) {
  CaseResult result = still_case({timed("auto", {2.1, 2.2, 2.1, 2.2, 2.1}), timed("ours", {2, 2, 2, 2, 2}),
                                  timed("theirs", {9, 8, 8, 8, 9}), skipped("slow")});
  result.measurements[2].kind = AlgorithmKind::peer;
  add_ratios(result);
  EXPECT_EQ(case_line(result).find('\n'), case_line(result).size() - 1);
  EXPECT_THAT(case_line(result),
              testing::MatchesRegex("uniform, 2D, 10,000 boxes +ours 2.00 ms +1.1 \\(1.1 to 1.1\\) +"
                                    "theirs 8.00 ms +4.[0-5] \\(4.0 to 4.5\\) +by definition\n"));
  EXPECT_THAT(case_line(still_case({failed("wrong")})), HasSubstr("1 FAILED"));
  EXPECT_THAT(case_line(still_case({skipped("slow")})), HasSubstr("nothing verified"));
}

TEST(Summary, MeansOurLeadsOverTheFastestPeers) {
  Comparison comparison;
  comparison.cases = {still_case({timed("ours", {2}), timed("theirs", {8})}),
                      still_case({timed("ours", {3}), timed("theirs", {3})}),
                      still_case({timed("ours", {1})})};
  for (CaseResult& result : comparison.cases) {
    if (result.measurements.size() > 1) result.measurements[1].kind = AlgorithmKind::peer;
    add_ratios(result);
  }
  EXPECT_THAT(summary_of(comparison), names("2 (2 to 2) times", "fastest peer", "2 cases",
                                            "at least 1 times (uniform, 2D, 10,000 boxes)"));
}

TEST(Table, LabelsAnEstimateAndKeepsTheColumnsAligned) {
  const auto lines = lines_of(table_of(still_case({timed("first", {4.5}), skipped("slow")})));
  EXPECT_THAT(lines[3], HasSubstr(" ~41,000 est.  ~9,100 "));
  EXPECT_THAT(lines[3], names("skipped", "41.0 s", "20,000 boxes", "n^2.00", "budget 10 s"));
  EXPECT_EQ(lines[2].find("4.50") + 4, lines[3].find("41,000") + 6);
  EXPECT_EQ(lines[2].find("1.0 ") + 3, lines[3].find("9,100") + 5);
  EXPECT_EQ(lines[2].find("verified"), lines[3].find("skipped"));
}

TEST(Table, ShowsAFailureAndNoTimeForIt) {
  const std::string table = table_of(still_case({timed("first", {4.5}), failed("wrong")}));
  const std::string line = lines_of(table)[3];
  EXPECT_THAT(line, HasSubstr("FAILED"));
  EXPECT_THAT(line, Not(testing::ContainsRegex("[0-9]")));
}

TEST(Table, TellsOfMotionWhatAMoverCostsAndWhatAPeerTakes) {
  CaseResult result = still_case({timed("ours", {2, 3, 2}), timed("theirs", {8}), timed("others", {4, 4})});
  result.of.mode = Mode::track;
  result.of.frames = 20;
  result.of.moving = 0.1;
  result.measurements[0].build_ms = 7;
  result.measurements[0].explanation = "incremental, since few move";
  result.measurements[1].kind = AlgorithmKind::peer;
  result.measurements[2].kind = AlgorithmKind::peer;
  add_ratios(result);
  const auto lines = lines_of(table_of(result));
  EXPECT_THAT(lines[2], testing::MatchesRegex("  ours +2.00  3.00 +3.00 +1.0  - +0.6[0-9] +2,000 +7.00 .*"));
  EXPECT_THAT(lines[4], testing::MatchesRegex("  theirs +8.00  8.00 +8.00 +4.0  - +2.0 +8,000 +- .*"));
  EXPECT_EQ(lines[5], "  ours: incremental, since few move");
}

TEST(Table, SaysOnceHowMuchAgreesWhereACaseIsCrossChecked) {
  CaseResult result = still_case({timed("grid", {1}), timed("quadtree", {2}), failed("wrong")});
  for (Measurement& measurement : result.measurements) measurement.evidence = Evidence{false, 5, 1};
  EXPECT_THAT(lines_of(table_of(result))[0], names("cross-checked", "5 structures of 1 library"));
  result.measurements[2].evidence = Evidence{true};
  EXPECT_THAT(verdict_of(result), "1 FAILED");
  result.measurements.pop_back();
  EXPECT_EQ(verdict_of(result), "cross-checked by 5 structures of 1 library");
}

TEST(Summary, MeansTheRatiosAndCountsTheWins) {
  Comparison comparison;
  comparison.cases = {still_case({timed("a", {1}), timed("b", {4})}),
                      still_case({timed("a", {9}), timed("b", {1})})};
  const auto lines = lines_of(summary_of(comparison));
  EXPECT_EQ(lines[0], "All 2 cases");
  EXPECT_THAT(lines[2], testing::ContainsRegex("b +2 +1 +2.0"));
  EXPECT_THAT(lines[3], testing::ContainsRegex("a +2 +1 +3.0"));
  EXPECT_EQ(lines.back(), "4 measurements, all verified");
}

TEST(Summary, NamesEveryFailureAndWhatWasSkipped) {
  Comparison comparison;
  comparison.cases = {still_case({timed("a", {1}), failed("wrong"), skipped("slow")})};
  CaseRequest rain;
  rain.scene = "box2d_rain";
  comparison.not_compared.push_back({rain, "unknown scene"});
  const std::string summary = summary_of(comparison);
  EXPECT_THAT(summary, names("not compared: box2d_rain", "2 measurements, 1 FAILED", "1 over the budget",
                             "FAILED: uniform, 2D, 10,000 boxes", "seed 1", "pair (3, 7) is missing"));
}

using Json = nlohmann::ordered_json;

Json parsed(const std::vector<Measurement>& measurements) {
  Comparison comparison;
  comparison.cases = {still_case(measurements)};
  return Json::parse(json_of(comparison, std::vector<std::string>{"broadside", "compare"}));
}

TEST(Summary, SaysHowFarAutoIsFromTheBestOfOurOthers) {
  Comparison comparison;
  comparison.cases = {still_case({timed("auto", {2}), timed("grid", {2}), timed("bvh", {4})}),
                      still_case({timed("auto", {3}), timed("grid", {2})})};
  EXPECT_THAT(summary_of(comparison),
              names("auto", "1.22 (1.22 to 1.22) times", "2 cases", "at most 1.5 times"));
}

TEST(Summary, SaysThatTheMachineWasBusy) {
  Comparison comparison;
  comparison.cases = {still_case({timed("grid", {2})})};
  EXPECT_THAT(summary_of(comparison), Not(HasSubstr("busy")));
  comparison.processor_share = 0.5;
  EXPECT_THAT(summary_of(comparison), names("busy", "50 %"));
}

TEST(JsonResults, HaveEveryFieldOfTheSchemaInItsOrder) {
  const Json json = parsed({timed("grid", {1, 2, 3})});
  EXPECT_EQ(json["schema"], "broadside.results/2");
  EXPECT_EQ(json["command"], (Json{"broadside", "compare"}));
  for (const char* const field : {"cpu", "cores", "memory_bytes", "os"})
    EXPECT_TRUE(json["machine"].contains(field));
  for (const char* const field : {"version", "revision", "compiler", "type", "flags"})
    EXPECT_TRUE(json["build"].contains(field));
  std::vector<std::string> fields;
  for (const auto& item : json["measurements"][0].items()) fields.push_back(item.key());
  EXPECT_THAT(fields, testing::ElementsAre(
                          "scene", "scene_parameters", "seeds", "dimension", "boxes", "frames", "moving",
                          "drift", "teleport", "algorithm", "version", "kind", "mode", "threads", "target",
                          "pairs", "pair_hash", "verified", "verified_by", "agreeing_structures",
                          "agreeing_libraries", "skipped", "estimated_ms", "rounds", "median_ms", "min_ms",
                          "p99_ms", "max_ms", "samples_ms", "unsteady", "build_ms", "ns_per_box",
                          "ns_per_mover", "ratio_to_fastest", "ratio_to_best_own", "ratio_to_fastest_peer",
                          "floor_ms", "tests", "references", "explanation", "own_bytes", "peak_bytes"));
}

TEST(JsonResults, HoldWhatWasMeasured) {
  const Json measurement = parsed({timed("grid:cell=2", {1, 2, 6})})["measurements"][0];
  EXPECT_EQ(measurement["scene_parameters"], (Json{{"neighbours", "4"}}));
  EXPECT_EQ(measurement["seeds"], (Json{1, 2}));
  EXPECT_EQ(measurement["algorithm"], "grid:cell=2");
  EXPECT_EQ(measurement["kind"], "own");
  EXPECT_EQ(measurement["unsteady"], false);
  EXPECT_EQ(measurement["mode"], "find");
  EXPECT_EQ(measurement["pair_hash"], "fedcba9876543210");
  EXPECT_EQ(measurement["verified"], true);
  EXPECT_TRUE(measurement["skipped"].is_null());
  EXPECT_EQ(measurement["rounds"], 3);
  EXPECT_EQ(measurement["median_ms"], 2);
  EXPECT_EQ(measurement["max_ms"], 6);
  EXPECT_EQ(measurement["samples_ms"], (Json{1.0, 2.0, 6.0}));
  EXPECT_EQ(measurement["ns_per_box"], 200);
  EXPECT_EQ(measurement["tests"], 50'000);
}

TEST(JsonResults, HoldHowBoxesMovedAndWhatTheFirstFrameTook) {
  Comparison comparison;
  comparison.cases = {still_case({timed("grid", {1, 2, 6}), timed("bvh", {1})})};
  Case& of = comparison.cases[0].of;
  of.mode = Mode::track;
  of.frames = 3;
  of.moving = 0.1;
  of.drift = 0.2;
  comparison.cases[0].measurements[0].build_ms = 5;
  comparison.cases[0].measurements[0].samples_per_round = 3;
  const Json measurements = Json::parse(json_of(comparison, std::vector<std::string>{}))["measurements"];
  EXPECT_EQ(measurements[0]["mode"], "track");
  EXPECT_EQ(measurements[0]["drift"], 0.2);
  EXPECT_TRUE(measurements[0]["teleport"].is_null());
  EXPECT_EQ(measurements[0]["p99_ms"], 6);
  EXPECT_EQ(measurements[0]["max_ms"], 6);
  EXPECT_EQ(measurements[0]["rounds"], 1);
  EXPECT_EQ(measurements[0]["median_ms"], 3);  // the mean of the round's frames
  EXPECT_EQ(measurements[0]["ns_per_mover"], 3'000);
  EXPECT_EQ(measurements[0]["build_ms"], 5);
  EXPECT_TRUE(measurements[1]["build_ms"].is_null());
}

TEST(JsonResults, HoldRatiosOfTheRoundsThatBothTookPartIn) {
  std::vector<Measurement> entries = {timed("auto", {3, 3, 3, 3, 3, 3}), timed("grid", {2, 2, 2, 2, 2, 2}),
                                      timed("theirs", {8, 8})};
  entries[2].kind = AlgorithmKind::peer;
  const Json json = parsed(entries);
  EXPECT_EQ(json["measurements"][0]["ratio_to_best_own"], (Json{{"of", "grid"},
                                                                {"median", 1.5},
                                                                {"low", 1.5},
                                                                {"high", 1.5},
                                                                {"rounds", 6},
                                                                {"ms", 3},
                                                                {"of_ms", 2}}));
  EXPECT_EQ(json["measurements"][0]["ratio_to_fastest_peer"]["median"], 3.0 / 8);
  EXPECT_EQ(json["measurements"][2]["ratio_to_fastest"], (Json{{"of", "grid"},
                                                               {"median", 4.0},
                                                               {"low", nullptr},
                                                               {"high", nullptr},
                                                               {"rounds", 2},
                                                               {"ms", 8},
                                                               {"of_ms", 2}}));
}

TEST(JsonResults, SayHowMuchOfAProcessorTheRunHad) {
  Comparison comparison;
  comparison.processor_share = 0.5;
  const Json json = Json::parse(json_of(comparison, std::vector<std::string>{}));
  EXPECT_EQ(json["processor_share"], 0.5);
  EXPECT_EQ(json["busy"], true);
}

TEST(JsonResults, HaveTheFloorOfTheCaseInEachMeasurement) {
  Comparison comparison;
  comparison.cases = {still_case({timed("grid", {4}), failed("wrong")}), still_case({timed("grid", {4})})};
  comparison.cases[0].floor_ms = {3, 1, 2};
  const Json json = Json::parse(json_of(comparison, std::vector<std::string>{}));
  EXPECT_EQ(json["measurements"][0]["floor_ms"], 2);
  EXPECT_EQ(json["measurements"][1]["floor_ms"], 2);
  EXPECT_TRUE(json["measurements"][2]["floor_ms"].is_null());
}

TEST(JsonResults, SayWhyThereIsNoTimeAndLeaveNullWhatIsNotKnown) {
  const Json json = parsed({failed("wrong"), skipped("slow")});
  const Json& wrong = json["measurements"][0];
  EXPECT_EQ(wrong["verified"], false);
  EXPECT_THAT(wrong["skipped"].get<std::string>(), HasSubstr("pair (3, 7) is missing"));
  const Json& slow = json["measurements"][1];
  EXPECT_TRUE(slow["verified"].is_null());
  EXPECT_TRUE(slow["verified_by"].is_null());
  EXPECT_THAT(slow["skipped"].get<std::string>(), HasSubstr("estimated 41.0 s"));
  for (const char* const field :
       {"median_ms", "samples_ms", "unsteady", "ns_per_box", "pairs", "pair_hash", "own_bytes", "tests"})
    EXPECT_TRUE(slow[field].is_null()) << field;
}

TEST(JsonResults, StandTextThatIsNotUtf8) {
  Comparison comparison;
  comparison.cases = {still_case({timed("grid", {1})})};
  comparison.cases[0].of.scene = "caf\xe9.csv";
  EXPECT_TRUE(Json::accept(json_of(comparison, std::vector<std::string>{"caf\xe9"})));
}

}  // namespace
}  // namespace broadside::lab

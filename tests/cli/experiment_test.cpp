// broadside experiment: its list, its findings, its JSON, what it refuses, and that an interruption leaves
// nothing behind.
#include "paper/experiments/experiment.hpp"

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "process.hpp"
#include "refusal.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using OrderedJson = nlohmann::ordered_json;

/// Results of experiment 1, small and made by hand, in the schema's fewest words.
OrderedJson results() {
  const OrderedJson columns = {{{"name", "boxes"}, {"unit", ""}},
                               {{"name", "all pairs"}, {"unit", ""}},
                               {{"name", "unique pairs"}, {"unit", ""}},
                               {{"name", "tests"}, {"unit", ""}},
                               {{"name", "time"}, {"unit", "ms"}}};
  const OrderedJson table = {
      {"name", "tests"},
      {"title", "Tests"},
      {"columns", columns},
      {"charts", OrderedJson::array()},
      {"rows", {{1'000, 1'000'000, 499'500, 499'500, 1}, {2'000, 4'000'000, 1'999'000, 1'999'000, 4}}}};
  const OrderedJson experiment = {
      {"name", "brute_force_tests"}, {"seconds", 1}, {"tables", OrderedJson::array({table})}};
  return {{"schema", "broadside.experiments/2"},
          {"machine", OrderedJson::object()},
          {"build", OrderedJson::object()},
          {"target", "AVX2"},
          {"date", "2026-11-21"},
          {"command", {"broadside", "experiment"}},
          {"quick", false},
          {"stopped", false},
          {"experiments", OrderedJson::array({experiment})}};
}

TEST(ExperimentVerb, ListsEveryExperimentWithoutMeasuring) {
  const Ended ended = run({"experiment", "--list"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(ended.errors, IsEmpty());
  for (const lab::Experiment& experiment : lab::experiments())
    EXPECT_THAT(ended.output, AllOf(HasSubstr(experiment.name), HasSubstr(experiment.title),
                                    HasSubstr(experiment.is_own() ? "(our own claim)"
                                                                  : "(section " + experiment.section + ")")));
}

TEST(ExperimentVerb, MeasuresWhatIsNamedAndWritesWhatCanBeJudgedAgain) {
  const TemporaryFolder folder;
  // By name and by number: the same one, once.
  const Ended ended =
      run({"experiment", "--quick", "1", "brute_force_tests", "--json", folder.file("out.json")});
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.errors, IsEmpty());
  EXPECT_THAT(ended.output, AllOf(HasSubstr("Claim: To test all pairs"), HasSubstr("Verdict 1a, n items"),
                                  HasSubstr("not testable: a tautology"), HasSubstr("1 experiment in "),
                                  Not(HasSubstr("\x1b"))));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out.json"});
  const OrderedJson json = OrderedJson::parse(text_of(folder.file("out.json")));
  EXPECT_EQ(json["schema"], "broadside.experiments/2");
  EXPECT_EQ(json["command"][1], "experiment");
  EXPECT_EQ(json["quick"], true);
  EXPECT_EQ(json["stopped"], false);
  ASSERT_EQ(json["experiments"].size(), 1u);
  EXPECT_EQ(json["experiments"][0]["statements"][0]["verdict"], "not testable");
  EXPECT_GT(json["experiments"][0]["steadiness"]["measurements"], 0);
  EXPECT_NEAR(json["experiments"][0]["figures"]["share_of_all_pairs"]["value"].get<double>(), 0.5, 0.01);

  const Ended again =
      run({"experiment", "--from", folder.file("out.json"), "--json", folder.file("again.json")});
  EXPECT_EQ(again.status, 0) << again.errors;
  EXPECT_EQ(again.output, ended.output);
  EXPECT_EQ(text_of(folder.file("again.json")), text_of(folder.file("out.json")));
}

TEST(ExperimentVerb, JudgesAFileByItsTables) {
  const TemporaryFolder folder;
  OrderedJson json = results();
  const std::string whole = folder.put("whole.json", json.dump());
  const Ended as_measured = run({"experiment", "--from", whole});
  EXPECT_EQ(as_measured.status, 0) << as_measured.errors;
  EXPECT_THAT(as_measured.output,
              AllOf(HasSubstr("quadratic: confirmed.\n2 of 2 numbers"), HasSubstr("not testable: a")));
  json["experiments"][0]["tables"][0]["rows"][1][3] = 4'000'000;
  const Ended refuted = run({"experiment", "--from", folder.put("altered.json", json.dump())});
  EXPECT_EQ(refuted.status, 0) << refuted.errors;
  EXPECT_THAT(refuted.output, AllOf(HasSubstr("unique: refuted.\n"), HasSubstr("1 of 2 numbers")));
}

TEST(ExperimentVerb, JudgesStandardInputAsItDoesAFile) {
  const TemporaryFolder folder;
  OrderedJson json = results();
  // More than a pipe holds at once.
  json["build"]["flags"] = std::string(1 << 20, 'x');
  const std::string whole = folder.put("whole.json", json.dump());
  const Ended judged = run({"experiment", "--from", whole, "--json", folder.file("a.json")});
  for (const std::string& line : {"cat " + whole + " | $BROADSIDE experiment --from - --json ",
                                  "$BROADSIDE experiment --from - < " + whole + " --json "}) {
    const Ended ended = shell(line + folder.file("b.json"));
    EXPECT_EQ(ended.status, 0) << ended.errors;
    EXPECT_THAT(ended.output, AllOf(HasSubstr("2 of 2 numbers"), judged.output));
    EXPECT_TRUE(text_of(folder.file("b.json")) == text_of(folder.file("a.json")));
  }
  for (const auto& [line, part] :
       {std::pair("head -c 300 " + whole + " | $BROADSIDE experiment --from -", "expected JSON"),
        std::pair(std::string("$BROADSIDE experiment --from - < /dev/null"), "expected JSON"),
        std::pair(std::string("$BROADSIDE experiment --from - <&-"), "expected results of experiments"),
        std::pair("$BROADSIDE experiment winners --from - < " + whole, "no results of winners")}) {
    const Ended ended = shell(line);
    EXPECT_EQ(ended.status, 2) << line;
    EXPECT_THAT(ended.output, IsEmpty());
    EXPECT_THAT(ended.errors, AllOf(HasSubstr("standard input: "), HasSubstr(part)));
  }
}

TEST(ExperimentVerb, RefusesNamesAndFilesThatItCannotUse) {
  const TemporaryFolder folder;
  const std::string whole = folder.put("whole.json", results().dump());
  const auto put = [&](const std::string& name, auto change) {
    OrderedJson json = results();
    change(json);
    return folder.put(name, json.dump());
  };
  const std::string empty = folder.put("empty.json", "");
  const std::string half = folder.put("half.json", results().dump().substr(0, 300));
  const std::string none =
      put("none.json", [](OrderedJson& json) { json["experiments"] = OrderedJson::array(); });
  const std::string other =
      put("other.json", [](OrderedJson& json) { json["schema"] = "broadside.results/1"; });
  const std::string unknown =
      put("unknown.json", [](OrderedJson& json) { json["experiments"][0]["name"] = "phlogiston"; });
  const std::string no_number = put(
      "null.json", [](OrderedJson& json) { json["experiments"][0]["tables"][0]["rows"][0][4] = nullptr; });
  std::string text = results().dump();
  text.replace(text.find("499500"), 6, "NaN");
  const std::string nan = folder.put("nan.json", text);
  expect_refused("experiment",
                 {{{"phlogiston"}, {"no experiment 'phlogiston'", "1 brute_force_tests", "B1 winners"}},
                  {{"1", "15"}, {"no experiment '15'"}},
                  {{"--from", folder.file("nothing.json")}, {"nothing.json", "cannot be read", "expected"}},
                  {{"--from", folder.file(".")}, {"cannot be read", "expected"}},
                  {{"--from", whole, "winners"}, {"whole.json", "no results of winners"}},
                  {{"--from", whole, "--json", whole}, {"--json", "whole.json"}},
                  {{"--from", whole, "--json", folder.file("no/out.json")}, {"--json"}},
                  {{"--from", empty}, {"empty.json", "expected JSON"}},
                  {{"--from", half}, {"half.json", "expected JSON"}},
                  {{"--from", none}, {"none.json", "0 experiments", "at least one"}},
                  {{"--from", other}, {"other.json", "'broadside.results/1'", "'broadside.experiments/2'"}},
                  {{"--from", unknown}, {"unknown.json", "'phlogiston'", "brute_force_tests"}},
                  {{"--from", no_number}, {"null.json", "'brute_force_tests'", "expected"}},
                  {{"--from", nan}, {"nan.json", "expected JSON"}},
                  {{"--frames", "3"}, {"--frames"}}});
}

TEST(ExperimentVerb, KeepsAnOlderFileWhereItIsInterruptedBeforeAnExperimentHasEnded) {
  const TemporaryFolder folder;
  const std::string file = folder.put("out.json", "older");
  Process process({"experiment", "winners", "--json", file});
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  process.signal(SIGINT);
  const Ended ended = process.wait();
  EXPECT_EQ(ended.status, 130) << ended.errors;
  EXPECT_THAT(ended.errors, HasSubstr("nothing is written to"));
  EXPECT_EQ(folder.names(), std::vector<std::string>{"out.json"});
  EXPECT_EQ(text_of(file), "older");
}

TEST(ExperimentVerb, WritesWhatHadEndedWhereItIsInterrupted) {
  const TemporaryFolder folder;
  const std::string file = folder.file("out.json");
  Process process({"experiment", "--quick", "1", "winners", "--json", file});
  for (int i = 0; i < 6'000 && process.output().find("Verdict 1a") == std::string::npos; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  process.signal(SIGTERM);
  const Ended ended = process.wait();
  EXPECT_EQ(ended.status, 130) << ended.errors;
  EXPECT_THAT(ended.errors, HasSubstr("wrote the 1 experiment that had ended to"));
  EXPECT_THAT(ended.output, HasSubstr("stopped before the end"));
  const OrderedJson json = OrderedJson::parse(text_of(file));
  EXPECT_EQ(json["stopped"], true);
  EXPECT_EQ(json["experiments"].size(), 1u);
  EXPECT_EQ(run({"experiment", "--from", file}).status, 0);
}

}  // namespace
}  // namespace broadside::cli

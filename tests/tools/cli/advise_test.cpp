// broadside advise: what it prints and writes, of which inputs, and what it refuses.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "process.hpp"
#include "refusal.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::json;
using testing::IsEmpty;
using testing::Not;

std::vector<std::string> quickly(const std::string& input, const std::vector<std::string>& more = {}) {
  std::vector<std::string> arguments = {"advise", input, "--allow-busy", "--budget", "0.05"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

std::string boxes_csv(const TemporaryFolder& folder) {
  return folder.put("boxes.csv", "min_x,min_y,max_x,max_y\n0,0,1,1\n0.5,0.5,2,2\n5,5,6,6.1\n");
}

TEST(AdviseVerb, PrintsSignalsRankingAdviceReasonsAndCode) {
  const TemporaryFolder folder;
  const Ended ended = run(quickly(boxes_csv(folder)));
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.errors, IsEmpty());
  EXPECT_THAT(ended.output,
              AllOf(HasSubstr("3 boxes in 2D, as doubles."), HasSubstr("A box overlaps 0.667 others"),
                    HasSubstr("brute_force"), HasSubstr("verified"), HasSubstr("\nAdvice: "),
                    HasSubstr("verified by definition\n"), HasSubstr("\nWhy\n  - "),
                    HasSubstr("const std::vector<broadside::DoubleBox2>& boxes")));
}

TEST(AdviseVerb, TakesARecordingOfAnEngine) {
  const TemporaryFolder folder;
  const std::string file = folder.file("churn.btrace");
  ASSERT_EQ(run({"scene", "churn", "-n", "60", "--frames", "12", "-o", file}).status, 0);
  const Ended ended = run(quickly(file));
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, AllOf(HasSubstr("In 12 frames after the first, "),
                                  HasSubstr("a frame to be expected"), HasSubstr("p99"),
                                  HasSubstr("auto:update=rebuild"), HasSubstr("broadside::World2 world(\"")));
}

TEST(AdviseVerb, WritesAllOfItAsJson) {
  const TemporaryFolder folder;
  const Ended ended = run(quickly(boxes_csv(folder), {"--json", folder.file("out.json")}));
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const Json json = Json::parse(text_of(folder.file("out.json")));
  EXPECT_EQ(json["schema"], "broadside.advice/2");
  EXPECT_EQ(json["command"][1], "advise");
  EXPECT_EQ(json["mode"], "find");
  EXPECT_EQ(json["signals"]["boxes"], 3);
  EXPECT_EQ(json["signals"]["precision"], "double");
  EXPECT_TRUE(json["signals"]["motion"].is_null());
  EXPECT_GT(json["processor_share"], 0);
  EXPECT_EQ(json["busy"], json["processor_share"] < 0.9);
  EXPECT_EQ(json["busy"], ended.output.starts_with("busy: others had the processor for "));
  const std::string spec = json["advice"]["spec"];
  EXPECT_THAT(ended.output, HasSubstr("\nAdvice: " + spec + "\n"));
  EXPECT_THAT(json["advice"]["snippet"].get<std::string>(), HasSubstr("\"" + spec + "\""));
  EXPECT_GT(json["advice"]["time_ms"], 0);
  EXPECT_FALSE(json["advice"]["reasons"].empty());
  for (const Json& measurement : json["ranking"]) {
    EXPECT_EQ(measurement["verified"], true);
    EXPECT_EQ(measurement["pairs"], 1);
    EXPECT_EQ(measurement["verified_by"], "by definition");
  }
}

TEST(AdviseVerb, TakesNoBoxesAndOneBox) {
  const TemporaryFolder folder;
  for (const std::string rows : {"", "0,0,1,1\n"}) {
    const Ended ended = run(quickly(folder.put("few.csv", "min_x,min_y,max_x,max_y\n" + rows)));
    EXPECT_EQ(ended.status, 0) << ended.errors;
    EXPECT_THAT(ended.output, AllOf(HasSubstr("\nAdvice: auto\n"), HasSubstr("fewer than two boxes")));
  }
}

TEST(AdviseVerb, ReadsStandardInputAndRoundsWhereAsked) {
  const TemporaryFolder folder;
  const Ended ended = shell("cat " + boxes_csv(folder) +
                            " | $BROADSIDE advise - --allow-busy --budget 0.05 --precision float");
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, AllOf(HasSubstr("standard input: 3 boxes in 2D, as floats."),
                                  HasSubstr("std::vector<broadside::Box2>&")));
}

TEST(AdviseVerb, TakesScenesAndSetsBoxesMoving) {
  const Ended still = run(quickly("uniform:neighbours=2", {"-n", "200", "--dimension", "3"}));
  EXPECT_EQ(still.status, 0) << still.errors;
  EXPECT_THAT(still.output, HasSubstr("uniform:neighbours=2: 200 boxes in 3D, as floats."));
  const Ended moving = run(quickly("uniform", {"-n", "200", "--moving", "0.5", "--frames", "4"}));
  EXPECT_EQ(moving.status, 0) << moving.errors;
  EXPECT_THAT(moving.output, HasSubstr("In 4 frames after the first, 50 % of the boxes move"));
  const TemporaryFolder folder;
  const Ended file = run(quickly(boxes_csv(folder), {"--frames", "3", "--moving", "1"}));
  EXPECT_EQ(file.status, 0) << file.errors;
  EXPECT_THAT(file.output, AllOf(HasSubstr("as floats"), HasSubstr("In 3 frames")));
}

TEST(AdviseVerb, ComparesWithOthersWhereAsked) {
  const TemporaryFolder folder;
  const Ended ended = run(quickly(boxes_csv(folder), {"--algorithms", "auto,paper_brute_force"}));
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, AllOf(HasSubstr("paper_brute_force"), Not(HasSubstr("quadtree"))));
}

TEST(AdviseVerb, EndsWithOneWhereNothingIsVerified) {
  // 3D is beyond the paper's grid.
  const Ended ended = run(quickly("uniform", {"-n", "50", "--dimension", "3", "--algorithms", "paper_grid"}));
  EXPECT_EQ(ended.status, 1) << ended.errors;
  EXPECT_THAT(ended.output, AllOf(HasSubstr("does not support 3D"), HasSubstr("nothing to advise")));
}

TEST(AdviseVerb, RefusesWhatItCannotUse) {
  const TemporaryFolder folder;
  const std::string boxes = boxes_csv(folder);
  const std::string moving =
      folder.put("moving.csv", "frame,box,min_x,min_y,max_x,max_y\n0,0,0,0,1,1\n1,0,1,1,2,2\n");
  expect_refused("advise", {{{}, {"input"}},
                            {{"nothing"}, {"unknown scene 'nothing'", "expected"}},
                            {{folder.file("missing.csv")}, {"missing.csv", "No such file"}},
                            {{folder.put("empty.csv", "")}, {"empty.csv"}},
                            {{folder.put("nan.csv", "min_x,min_y,max_x,max_y\n0,0,nan,1\n")}, {"nan.csv:2"}},
                            {{boxes, "--algorithms", "gird"}, {"unknown algorithm 'gird'"}},
                            // Which a build without peers says of the empty group.
                            {{boxes, "--algorithms", "peers"}, {"'peers'", "expected one"}},
                            {{boxes, "--budget", "0"}, {"--budget is 0", "above 0"}},
                            {{boxes, "--budget", "nan"}, {"--budget is nan"}},
                            {{boxes, "-n", "5"}, {"-n", "boxes.csv"}},
                            {{"uniform", "-n", "0"}, {"-n is '0'"}},
                            {{"uniform", "--precision", "double"}, {"--precision", "uniform"}},
                            {{"uniform", "--dimension", "4"}, {"--dimension is 4"}},
                            {{"uniform", "--moving", "2"}, {"--moving is 2"}},
                            {{boxes, "--threads", "much"}, {"--threads"}},
                            {{moving, "--moving", "0.5"}, {"--moving", "moving.csv", "move already"}},
                            {{boxes, "--json", boxes}, {"--json", "another file"}},
                            {{boxes, "--json", "/nowhere/out.json"}, {"/nowhere"}}});
}

}  // namespace
}  // namespace broadside::cli

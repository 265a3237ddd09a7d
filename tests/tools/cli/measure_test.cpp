// broadside measure: the JSON of a list of cases, what it refuses before it measures, and how it is
// interrupted.
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "broadside/executor.hpp"

#include "process.hpp"
#include "refusal.hpp"

namespace broadside::cli {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using Json = nlohmann::ordered_json;

Json a_case(const std::string& name) {
  return {{"name", name}, {"scene", "uniform"}, {"boxes", 300}, {"specs", {"paper_grid", "grid"}}};
}

Json list_of(std::vector<Json> cases) {
  return {{"schema", "broadside.cases/1"},
          {"effort", {{"share_seconds", 0.001}, {"min_rounds", 2}, {"max_rounds", 4}}},
          {"cases", std::move(cases)}};
}

TEST(MeasureVerb, WritesEverySampleWithTheMachineTheBuildAndTheLoad) {
  const TemporaryFolder folder;
  Json counted = a_case("counted");
  counted["take"] = {"counts"};
  Json moving = a_case("moving");
  moving["specs"] = {"paper_quadtree:update=siblings"};
  moving["frames"] = 2;
  moving["moving"] = 0.1;
  moving["take"] = {"phases"};
  const std::string list = folder.put("list.json", list_of({a_case("still"), counted, moving}).dump());
  const Ended ended = run({"measure", list, "--json", folder.file("out.json")});
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.errors, IsEmpty());
  EXPECT_THAT(ended.output, HasSubstr("3 cases in "));

  const Json json = Json::parse(text_of(folder.file("out.json")));
  EXPECT_EQ(json["schema"], "broadside.results/2");
  EXPECT_EQ(json["command"][1], "measure");
  EXPECT_GT(json["load_before"], 0);
  EXPECT_GT(json["load_after"], 0);
  EXPECT_FALSE(json["machine"]["cpu"].is_null());
  EXPECT_TRUE(json["machine"]["caches"].is_object());
  EXPECT_FALSE(json["build"]["flags"].is_null());
  ASSERT_EQ(json["measurements"].size(), 5u);
  for (const Json& measurement : json["measurements"]) {
    EXPECT_EQ(measurement["verified"], true);
    const std::size_t frames = measurement["case"] == "moving" ? 2 : 1;
    EXPECT_EQ(measurement["samples_ms"].size(), frames * measurement["rounds"].get<std::size_t>());
    EXPECT_EQ(measurement["tests_by_seed"].size(), measurement["seeds"].size());
    EXPECT_EQ(measurement.contains("phases"), measurement["case"] == "moving");
  }
  const Json& frames = json["measurements"][4];
  EXPECT_EQ(frames["phases"]["mending_ms"].size(), frames["samples_ms"].size());
  EXPECT_EQ(frames["phases"]["movers"][0], 30);
}

TEST(MeasureVerb, KnowsThePlainSearchesByNameBesideTheLibrarys) {
  const TemporaryFolder folder;
  Json plain = a_case("plain");
  const std::string held = "held_back:search=bvh:simd=" + instruction_sets().back();
  plain["specs"] = {"own", "plain_grid:carry=no", "plain_bvh", held};
  const Ended ended =
      run({"measure", folder.put("list.json", list_of({plain}).dump()), "--json", folder.file("out.json")});
  ASSERT_EQ(ended.status, 0) << ended.errors;
  std::vector<std::string> specs;
  const Json json = Json::parse(text_of(folder.file("out.json")));
  for (const Json& measurement : json["measurements"]) {
    specs.push_back(measurement["algorithm"]);
    EXPECT_EQ(measurement["verified"], true) << specs.back();
  }
  EXPECT_THAT(specs, testing::Contains("plain_grid:carry=no"));
  EXPECT_THAT(specs, testing::Contains(held));
  EXPECT_THAT(specs, Not(testing::Contains("plain_grid"))) << "a group has none of them";
}

TEST(MeasureVerb, RefusesABadListBeforeAnythingRuns) {
  const TemporaryFolder folder;
  Json slow = a_case("slow");  // would take minutes
  slow["boxes"] = 3'000'000;
  Json bad = a_case("bad");
  bad["specs"] = {"grid:cell=none"};
  const std::string list = folder.put("list.json", list_of({slow, bad}).dump());
  const std::string good = folder.put("good.json", list_of({a_case("still")}).dump());
  const std::string out = folder.file("out.json");
  expect_refused("measure",
                 {{{list, "--json", out}, {"list.json", "cases 2 'bad': specs 1: ", "cell", "none"}},
                  {{list}, {"--json"}},
                  {{folder.file("none.json"), "--json", out}, {"none.json", "cannot be read"}},
                  {{good, "--json", good}, {"--json", "good.json"}},
                  {{good, "--json", "-"}, {"--json"}},
                  {{good, "--json", folder.file("no/out.json")}, {"--json"}}});
  EXPECT_THAT(folder.names(), Not(testing::Contains("out.json")));
}

TEST(MeasureVerb, ChecksAListWithoutMeasuring) {
  const TemporaryFolder folder;
  Json slow = a_case("slow");
  slow["boxes"] = 3'000'000;
  const Ended ended = run({"measure", folder.put("list.json", list_of({slow}).dump()), "--check"});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_EQ(ended.output, "1 case\n");
}

TEST(MeasureVerb, WritesNothingWhereItIsInterrupted) {
  const TemporaryFolder folder;
  Json slow = a_case("slow");
  slow["boxes"] = 1'000'000;
  slow["effort"] = {{"budget_seconds", 1000}, {"share_seconds", 1000}, {"max_rounds", 100'000}};
  const std::string out = folder.put("out.json", "older");
  Process process({"measure", folder.put("list.json", list_of({slow}).dump()), "--json", out});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  process.signal(SIGINT);
  const Ended ended = process.wait();
  EXPECT_EQ(ended.status, 130) << ended.errors;
  EXPECT_THAT(ended.errors, HasSubstr("nothing is written to"));
  EXPECT_EQ(text_of(out), "older");
}

TEST(MeasureVerb, IsForProgramsAndNotAmongTheVerbsOfTheHelp) {
  EXPECT_THAT(run({"--help"}).output, Not(HasSubstr("measure ")));
  EXPECT_THAT(run({"measure", "--help"}).output, HasSubstr("list of cases"));
}

}  // namespace
}  // namespace broadside::cli

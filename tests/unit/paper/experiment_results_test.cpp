// Results of experiments: written as JSON and read back, and every way in which a file is none.
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lab/formats/format.hpp"
#include "paper/experiments/results.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::ordered_json;

/// The tables of experiment 1, with a text, an empty cell and every field of a chart in them.
std::vector<Table> tables() {
  Table table{.name = "tests",
              .title = "Tests \"and\" time",
              .columns = {{"boxes"}, {"all pairs"}, {"unique pairs"}, {"tests"}, {"time", "ms"}, {"note"}},
              .charts = {{.title = "A chart",
                          .kind = ChartKind::map,
                          .x = "boxes",
                          .y = "time",
                          .series = "note",
                          .value = "note",
                          .log_x = true,
                          .log_y = true,
                          .where = {{"note", "few"}}}}};
  table.add({10.0, 100.0, 45.0, 45.0, 0.125, "few"});
  table.add({1'000.0, 1e6, 499'500.0, 499'500.0, 1'250.5, {}});
  return {table};
}

ExperimentResults results() {
  const Experiment& experiment = find_experiment("brute_force_tests");
  return {
      .machine = {.cpu = "A processor", .cores = 2, .memory_bytes = 1'000, .os = "An os"},
      .build = {.version = "1.2.3", .revision = "abc", .compiler = "GNU", .type = "Release", .flags = "-O3"},
      .target = "AVX2",
      .date = "2026-11-21",
      .command = {"broadside", "experiment", "1"},
      .quick = true,
      .stopped = true,
      .results = {{&experiment, tables(), judged(experiment, tables()), 1.5}}};
}

std::string refusal(const std::string& text) {
  return message_of<FileError>([&] { read_experiments(text, "x.json"); });
}

/// What is said of these results after a change.
template <typename Change>
std::string refusal_after(Change change) {
  Json json = Json::parse(json_of(results()));
  change(json);
  return refusal(json.dump());
}

Json& first(Json& json) { return json["experiments"][0]; }
Json& table(Json& json) { return first(json)["tables"][0]; }

TEST(ExperimentResults, AreReadBackAsTheyWereWritten) {
  const ExperimentResults written = results();
  const ExperimentResults read = read_experiments(json_of(written), "x.json");
  EXPECT_EQ(json_of(read), json_of(written));
  EXPECT_EQ(read.machine.cpu, "A processor");
  EXPECT_EQ(read.build.revision, "abc");
  EXPECT_EQ(read.target, "AVX2");
  EXPECT_EQ(read.date, "2026-11-21");
  EXPECT_EQ(read.command, written.command);
  EXPECT_TRUE(read.quick);
  EXPECT_TRUE(read.stopped);
  ASSERT_EQ(read.results.size(), 1u);
  EXPECT_EQ(read.results[0].experiment, &find_experiment("1"));
  EXPECT_EQ(read.results[0].tables, tables());
  EXPECT_EQ(read.results[0].finding, written.results[0].finding);
  EXPECT_EQ(read.results[0].seconds, 1.5);
}

TEST(ExperimentResults, SayHowManyMeasurementsWereUnsteadyWhereThatIsKnown) {
  ExperimentResults results_of_before = results();
  EXPECT_THAT(json_of(results_of_before), Not(HasSubstr("steadi")));
  EXPECT_EQ(read_experiments(json_of(results_of_before), "x.json").results[0].steadiness, std::nullopt);
  EXPECT_THAT(summary_of(results_of_before), Not(HasSubstr("unsteady")));

  ExperimentResults written = results();
  written.results[0].steadiness = Steadiness{7, 0};
  EXPECT_THAT(summary_of(written), Not(HasSubstr("unsteady")));
  written.results[0].steadiness = Steadiness{7, 2};
  const ExperimentResults read = read_experiments(json_of(written), "x.json");
  EXPECT_EQ(read.results[0].steadiness, (Steadiness{7, 2}));
  EXPECT_THAT(summary_of(read),
              AllOf(HasSubstr("\nunsteady: 2 of 7 measurements, "), HasSubstr(", without --quick for")));

  const auto refused = [&](const Json& count) {
    return refusal_after([&](Json& json) {
      first(json)["steadiness"] = {{"measurements", 7}, {"unsteady", count}};
    });
  };
  for (const Json& count : {Json(-1), Json(1.5), Json("two"), Json(nullptr)})
    EXPECT_THAT(refused(count), AllOf(HasSubstr("steadiness, unsteady: " + count.dump()),
                                      HasSubstr("expected a whole number from 0")));
}

TEST(ExperimentResults, SayWhetherTheMachineWasBusyWhereThatIsKnown) {
  EXPECT_THAT(json_of(results()), Not(HasSubstr("busy")));
  EXPECT_EQ(read_experiments(json_of(results()), "x.json").processor_share, std::nullopt);

  ExperimentResults written = results();
  written.processor_share = 0.58;
  EXPECT_EQ(Json::parse(json_of(written))["busy"], true);
  const ExperimentResults read = read_experiments(json_of(written), "x.json");
  EXPECT_EQ(read.processor_share, 0.58);
  EXPECT_EQ(json_of(read), json_of(written));
  written.processor_share = 0.99;
  EXPECT_EQ(Json::parse(json_of(written))["busy"], false);

  EXPECT_THAT(refusal_after([](Json& json) { json["processor_share"] = "all"; }),
              HasSubstr("processor_share: \"all\"; expected a number"));
}

TEST(ExperimentResults, AreJudgedAnewWhenTheyAreRead) {
  Json json = Json::parse(json_of(results()));
  ASSERT_EQ(first(json)["statements"][0]["verdict"], "not testable");
  table(json)["rows"][1][3] = 7;
  const ExperimentResults read = read_experiments(json.dump(), "x.json");
  EXPECT_EQ(read.results[0].finding.statements[0].verdict, Verdict::refuted);
}

TEST(ExperimentResults, AreRefusedWhereTheyAreNoJson) {
  const std::string whole = json_of(results());
  for (const std::string& text : {std::string(), std::string("boxes"), std::string("\0\xff", 2),
                                  whole.substr(0, whole.size() / 2), whole.substr(0, whole.size() - 3)})
    EXPECT_THAT(refusal(text),
                AllOf(HasSubstr("x.json"), HasSubstr("expected JSON as broadside experiment")));
  for (const std::string& text : {std::string("[]"), std::string("7"), std::string("null")})
    EXPECT_THAT(refusal(text), AllOf(HasSubstr("x.json: " + text), HasSubstr("expected an object")));
}

TEST(ExperimentResults, AreRefusedAtEveryLengthButTheWhole) {
  const std::string whole = json_of(results());
  ASSERT_TRUE(whole.ends_with("}\n"));
  for (std::size_t length = 0; length + 2 < whole.size(); length += 7)
    EXPECT_THROW(read_experiments(whole.substr(0, length), "x.json"), FileError) << length;
}

TEST(ExperimentResults, AreRefusedWhereTheyAreOfAnotherSchema) {
  EXPECT_THAT(refusal_after([](Json& json) { json["schema"] = "broadside.results/1"; }),
              AllOf(HasSubstr("'broadside.results/1'"), HasSubstr("expected 'broadside.experiments/2'")));
  EXPECT_THAT(refusal_after([](Json& json) { json["schema"] = "broadside.experiments/3"; }),
              HasSubstr("'broadside.experiments/3'"));
  EXPECT_THAT(refusal_after([](Json& json) { json.erase("schema"); }), HasSubstr("no 'schema'"));
  EXPECT_THAT(refusal_after([](Json& json) { json["schema"] = 1; }), HasSubstr("schema: 1"));
}

TEST(ExperimentResults, AreRefusedWhereThereAreNone) {
  EXPECT_THAT(refusal_after([](Json& json) { json["experiments"] = Json::array(); }),
              AllOf(HasSubstr("0 experiments"), HasSubstr("at least one")));
  EXPECT_THAT(refusal_after([](Json& json) { json.erase("experiments"); }), HasSubstr("no 'experiments'"));
  EXPECT_THAT(refusal_after([](Json& json) { json["experiments"] = 7; }), HasSubstr("expected a list"));
}

TEST(ExperimentResults, AreRefusedWithAnExperimentThatThereIsNotOrTwice) {
  EXPECT_THAT(refusal_after([](Json& json) { first(json)["name"] = "phlogiston"; }),
              AllOf(HasSubstr("'phlogiston'"), HasSubstr("brute_force_tests")));
  EXPECT_THAT(refusal_after([](Json& json) { json["experiments"].push_back(first(json)); }),
              AllOf(HasSubstr("'brute_force_tests' twice")));
  EXPECT_THAT(refusal_after([](Json& json) { first(json) = "brute_force_tests"; }), HasSubstr("an object"));
}

TEST(ExperimentResults, AreRefusedWithACellThatIsNoFiniteNumberTextOrNull) {
  const std::string whole = json_of(results());
  const std::size_t at = whole.find("0.125");
  ASSERT_NE(at, std::string::npos);
  for (const char* const number : {"NaN", "Infinity", "1e999", "-1e999", "0x7", "1.2.3"}) {
    std::string text = whole;
    EXPECT_THAT(refusal(text.replace(at, 5, number)), HasSubstr("x.json")) << number;
  }
  for (const char* const number : {"true", "[]", "{}"}) {
    std::string text = whole;
    EXPECT_THAT(refusal(text.replace(at, 5, number)),
                AllOf(HasSubstr("experiment 'brute_force_tests'"), HasSubstr("table 'tests', row 1"),
                      HasSubstr("column 'time'"), HasSubstr(number), HasSubstr("a finite number")));
  }
}

TEST(ExperimentResults, AreRefusedWhereTheirTablesAreNotWhatTheExperimentJudgesBy) {
  // A null or a text where numbers are needed, too few rows, another table, a column that is missing.
  EXPECT_THAT(refusal_after([](Json& json) {
                for (Json& row : table(json)["rows"]) row[4] = nullptr;
              }),
              HasSubstr("experiment 'brute_force_tests'"));
  EXPECT_THAT(refusal_after([](Json& json) {
                for (Json& row : table(json)["rows"]) row[4] = "1 ms";
              }),
              HasSubstr("experiment 'brute_force_tests'"));
  EXPECT_THAT(refusal_after([](Json& json) { table(json)["rows"][0][4] = "1 ms"; }),
              AllOf(HasSubstr("column 'time'"), HasSubstr("the text '1 ms'"), HasSubstr("expected either")));
  EXPECT_THAT(refusal_after([](Json& json) { table(json)["rows"].erase(0); }), HasSubstr("points"));
  EXPECT_THAT(refusal_after([](Json& json) { table(json)["name"] = "others"; }), HasSubstr("'tests'"));
  EXPECT_THAT(refusal_after([](Json& json) { first(json)["tables"] = Json::array(); }), HasSubstr("'tests'"));
  EXPECT_THAT(refusal_after([](Json& json) { table(json)["columns"][3]["name"] = "tries"; }),
              AllOf(HasSubstr("'tests'"), HasSubstr("tries")));
}

TEST(ExperimentResults, AreRefusedWithTablesThatDoNotFitTogether) {
  EXPECT_THAT(refusal_after([](Json& json) { table(json)["rows"][1].erase(0); }),
              AllOf(HasSubstr("row 2"), HasSubstr("5 cells"), HasSubstr("expected 6")));
  EXPECT_THAT(refusal_after([](Json& json) { table(json)["rows"][1] = "few"; }),
              AllOf(HasSubstr("row 2"), HasSubstr("expected 6")));
  EXPECT_THAT(refusal_after([](Json& json) { first(json)["tables"].push_back(table(json)); }),
              HasSubstr("table 'tests' twice"));
  EXPECT_THAT(refusal_after([](Json& json) { table(json)["columns"][5]["name"] = "time"; }),
              HasSubstr("column 'time' twice"));
  EXPECT_THAT(refusal_after([](Json& json) { table(json)["columns"] = 7; }), HasSubstr("expected a list"));
}

TEST(ExperimentResults, AreRefusedWithChartsThatCannotBeDrawn) {
  const auto chart = [](Json& json) -> Json& { return table(json)["charts"][0]; };
  EXPECT_THAT(refusal_after([&](Json& json) { chart(json)["kind"] = "pie"; }),
              AllOf(HasSubstr("table 'tests', charts"), HasSubstr("pie"), HasSubstr("lines, bars or map")));
  for (const char* const key : {"x", "y", "series", "value"})
    EXPECT_THAT(refusal_after([&](Json& json) { chart(json)[key] = "weight"; }),
                AllOf(HasSubstr("chart 'A chart'"), HasSubstr("'weight'")))
        << key;
  EXPECT_THAT(refusal_after([&](Json& json) { chart(json)["where"][0][0] = "weight"; }),
              HasSubstr("'weight'"));
  EXPECT_THAT(refusal_after([&](Json& json) { chart(json)["where"] = "all"; }), HasSubstr("column and text"));
  EXPECT_THAT(refusal_after([&](Json& json) { chart(json)["log_x"] = 1; }), HasSubstr("true or false"));
}

TEST(ExperimentResults, AreRefusedWithAnyFieldMissingOrOfAnotherKind) {
  const Json whole = Json::parse(json_of(results()));
  for (const auto& item : whole.items()) {
    const std::string key = item.key();
    EXPECT_THAT(refusal_after([&](Json& json) { json.erase(key); }), HasSubstr("no '" + key + "'"));
    EXPECT_THAT(refusal_after([&](Json& json) { json[key] = 7; }), HasSubstr("expected ")) << key;
  }
  for (const char* const key : {"name", "seconds", "tables"})
    EXPECT_THAT(refusal_after([&](Json& json) { first(json).erase(key); }),
                HasSubstr(std::string("no '") + key + "'"));
  for (const char* const key : {"name", "title", "columns", "charts", "rows"})
    EXPECT_THAT(refusal_after([&](Json& json) { table(json).erase(key); }),
                HasSubstr(std::string("no '") + key + "'"));
  EXPECT_THAT(refusal_after([&](Json& json) { first(json)["seconds"] = true; }), HasSubstr("seconds: true"));
  EXPECT_THAT(refusal_after([&](Json& json) { json["machine"]["cores"] = "two"; }), HasSubstr("machine"));
  EXPECT_THAT(refusal_after([&](Json& json) { json["build"]["flags"] = 7; }), HasSubstr("build"));
}

/// What is said of a finding.
std::string refusal_of(const std::vector<Statement>& statements, const std::vector<Figure>& figures = {}) {
  Experiment experiment = find_experiment("1");
  experiment.judge = [&](const std::vector<Table>&) {
    return Finding{.statements = statements, .reason = "", .figures = figures};
  };
  return message_of<std::invalid_argument>([&] { judged(experiment, {}); });
}

Statement statement(Verdict verdict, const std::string& condition = "") {
  return {.name = "a", .text = "", .verdict = verdict, .condition = condition};
}

TEST(ExperimentResults, HaveFindingsWithFiniteFiguresOfDifferentNames) {
  Experiment experiment = find_experiment("1");
  const auto with = [](const std::vector<Figure>& figures) {
    return refusal_of({statement(Verdict::confirmed)}, figures);
  };
  EXPECT_THAT(with({{"growth", 0.0 / 0.0}}), AllOf(HasSubstr("'growth'"), HasSubstr("finite")));
  EXPECT_THAT(with({{"growth", 1, "", Interval{0, 1 / 0.0}}}),
              AllOf(HasSubstr("'growth'"), HasSubstr("finite")));
  experiment.judge = [](const std::vector<Table>& none) { return Finding{.reason = none.at(0).name}; };
  EXPECT_THAT(message_of<std::invalid_argument>([&] { judged(experiment, {}); }), HasSubstr("too few rows"));
  EXPECT_THAT(with({{"growth", 1}, {"share", 1}, {"growth", 2}}), HasSubstr("'growth' twice"));
}

TEST(ExperimentResults, HaveStatementsWithAConditionWhereTheirVerdictHasOneAndEvidenceThatIsThere) {
  EXPECT_THAT(refusal_of({}), HasSubstr("no statement"));
  EXPECT_THAT(refusal_of({statement(Verdict::refuted), statement(Verdict::confirmed)}),
              HasSubstr("'a' twice"));
  for (const Verdict verdict : {Verdict::within_bounds, Verdict::not_testable})
    EXPECT_THAT(refusal_of({statement(verdict)}),
                AllOf(HasSubstr("'a' is " + std::string(name(verdict))), HasSubstr("expected one")));
  for (const Verdict verdict : {Verdict::confirmed, Verdict::refuted})
    EXPECT_THAT(refusal_of({statement(verdict, "if")}), HasSubstr("expected none"));
  Statement unfounded = statement(Verdict::refuted);
  unfounded.evidence = {"growth"};
  EXPECT_THAT(refusal_of({unfounded}),
              AllOf(HasSubstr("the figure 'growth'"), HasSubstr("expected one that")));
}

}  // namespace
}  // namespace broadside::lab

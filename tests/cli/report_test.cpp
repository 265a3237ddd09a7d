// The page that --report writes.
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lab/report/page.hpp"
#include "process.hpp"
#include "refusal.hpp"

namespace broadside::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

class Report : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string missing = lab::page_missing(); !missing.empty()) GTEST_SKIP() << missing;
  }

  /// What stands in the page as its document.
  static nlohmann::json document_of(const std::string& page) {
    const std::string open = R"(id="document">)";
    const std::size_t begin = page.find(open);
    if (begin == std::string::npos) return {};
    const std::size_t first = begin + open.size();
    return nlohmann::json::parse(page.substr(first, page.find("</script>", first) - first), nullptr, false);
  }

  const TemporaryFolder folder_;
  const std::string page_ = folder_.file("page.html");
};

/// Results of one experiment, of which a little is given.
std::string experiments_json(const std::string& rows) {
  return R"({"schema": "broadside.experiments/2", "machine": {}, "build": {"version": "0", "compiler": "c"},
    "target": "AVX2", "date": "2026-11-21", "command": ["broadside"], "quick": true, "stopped": false,
    "experiments": [{"name": "brute_force_tests", "seconds": 1, "tables": [{"name": "tests", "title": "Tests",
    "columns": [{"name": "boxes", "unit": ""}, {"name": "all pairs", "unit": ""}, {"name": "unique pairs", "unit": ""},
    {"name": "tests", "unit": ""}, {"name": "time", "unit": "ms"}], "charts": [], "rows": [)" +
         rows + "]}]}]}";
}

TEST_F(Report, OfAComparisonHoldsItsResults) {
  const std::string json = folder_.file("results.json");
  const Ended ended = run({"compare", "--scenes", "uniform", "-n", "50", "--dimension", "2", "--algorithms",
                           "grid,bvh", "--json", json, "--report", page_});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  const nlohmann::json document = document_of(text_of(page_));
  ASSERT_TRUE(document.is_object());
  EXPECT_EQ(document["comparison"], nlohmann::json::parse(text_of(json)));
  EXPECT_EQ(document["experiments"], nullptr);
  EXPECT_EQ(document["date"].get<std::string>().size(), 10u);
  EXPECT_THAT(folder_.names(), testing::UnorderedElementsAre("page.html", "results.json"));
}

TEST_F(Report, OfExperimentsHoldsWhatTheyCameTo) {
  const std::string results =
      folder_.put("results.json",
                  experiments_json("[100, 10000, 4950, 4950, 0.1], [1000, 1000000, 499500, 499500, 9.5]"));
  const Ended ended = run({"experiment", "--from", results, "--report", page_});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  const nlohmann::json document = document_of(text_of(page_));
  ASSERT_TRUE(document.is_object());
  EXPECT_EQ(document["comparison"], nullptr);
  EXPECT_EQ(document["date"], "2026-11-21");
  EXPECT_EQ(document["experiments"]["experiments"][0]["statements"][0]["verdict"], "not testable");
}

TEST_F(Report, CannotBeEndedByWhatItQuotes) {
  const std::string scene = folder_.put("<script>alert(1)<!--.csv", "0,0,1,1\n0,0,2,2\n");
  const Ended ended = run({"compare", "--scenes", scene, "--algorithms", "grid", "--report", page_});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  const std::string page = text_of(page_);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert(1)")));
  const nlohmann::json document = document_of(page);
  ASSERT_TRUE(document.is_object());
  EXPECT_THAT(document["comparison"]["measurements"][0]["scene"].get<std::string>(),
              HasSubstr("<script>alert(1)<!--"));
}

TEST_F(Report, AsksNothingOfANetwork) {
  const lab::PageContent content{.date = "2026-11-21", .comparison = {}, .experiments = {}, .drawings = {}};
  EXPECT_THAT(lab::page_of(content), HasSubstr("default-src 'none'"));
}

TEST_F(Report, IsAnotherFileThanTheResults) {
  const std::string results = folder_.put("results.json", experiments_json("[10, 100, 45, 45, 0.1]"));
  const std::string same = folder_.file("./page.html");
  expect_refused("compare",
                 {{{"--report", "/nowhere/page.html"}, {"--report is '/nowhere/page.html'", "/nowhere"}},
                  {{"--report", page_, "--json", same}, {"--report is", "--json", "expected two files"}}});
  expect_refused("experiment",
                 {{{"--from", results, "--report", results}, {"--report is", "expected another file"}},
                  {{"--report", page_, "--json", same}, {"--report is", "expected two files"}}});
  EXPECT_THAT(folder_.names(), testing::ElementsAre("results.json"));
}

TEST_F(Report, IsNotTouchedWhereResultsCannotBeRead) {
  const std::string results = folder_.put("results.json", "{\"schema\": \"broadside.experiments/3\"}");
  folder_.put("page.html", "as it was");
  const Ended ended = run({"experiment", "--from", results, "--report", page_});
  EXPECT_NE(ended.status, 0);
  EXPECT_THAT(ended.errors, HasSubstr("broadside.experiments/3"));
  EXPECT_EQ(text_of(page_), "as it was");
}

TEST(ReportHelp, NamesTheOption) {
  EXPECT_THAT(run({"compare", "--help"}).output, HasSubstr("--report"));
  EXPECT_THAT(run({"experiment", "--help"}).output, HasSubstr("--report"));
}

TEST(ResultFiles, AreNotWrittenAmongTheTables) {
  expect_refused("compare", {{{"--json", "-"}, {"--json is '-'", "expected a file"}},
                             {{"--report", "-"}, {"--report is '-'", "expected a file"}}});
  expect_refused("experiment", {{{"--json", "-"}, {"--json is '-'", "expected a file"}}});
  expect_refused("advise", {{{"uniform", "--json", "-"}, {"--json is '-'", "expected a file"}}});
}

}  // namespace
}  // namespace broadside::cli

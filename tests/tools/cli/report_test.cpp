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

TEST_F(Report, OfAComparisonHoldsItsResults) {
  const std::string json = folder_.file("results.json");
  const Ended ended = run({"compare", "--scenes", "uniform", "-n", "50", "--dimension", "2", "--algorithms",
                           "grid,bvh", "--json", json, "--report", page_});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  const nlohmann::json document = document_of(text_of(page_));
  ASSERT_TRUE(document.is_object());
  EXPECT_EQ(document["comparison"], nlohmann::json::parse(text_of(json)));
  EXPECT_EQ(document["date"].get<std::string>().size(), 10u);
  EXPECT_THAT(folder_.names(), testing::UnorderedElementsAre("page.html", "results.json"));
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
  const lab::PageContent content{.date = "2026-11-21", .comparison = "null", .drawings = "[]"};
  EXPECT_THAT(lab::page_of(content), HasSubstr("default-src 'none'"));
}

TEST_F(Report, IsAnotherFileThanTheResults) {
  const std::string same = folder_.file("./page.html");
  expect_refused("compare",
                 {{{"--report", "/nowhere/page.html"}, {"--report is '/nowhere/page.html'", "/nowhere"}},
                  {{"--report", page_, "--json", same}, {"--report is", "--json", "expected two files"}}});
  EXPECT_THAT(folder_.names(), testing::IsEmpty());
}

TEST(ReportHelp, NamesTheOption) { EXPECT_THAT(run({"compare", "--help"}).output, HasSubstr("--report")); }

TEST(ResultFiles, AreNotWrittenAmongTheTables) {
  expect_refused("compare", {{{"--json", "-"}, {"--json is '-'", "expected a file"}},
                             {{"--report", "-"}, {"--report is '-'", "expected a file"}}});
  expect_refused("advise", {{{"uniform", "--json", "-"}, {"--json is '-'", "expected a file"}}});
}

}  // namespace
}  // namespace broadside::cli

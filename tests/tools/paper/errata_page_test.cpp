// docs/paper/errata.md, the listings, the tests and the paper's templates speak of the same errata.
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/text_of.hpp"

namespace broadside::paper {
namespace {

namespace fs = std::filesystem;

const fs::path project = BROADSIDE_SOURCE_DIR;

/// Each match of a pattern's first group.
std::vector<std::string> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern, std::regex::multiline);
  std::vector<std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), regex), end; match != end; ++match)
    found.push_back((*match)[1]);
  return found;
}

/// "3b", "T7": what is an erratum's number wherever it stands.
std::vector<std::string> numbers_in(const std::string& text) {
  return matches(text, "(?:^|[^A-Za-z0-9_.])((?:10|[1-9])[a-i]|T[1-9][0-9]?)(?![A-Za-z0-9_-])");
}

std::string page() { return broadside::text_of(project / "docs" / "paper" / "errata.md"); }

/// The numbers in the page's table, each in one of the three classes.
std::set<std::string> classified() {
  std::set<std::string> numbers;
  for (const std::string& cell : matches(page(), R"(^\| ([^|]+) \| [^|]+ \| (?:error|gap|hardening) \|)")) {
    for (const std::string& number : numbers_in(cell))
      EXPECT_TRUE(numbers.insert(number).second) << number << " twice";
  }
  return numbers;
}

/// The text of each entry, by its numbers.
std::map<std::string, std::string> entries() {
  const std::string text = page();
  const std::regex heading(R"((?:^|\n)\*\*([0-9a-iT, ]+)\.\*\*|\n## )");
  std::map<std::string, std::string> found;
  for (std::sregex_iterator match(text.begin(), text.end(), heading), end; match != end;) {
    const std::string numbers = (*match)[1];
    const auto begin = static_cast<std::size_t>(match->position());
    ++match;
    const auto next = match == end ? text.size() : static_cast<std::size_t>(match->position());
    for (const std::string& number : numbers_in(numbers)) found[number] = text.substr(begin, next - begin);
  }
  return found;
}

TEST(ErrataPage, HasAClassAndAnEntryForEachErratum) {
  std::set<std::string> described;
  for (const auto& [number, text] : entries()) described.insert(number);
  EXPECT_EQ(described, classified());
  EXPECT_GT(described.size(), 50U);
}

TEST(ErrataPage, HasATestForEachErratumThatCanBeRun) {
  std::set<std::string> tested;
  for (const fs::directory_entry& entry : fs::directory_iterator(project / "tests" / "tools" / "paper")) {
    for (const std::string& number : matches(broadside::text_of(entry.path()), R"(^TEST\(Erratum(\w+),)"))
      tested.insert(number);
  }
  for (const std::string& number : tested) EXPECT_TRUE(entries().contains(number)) << number;
  const std::regex none(R"(No\s+test|test\s+is\s+that\s+of|tests\s+are\s+those\s+of)");
  for (const auto& [number, text] : entries())
    EXPECT_NE(tested.contains(number), std::regex_search(text, none)) << number;
}

TEST(ErrataPage, IsWhatTheListingsAndThePaperReferTo) {
  const std::set<std::string> known = classified();
  std::size_t cited = 0;
  for (const char* const folder : {"tools/paper/listings", "tools/paper/templates/sections"}) {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(project / folder)) {
      if (!entry.is_regular_file()) continue;
      // The paper also cites statements of the draft, which have numbers of their own.
      for (const std::string& words : matches(broadside::text_of(entry.path()), "((?://|[Ee]rrat).*)$")) {
        for (const std::string& number : numbers_in(words)) {
          EXPECT_TRUE(known.contains(number)) << entry.path() << ": " << number;
          ++cited;
        }
      }
    }
  }
  EXPECT_GT(cited, 50U);
}

}  // namespace
}  // namespace broadside::paper

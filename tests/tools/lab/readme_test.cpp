// The README's code is what examples/quick_start compiles and ctest runs.
#include <algorithm>
#include <cctype>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/text_of.hpp"

namespace broadside {
namespace {

/// The formatter is free to change white space.
std::string without_space(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
  return text;
}

TEST(Readme, ShowsCodeThatRuns) {
  const std::string readme = project_text("README.md");
  const std::size_t begin = readme.find("```cpp\n");
  ASSERT_NE(begin, std::string::npos);
  std::istringstream code(readme.substr(begin + 7, readme.find("```\n", begin + 7) - begin - 7));
  const std::string example = without_space(project_text("examples/quick_start/main.cpp"));
  std::size_t lines = 0;
  for (std::string line; std::getline(code, line);) {
    EXPECT_NE(example.find(without_space(line)), std::string::npos) << line;
    ++lines;
  }
  EXPECT_GT(lines, 5u);
}

/// CI's first checks, before anything else is built, are what a visitor types first.
TEST(Readme, BeginsWithTheCommandsThatContinuousIntegrationBeginsWith) {
  const std::string readme = project_text("README.md");
  const std::size_t begin = readme.find("```\nmake ");
  ASSERT_NE(begin, std::string::npos);
  std::istringstream commands(readme.substr(begin + 4, readme.find("```\n", begin + 4) - begin - 4));
  std::istringstream script(project_text(".ci/run"));
  std::size_t count = 0;
  for (std::string command; std::getline(commands, command); ++count) {
    std::string check;
    while (std::getline(script, check) && !check.starts_with("check ")) {
    }
    EXPECT_EQ(check, "check " + command);
  }
  EXPECT_EQ(count, 2U);
}

}  // namespace
}  // namespace broadside

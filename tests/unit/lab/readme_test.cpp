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

}  // namespace
}  // namespace broadside

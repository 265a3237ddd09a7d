// The README's code is what examples/quick_start compiles and ctest runs.
#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

namespace broadside {
namespace {

/// The text of a file of the project.
std::string text_of(const std::string& path) {
  std::ifstream file(BROADSIDE_SOURCE_DIR + ("/" + path));
  EXPECT_TRUE(file.is_open()) << path;
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The formatter is free to change white space.
std::string without_space(std::string text) {
  std::erase_if(text, [](unsigned char c) { return std::isspace(c) != 0; });
  return text;
}

TEST(Readme, ShowsCodeThatRuns) {
  const std::string readme = text_of("README.md");
  const std::size_t begin = readme.find("```cpp\n");
  ASSERT_NE(begin, std::string::npos);
  std::istringstream code(readme.substr(begin + 7, readme.find("```\n", begin + 7) - begin - 7));
  const std::string example = without_space(text_of("examples/quick_start/main.cpp"));
  std::size_t lines = 0;
  for (std::string line; std::getline(code, line);) {
    EXPECT_NE(example.find(without_space(line)), std::string::npos) << line;
    ++lines;
  }
  EXPECT_GT(lines, 5u);
}

}  // namespace
}  // namespace broadside

// Links in the pages lead to files.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include <gtest/gtest.h>

namespace broadside {
namespace {

TEST(Pages, LinkToFilesThatExist) {
  const std::regex link(R"re(\]\(([^)#\s:]+)[)#])re");  // an address has a colon
  std::size_t links = 0;
  for (const char* const folder : {"", "docs", "docs/paper", "examples/own_algorithm"}) {
    const std::filesystem::path in = std::filesystem::path(BROADSIDE_SOURCE_DIR) / folder;
    for (const auto& entry : std::filesystem::directory_iterator(in)) {
      if (entry.path().extension() != ".md") continue;
      std::ifstream file(entry.path());
      const std::string text{std::istreambuf_iterator<char>(file), {}};
      for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match, ++links)
        EXPECT_TRUE(std::filesystem::exists(in / (*match)[1].str())) << entry.path() << ": " << (*match)[1];
    }
  }
  EXPECT_GT(links, 50U);
}

}  // namespace
}  // namespace broadside

// Links in the pages lead to files, but for those to what make builds.
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
      for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match, ++links) {
        const std::string to = (*match)[1].str();
        if (to.starts_with("../build/")) continue;
        EXPECT_TRUE(std::filesystem::exists(in / to)) << entry.path() << ": " << to;
      }
    }
  }
  EXPECT_GT(links, 50U);
}

}  // namespace
}  // namespace broadside

// Links in the pages lead to what is in the repository: not to what make builds, nor to what else lies beside
// it.
#include <cstdio>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/text_of.hpp"

namespace broadside {
namespace {

/// What git has, from the root: files and their folders. Empty where this is no clone.
std::set<std::string> tracked_paths() {
  std::set<std::string> paths;
  const std::string command = "git -c safe.directory='*' -C '" BROADSIDE_SOURCE_DIR "' ls-files 2>/dev/null";
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return paths;
  std::string lines;
  for (int c = std::getc(pipe); c != EOF; c = std::getc(pipe)) lines += static_cast<char>(c);
  pclose(pipe);
  std::istringstream stream(lines);
  for (std::string line; std::getline(stream, line);) {
    for (std::filesystem::path path = line; !path.empty(); path = path.parent_path())
      paths.insert(path.generic_string());
  }
  return paths;
}

TEST(Pages, LinkToFilesOfTheRepository) {
  const std::set<std::string> tracked = tracked_paths();
  if (tracked.empty()) GTEST_SKIP() << "git lists no files of " BROADSIDE_SOURCE_DIR;
  const std::regex link(R"re(\]\(([^)#\s:]+)[)#])re");  // an address has a colon
  std::size_t links = 0;
  for (const std::string& page : tracked) {
    // The paper's templates become pages elsewhere: docs/paper/ has their links.
    if ((!page.ends_with(".md") && !page.ends_with(".ipynb")) || page.starts_with("tools/paper/templates/"))
      continue;
    const std::string text = project_text(page);
    for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match, ++links) {
      std::string to =
          (std::filesystem::path(page).parent_path() / (*match)[1].str()).lexically_normal().generic_string();
      if (to.ends_with('/')) to.pop_back();
      EXPECT_TRUE(tracked.contains(to)) << page << ": " << (*match)[1].str();
    }
  }
  EXPECT_GT(links, 200U);
}

}  // namespace
}  // namespace broadside

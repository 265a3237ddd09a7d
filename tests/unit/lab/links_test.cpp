// Links in the pages lead to what is in the repository: not to what make builds, nor to what else lies beside
// it.
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/text_of.hpp"

namespace broadside {
namespace {

namespace fs = std::filesystem;

const fs::path root = fs::path(BROADSIDE_SOURCE_DIR).lexically_normal();

/// The paths that .gitignore names from the root: "build/", "web/node_modules/".
std::vector<std::string> ignored_paths() {
  std::vector<std::string> paths;
  std::istringstream lines(project_text(".gitignore"));
  for (std::string line; std::getline(lines, line);)
    if (line.starts_with('/')) paths.push_back(line.substr(1));
  return paths;
}

/// Whether a path from the root is in the repository, as git sees it.
bool is_in_repository(const std::string& path, const std::vector<std::string>& ignored) {
  if (path.starts_with("..")) return false;
  for (const std::string& one : ignored)
    if ((path + '/').starts_with(one)) return false;
  return fs::exists(root / path);
}

TEST(Pages, LinkToFilesOfTheRepository) {
  const std::vector<std::string> ignored = ignored_paths();
  ASSERT_FALSE(is_in_repository("build/playground/index.html", ignored));
  ASSERT_FALSE(is_in_repository("../README.md", ignored));
  const std::regex link(R"re(\]\(([^)#\s:]+)[)#])re");  // an address has a colon
  std::size_t links = 0;
  for (auto entry = fs::recursive_directory_iterator(root); entry != fs::recursive_directory_iterator();
       ++entry) {
    const std::string path = entry->path().lexically_relative(root).generic_string();
    // The paper's templates become pages elsewhere: docs/paper/ has their links.
    if (path.starts_with('.') || path == "paper/templates" || !is_in_repository(path, ignored)) {
      entry.disable_recursion_pending();
      continue;
    }
    if (entry->path().extension() != ".md" && entry->path().extension() != ".ipynb") continue;
    const std::string text = text_of(entry->path());
    for (std::sregex_iterator match(text.begin(), text.end(), link), end; match != end; ++match, ++links) {
      const fs::path to = (fs::path(path).parent_path() / (*match)[1].str()).lexically_normal();
      EXPECT_TRUE(is_in_repository(to.generic_string(), ignored)) << path << ": " << (*match)[1].str();
    }
  }
  EXPECT_GT(links, 300U);
}

}  // namespace
}  // namespace broadside

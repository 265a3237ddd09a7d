// docs/algorithms.md tells of every algorithm that the library has, with its tunables and a picture.
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"

#include "tests/support/text_of.hpp"

namespace broadside {
namespace {

using testing::HasSubstr;

const std::filesystem::path docs = BROADSIDE_SOURCE_DIR "/docs";

/// What the page says under an algorithm's heading.
std::string section_of(const std::string& name) {
  const std::string page = project_text("docs/algorithms.md");
  const std::size_t begin = page.find("\n## " + name + "\n");
  if (begin == std::string::npos) return {};
  return page.substr(begin, page.find("\n## ", begin + 1) - begin);
}

TEST(AlgorithmsPage, TellsOfEveryAlgorithmAndItsTunables) {
  for (const Algorithm& algorithm : algorithms()) {
    const std::string section = section_of(algorithm.name);
    if (section.empty()) {
      ADD_FAILURE() << "docs/algorithms.md has no section '## " << algorithm.name << "'";
      continue;
    }
    for (const std::string part : {"**Cost:**", "**Tunables:**", "**Take it**", "**Not**", "**Sources:**"})
      EXPECT_THAT(section, HasSubstr(part)) << algorithm.name;
    for (const Tunable& tunable : algorithm.tunables) {
      EXPECT_THAT(section, HasSubstr("`" + tunable.name + "`")) << algorithm.name;
      // The value that leaves it to the algorithm needs no words.
      for (const std::string& choice : tunable.choices) {
        if (choice.size() > 1 && choice != "auto") {
          EXPECT_THAT(section, HasSubstr("`" + choice + "`")) << algorithm.name << ": " << tunable.name;
        }
      }
    }
    if (algorithm.kind == AlgorithmKind::own) {
      EXPECT_THAT(section, HasSubstr("**Moving boxes:**")) << algorithm.name;
    }
  }
}

TEST(AlgorithmsPage, ShowsAPictureOfEachThatIsThereAndNotLarge) {
  for (const Algorithm& algorithm : algorithms()) {
    const std::string picture = "pictures/" + algorithm.name + ".svg";
    EXPECT_THAT(section_of(algorithm.name), HasSubstr("](" + picture + ")"));
    ASSERT_TRUE(std::filesystem::exists(docs / picture)) << picture;
    EXPECT_LT(std::filesystem::file_size(docs / picture), 60'000U) << picture;
  }
}

}  // namespace
}  // namespace broadside

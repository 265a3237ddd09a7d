// make pictures: the pictures of docs/algorithms.md are what the program draws, byte for byte.
#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"

namespace broadside::cli {
namespace {

TEST(Pictures, AreWhatTheProgramDraws) {
  const std::string source = BROADSIDE_SOURCE_DIR;
  const TemporaryFolder folder;
  const Ended ended = shell(source + "/tools/docs/pictures \"$BROADSIDE\" " + folder.file(""));
  ASSERT_EQ(ended.status, 0) << ended.errors;
  std::size_t committed = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source + "/docs/pictures")) {
    if (entry.path().extension() == ".gif") continue;  // a film of the playground: `make film`
    ++committed;
    // Not EXPECT_EQ, which would print both pictures.
    EXPECT_TRUE(text_of(entry.path()) == text_of(folder.file(entry.path().filename())))
        << entry.path().filename() << " is not what the program draws; `make pictures` draws it anew";
  }
  EXPECT_EQ(folder.names().size(), committed);
}

}  // namespace
}  // namespace broadside::cli

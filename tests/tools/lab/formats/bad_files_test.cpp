// Bad input: every reader refuses every fault by name and place, and no writer leaves half a file behind.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include "lab/formats/format.hpp"
#include "lab/measure/memory.hpp"
#include "tests/support/boxes.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// What the fuzzers have found: all that can be wrong with a file of each format. The number of bytes is
/// small.
TEST_F(Files, OfTheFuzzersAreReadOrRefusedByNameInLittleMemory) {
  const std::filesystem::path all = BROADSIDE_SOURCE_DIR "/tests/fuzz/corpus";
  std::size_t refused = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(all)) {
    const std::string folder = entry.path().parent_path().filename();
    const bool is_mesh = folder == "obj" || folder == "ply";
    const std::string format = is_mesh ? "mesh" : folder == "compressed" ? "csv" : folder;
    const auto it = std::ranges::find(formats(), format, &Format::name);
    if (!entry.is_regular_file() || it == formats().end() || !it->missing.empty()) continue;
    ReadOptions options;
    options.format = format;
    const std::string text = refusal(entry.path(), options);
    if (text == "was read") continue;
    ++refused;
    EXPECT_THAT(text, HasSubstr("expected"));
  }
  EXPECT_GT(refused, 50U);
}

/// Tests of every format by its extension.
class BadPlace : public Files, public testing::WithParamInterface<std::string> {
 protected:
  std::string extension() const { return GetParam(); }
};

TEST_P(BadPlace, IsRefusedWhereThereIsNoFile) {
  EXPECT_THAT(refusal(path("none" + extension())),
              AllOf(HasSubstr("none" + extension()), HasSubstr("No such file")));
}

TEST_P(BadPlace, IsRefusedWhereItIsAFolder) {
  std::filesystem::create_directory(path("folder" + extension()));
  EXPECT_THAT(refusal(path("folder" + extension())),
              AllOf(HasSubstr("folder" + extension()), HasSubstr("Is a directory")));
}

TEST_P(BadPlace, IsRefusedWhereReadingIsForbidden) {
  if (geteuid() == 0) GTEST_SKIP() << "root may read everything";
  const std::filesystem::path file = put("secret" + extension(), "1");
  std::filesystem::permissions(file, std::filesystem::perms::none);
  EXPECT_THAT(refusal(file), AllOf(HasSubstr("secret" + extension()), HasSubstr("Permission denied")));
}

TEST_P(BadPlace, IsRefusedWhereTheFileIsEmpty) {
  EXPECT_THAT(refusal(put("empty" + extension(), "")), HasSubstr("empty" + extension()));
}

std::vector<std::string> extensions(bool written) {
  std::vector<std::string> list;
  for (const Format& format : formats()) {
    if (format.missing.empty() && (!written || format.create)) list.push_back(format.extensions.front());
  }
  return list;
}

INSTANTIATE_TEST_SUITE_P(All, BadPlace, testing::ValuesIn(extensions(false)), without_dot);

/// Tests of every format that is written.
class BadTarget : public BadPlace {
 protected:
  static History<3> history() { return {std::vector<Box3>(5000, Box3{{1, 2, 3}, {4, 5, 6}}), {}}; }

  std::string refusal_to_write(const std::filesystem::path& file) const {
    const Format& format = writable_format(path("a" + extension()));
    return message_of<FileError>(
        [&] { write_frames(std::make_unique<HistoryReader<3, float>>(history()), file, format); });
  }
};

/// While it exists, no file can become longer than this.
class ShortFiles {
 public:
  explicit ShortFiles(rlim_t bytes) {
    getrlimit(RLIMIT_FSIZE, &before_);
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~ShortFiles() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  ShortFiles(const ShortFiles&) = delete;
  ShortFiles& operator=(const ShortFiles&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int) = SIG_DFL;
};

TEST_P(BadTarget, IsRefusedWhereTheDiskIsFull) {
  EXPECT_THAT(refusal_to_write("/dev/full"), AllOf(HasSubstr("/dev/full"), HasSubstr("No space left")));
}

TEST_P(BadTarget, LeavesNothingPartialWhereTheDiskFillsUp) {
  for (const rlim_t bytes : {0, 100, 10'000}) {
    const ShortFiles limit(bytes);
    EXPECT_THAT(refusal_to_write(path("new" + extension())),
                AllOf(HasSubstr("new" + extension()), HasSubstr("too large")));
    EXPECT_EQ(count_files(), 0u) << bytes;
  }
  put("old" + extension(), "old");
  {
    const ShortFiles limit(10'000);
    EXPECT_THAT(refusal_to_write(path("old" + extension())), HasSubstr("too large"));
  }
  EXPECT_EQ(text_of("old" + extension()), "old");
  EXPECT_EQ(count_files(), 1u);
}

TEST_P(BadTarget, IsRefusedWhereItIsAFolderOrInNone) {
  std::filesystem::create_directory(path("folder" + extension()));
  EXPECT_THAT(refusal_to_write(path("folder" + extension())),
              AllOf(HasSubstr("folder"), HasSubstr("Is a directory")));
  EXPECT_THAT(refusal_to_write(path("none/a" + extension())),
              AllOf(HasSubstr("none/a"), HasSubstr("No such file")));
  EXPECT_EQ(count_files(), 1u);
}

INSTANTIATE_TEST_SUITE_P(All, BadTarget, testing::ValuesIn(extensions(true)), without_dot);

}  // namespace
}  // namespace broadside::lab

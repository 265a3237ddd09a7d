// Inputs: the same bytes whether they are mapped, piped or in memory, at once or in pieces.
#include "lab/formats/input.hpp"

#include <cstdint>
#include <filesystem>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "lab/formats/byte_source.hpp"
#include "lab/formats/format.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"
#include "tests/support/pipe.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;

using InputTest = Files;

/// Some 250 kB: more than any buffer here holds.
std::string long_text() {
  std::string text;
  for (int i = 0; i < 50'000; ++i) text += std::to_string(i) + "\n";
  return text;
}

std::string stream_text(Input& input) { return {std::istreambuf_iterator<char>(input.stream()), {}}; }

TEST_F(InputTest, GivesTheBytesOfAFileAtOnceOrAsAStreamAfterItsBeginningWasLookedAt) {
  const std::string text = long_text();
  Input at_once(put("a.txt", text));
  EXPECT_EQ(at_once.beginning(), text.substr(0, Input::beginning_bytes));
  EXPECT_EQ(at_once.bytes(), text);
  EXPECT_EQ(at_once.bytes(), text) << "a second time";
  EXPECT_EQ(at_once.path(), path("a.txt"));

  Input in_pieces(path("a.txt"));
  EXPECT_EQ(in_pieces.beginning(), text.substr(0, Input::beginning_bytes));
  EXPECT_EQ(stream_text(in_pieces), text);
}

TEST_F(InputTest, GivesTheBytesOfAPipeLikewise) {
  const std::string text = long_text();
  const Pipe first(text);
  Input at_once(first.path());
  EXPECT_EQ(at_once.beginning(), text.substr(0, Input::beginning_bytes));
  EXPECT_EQ(at_once.bytes(), text);
  EXPECT_TRUE(at_once.path().empty()) << "a pipe cannot be opened again";

  const Pipe second(text);
  Input in_pieces(second.path());
  EXPECT_EQ(in_pieces.beginning(), text.substr(0, Input::beginning_bytes));
  EXPECT_EQ(stream_text(in_pieces), text);
}

TEST_F(InputTest, GivesTheBytesInMemoryLikewise) {
  const std::string text = long_text();
  Input at_once("memory", text);
  EXPECT_EQ(at_once.beginning(), text.substr(0, Input::beginning_bytes));
  EXPECT_EQ(at_once.bytes(), text);
  Input in_pieces("memory", text);
  EXPECT_EQ(stream_text(in_pieces), text);
  EXPECT_EQ(Input("memory", "").bytes(), "");
}

TEST_F(InputTest, MayBeEmptyOrShort) {
  Input empty(put("empty", ""));
  EXPECT_EQ(empty.beginning(), "");
  EXPECT_EQ(empty.bytes(), "");
  const Pipe pipe("abc");
  Input piped(pipe.path());
  EXPECT_EQ(piped.beginning(), "abc");
  EXPECT_EQ(piped.bytes(), "abc");
}

/// Without the library that decompresses it.
bool is_missing(const std::string& text) {
  return text.find("missing at configure time") != std::string::npos;
}

class CompressedInput : public Files, public testing::WithParamInterface<std::string> {
 protected:
  std::string compressed(const std::string& name) const { return corpus("compressed/" + name + GetParam()); }

  /// What is said of a file of these bytes that is read whole.
  std::string refusal_of(const std::string& bytes) const {
    return message_of<FileError>([&] { Input(put("a.csv" + GetParam(), bytes)).bytes(); });
  }
};

TEST_P(CompressedInput, GivesWhatWasCompressedAtOnceOrInPiecesFromAFileOrAPipe) {
  const std::string plain = corpus("compressed/plain.csv");
  // One member behind the other, as both formats allow: more than any buffer here holds.
  std::string bytes;
  std::string text;
  for (int i = 0; i < 3000; ++i) {
    bytes += compressed("boxes.csv");
    text += plain;
  }
  const auto file = put("a.csv" + GetParam(), bytes);
  try {
    Input at_once(file);
    EXPECT_EQ(at_once.beginning(), text.substr(0, Input::beginning_bytes));
    EXPECT_EQ(at_once.bytes(), text);
    EXPECT_TRUE(at_once.path().empty()) << "its bytes are others than the file's";
    EXPECT_EQ(at_once.extension(), ".csv");
  } catch (const FileError& error) {
    if (is_missing(error.what())) GTEST_SKIP() << error.what();
    throw;
  }
  Input in_pieces(file);
  EXPECT_EQ(stream_text(in_pieces), text);
  const Pipe pipe(bytes);
  Input piped(pipe.path());
  EXPECT_EQ(piped.bytes(), text);
}

TEST_P(CompressedInput, IsRefusedByNameWhereItIsCutOffOrDamaged) {
  const std::string whole = compressed("boxes.csv");
  const std::string of_part = refusal_of(whole.substr(0, whole.size() - 1));
  if (is_missing(of_part)) GTEST_SKIP() << of_part;
  for (std::size_t size = compression_magic_bytes; size < whole.size(); ++size)
    EXPECT_THAT(refusal_of(whole.substr(0, size)),
                HasSubstr("a.csv" + GetParam() + ": the compressed file is cut off"))
        << size;
  EXPECT_THAT(refusal_of(compressed("wrong_checksum.csv")),
              AllOf(HasSubstr("a.csv" + GetParam() + ": byte "), HasSubstr(" of the compressed file: ")));
  EXPECT_THAT(refusal_of(whole + "more"), HasSubstr("a.csv" + GetParam() + ": "));
}

TEST_P(CompressedInput, IsRefusedAsAStreamLikewise) {
  const auto file = put("a.csv" + GetParam(), compressed("cut_off.csv"));
  const std::string text = message_of<FileError>([&] {
    Input input(file);
    std::string line;
    while (std::getline(input.stream(), line)) continue;
  });
  EXPECT_TRUE(is_missing(text) || text.find("is cut off") != std::string::npos) << text;
}

INSTANTIATE_TEST_SUITE_P(All, CompressedInput, testing::Values(".gz", ".zst"), without_dot);

TEST_F(InputTest, KnowsItsExtensionInLowerCase) {
  EXPECT_EQ(Input("a.Csv.GZ", "").extension(), ".csv");
  EXPECT_EQ(Input("zst", "").extension(), "");
  EXPECT_EQ(Input(put("a.CSV", "")).extension(), ".csv");
  EXPECT_EQ(Input("b.tar.Npy", "").extension(), ".npy");
  EXPECT_EQ(Input(put("c", "")).extension(), "");
}

TEST_F(InputTest, IsRefusedWhereItCannotBeRead) {
  EXPECT_THAT(message_of<FileError>([&] { Input input(path("none")); }),
              AllOf(HasSubstr("none: cannot be read"), HasSubstr("No such file")));
  EXPECT_THAT(message_of<FileError>([&] { Input input(path("")); }), HasSubstr("Is a directory"));
  // It can be opened, and its first byte cannot be read.
  EXPECT_THAT(message_of<FileError>([] { Input("/proc/self/mem").beginning(); }),
              HasSubstr("/proc/self/mem: cannot be read"));
  EXPECT_THAT(message_of<FileError>([] { Input("/proc/self/mem").bytes(); }), HasSubstr("cannot be read"));
}

/// Standard input comes from a file while this exists, from the byte on at which it is opened.
class StandardInput {
 public:
  StandardInput(const std::filesystem::path& path, off_t begin) : before_(::dup(STDIN_FILENO)) {
    const int file = ::open(path.c_str(), O_RDONLY);
    ::lseek(file, begin, SEEK_SET);
    ::dup2(file, STDIN_FILENO);
    ::close(file);
  }
  ~StandardInput() {
    ::dup2(before_, STDIN_FILENO);
    ::close(before_);
  }
  StandardInput(const StandardInput&) = delete;
  StandardInput& operator=(const StandardInput&) = delete;

 private:
  int before_;
};

TEST_F(InputTest, IsStandardInputFromWhereItStands) {
  const std::string text = long_text();
  for (const std::size_t begin : {0, 3, 100'000}) {
    {
      const StandardInput file(put("a.txt", text), static_cast<off_t>(begin));
      Input at_once("-");
      EXPECT_EQ(at_once.beginning(), text.substr(begin, Input::beginning_bytes));
      EXPECT_EQ(at_once.bytes(), text.substr(begin));
      EXPECT_EQ(at_once.name(), "standard input");
      EXPECT_TRUE(at_once.path().empty()) << "by then it may stand elsewhere";
    }
    const StandardInput file(path("a.txt"), static_cast<off_t>(begin));
    Input in_pieces("-");
    EXPECT_EQ(stream_text(in_pieces), text.substr(begin));
  }
}

TEST_F(InputTest, TellsHowFarItIsAndOfHowMuch) {
  const std::string text(40'000'000, 'x');
  std::vector<std::pair<std::uint64_t, std::uint64_t>> reports;
  const Progress progress = [&](std::uint64_t done, std::uint64_t total) {
    reports.emplace_back(done, total);
  };
  Input file(put("a.txt", text), progress);
  for (std::uint64_t byte = 0; byte <= text.size(); byte += 1'000'000) file.passed(byte);
  EXPECT_THAT(reports.size(), testing::AllOf(testing::Ge(3u), testing::Le(6u)));
  EXPECT_EQ(reports.back().second, text.size());

  reports.clear();
  Input streamed(path("a.txt"), progress);
  EXPECT_EQ(stream_text(streamed).size(), text.size());
  EXPECT_GE(reports.size(), 3u);
}

}  // namespace
}  // namespace broadside::lab

// What the program shows of long work: on a terminal, where it goes again; elsewhere nothing, unless it is
// asked for.
#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "process.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::Not;
using testing::StartsWith;

/// A pseudo-terminal of 80 columns.
class Terminal {
 public:
  Terminal() : descriptor_(posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC)) {
    if (descriptor_ < 0 || grantpt(descriptor_) != 0 || unlockpt(descriptor_) != 0)
      throw std::runtime_error("no terminal can be made");
    path_ = ptsname(descriptor_);
    // While it is open here, it stays when a program closes it.
    other_ = open(path_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    fcntl(descriptor_, F_SETFL, O_NONBLOCK);
    const winsize size{.ws_row = 25, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
    ioctl(other_, TIOCSWINSZ, &size);
  }
  ~Terminal() {
    close(other_);
    close(descriptor_);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  const std::string& path() const { return path_; }

  /// What was written to it since the last call.
  std::string shown() const {
    std::string text;
    std::array<char, 4096> some{};
    for (ssize_t got = 0; (got = read(descriptor_, some.data(), some.size())) > 0;)
      text.append(some.data(), static_cast<std::size_t>(got));
    return text;
  }

 private:
  int descriptor_;
  int other_ = -1;
  std::string path_;
};

const std::string gone = "\r\x1b[K";

TEST(Progress, IsShownOnATerminalAndGoneInTheEnd) {
  const Terminal terminal;
  const Ended ended =
      shell("$BROADSIDE compare uniform clustered -n 200 --algorithms brute_force 2>" + terminal.path());
  ASSERT_EQ(ended.status, 0);
  EXPECT_THAT(terminal.shown(), AllOf(HasSubstr(gone + "0 %: [1/4] uniform 2D"),
                                      HasSubstr(gone + "25 %: [2/4]"), EndsWith(gone)));
  EXPECT_THAT(ended.output, Not(HasSubstr("\x1b")));
}

TEST(Output, IsFoldedOnATerminalAndWholeInAPipe) {
  const std::string command =
      "$BROADSIDE compare uniform -n 100 --dimension 2 --algorithms brute_force,grid ";
  const Terminal terminal;
  ASSERT_EQ(shell("unset COLUMNS; " + command + "--details >" + terminal.path()).status, 0);
  EXPECT_THAT(terminal.shown(), Not(MatchesRegex("(.|\r|\n)*[^\r\n]{81}(.|\r|\n)*")));
  EXPECT_THAT(shell("COLUMNS=40 " + command).output, StartsWith("case                   "));
}

TEST(Progress, TellsHowLongTheRestWillTake) {
  const TemporaryFolder folder;
  const std::string boxes = folder.file("boxes.npy");
  ASSERT_EQ(run({"scene", "uniform", "-n", "20k", "-o", boxes}).status, 0);
  const Terminal terminal;
  ASSERT_EQ(shell("$BROADSIDE advise " + boxes + " --budget 3 2>" + terminal.path()).status, 0);
  EXPECT_THAT(terminal.shown(), MatchesRegex("(.|\r|\n)*[0-9]+ %, [0-9]+ s left: (.|\r|\n)*"));
}

TEST(Progress, OfAFileIsThatOfItsBytesAndNotInThePairs) {
  const TemporaryFolder folder;
  const std::string boxes = folder.file("boxes.csv");
  ASSERT_EQ(run({"scene", "uniform", "-n", "400k", "--dimension", "2", "-o", boxes}).status, 0);
  const Terminal terminal;
  const Ended ended = shell("$BROADSIDE pairs " + boxes + " 2>" + terminal.path() + " | head -n 1");
  EXPECT_EQ(ended.output, "first,second\n");
  EXPECT_THAT(terminal.shown(), HasSubstr(" %: reading boxes.csv"));
}

TEST(Progress, IsNotShownWhereItIsNotWanted) {
  const Terminal terminal;
  const std::string compare = "$BROADSIDE compare uniform -n 200 --algorithms brute_force ";
  ASSERT_EQ(shell(compare + "--no-progress 2>" + terminal.path()).status, 0);
  EXPECT_THAT(terminal.shown(), IsEmpty());
  EXPECT_THAT(shell(compare).errors, IsEmpty());
  EXPECT_THAT(shell(compare + "--progress").errors,
              AllOf(HasSubstr("broadside: 0 %: [1/2] "), Not(HasSubstr("\x1b"))));
  EXPECT_EQ(shell(compare + "--progress --no-progress").status, 2);
}

}  // namespace
}  // namespace broadside::cli

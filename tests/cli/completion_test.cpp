// What shells complete, and the pages of the manual: both are made of the options that the program has.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// What bash offers for the last of these words.
std::string completed(const std::string& words, int last) {
  const std::string line = "bash -c 'source <($BROADSIDE completion bash); COMP_WORDS=(" + words +
                           "); COMP_CWORD=" + std::to_string(last) +
                           "; _broadside; echo \"${COMPREPLY[@]}\"'";
  const Ended ended = shell(line);
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_EQ(ended.errors, "");
  return ended.output;
}

TEST(Completion, OffersVerbsOptionsAndNamesInBash) {
  EXPECT_EQ(completed("broadside co", 1), "compare convert completion\n");
  EXPECT_EQ(completed("broadside pairs --wi", 2), "--within\n");
  EXPECT_EQ(completed("broadside pairs boxes.csv --algorithm swe", 4), "sweep_and_prune\n");
  EXPECT_EQ(completed("broadside compare pil", 2), "pile\n");
  EXPECT_EQ(completed("broadside help inf", 2), "info\n");
}

TEST(Completion, IsReadByZshAndFish) {
  for (const std::string command : {"zsh -n", "fish --no-execute"}) {
    const std::string name = command.substr(0, command.find(' '));
    if (shell("command -v " + name).status != 0) continue;
    const TemporaryFolder folder;
    const std::string script = folder.put("script", run({"completion", name}).output);
    const Ended ended = shell(command + " " + script);
    EXPECT_EQ(ended.status, 0) << ended.errors;
    EXPECT_EQ(ended.errors, "");
  }
}

TEST(Completion, RefusesAnotherShell) {
  const Ended ended = run({"completion", "tcsh"});
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.errors, HasSubstr("shell is 'tcsh'; expected bash, zsh or fish"));
}

TEST(ManPage, HasWhatHelpSaysUnderTheHeadingsOfManuals) {
  const std::string page = run({"help", "--man", "pairs"}).output;
  EXPECT_THAT(page, StartsWith(".TH BROADSIDE-PAIRS 1 "));
  EXPECT_THAT(page, AllOf(HasSubstr(".SH NAME\nbroadside\\-pairs \\- Finds the pairs"),
                          HasSubstr(".SH SYNOPSIS\n.B broadside pairs\n[OPTIONS] files...\n"),
                          HasSubstr(".B \\-\\-within DISTANCE\n"), HasSubstr(".SH EXAMPLES\n"),
                          HasSubstr(".SH EXIT STATUS\n0 fine,"), HasSubstr(".BR broadside (1)\n")));
  const std::string program = run({"help", "--man"}).output;
  EXPECT_THAT(program, AllOf(HasSubstr(".SH VERBS\n"), HasSubstr(".BR broadside\\-list (1)"),
                             Not(HasSubstr("broadside\\-help"))));
}

}  // namespace
}  // namespace broadside::cli

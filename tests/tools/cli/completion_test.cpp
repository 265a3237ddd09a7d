// What shells complete: the verbs and options that the program has.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"

namespace broadside::cli {
namespace {

using testing::HasSubstr;

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

}  // namespace
}  // namespace broadside::cli

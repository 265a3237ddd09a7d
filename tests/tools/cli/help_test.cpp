// The help of every verb, and the one vocabulary that all verbs have.
#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"
#include "refusal.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::vector<std::string> verbs = {"compare", "advise", "pairs", "info", "verify",
                                        "convert", "scene",  "draw",  "list", "completion"};

std::size_t longest_line(const std::string& text) {
  std::size_t longest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) longest = std::max(longest, line.size());
  return longest;
}

TEST(Help, IsPrintedByTheVerbHelpToo) {
  EXPECT_EQ(run({"help"}).output, run({"--help"}).output);
  for (const std::string& verb : verbs) {
    const Ended ended = run({"help", verb});
    EXPECT_EQ(ended.status, 0) << ended.errors;
    EXPECT_EQ(ended.output, run({verb, "--help"}).output);
  }
  EXPECT_THAT(run({"help", "pars"}).errors, HasSubstr("unknown verb 'pars' (did you mean 'pairs'?)"));
}

TEST(Help, IsAsWideAsTheTerminalAndAtMostAHundredColumns) {
  for (const std::string& verb : verbs) {
    EXPECT_LE(longest_line(shell("COLUMNS=80 $BROADSIDE help " + verb).output), 80u) << verb;
    EXPECT_LE(longest_line(shell("unset COLUMNS; $BROADSIDE help " + verb).output), 80u) << verb;
    const std::size_t wide = longest_line(shell("COLUMNS=300 $BROADSIDE help " + verb).output);
    EXPECT_LE(wide, 100u) << verb;
  }
  EXPECT_GT(longest_line(shell("COLUMNS=300 $BROADSIDE help compare").output), 80u);
}

TEST(Vocabulary, AlgorithmsAreTakenUnderEitherName) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", "0,0,1,1\n1,1,2,2\n");
  for (const std::string option : {"--algorithm", "--algorithms"}) {
    for (const std::vector<std::string>& arguments : {std::vector<std::string>{"compare", file},
                                                      {"verify", file},
                                                      {"pairs", file},
                                                      {"draw", file, "-o", folder.file("a.svg")},
                                                      {"advise", file, "--budget", "0.1"}}) {
      std::vector<std::string> all = arguments;
      all.insert(all.end(), {option, "grid"});
      const Ended ended = run(all);
      EXPECT_EQ(ended.status, 0) << arguments[0] << ended.errors;
    }
    expect_refused("pairs",
                   {{{file, option, "grid,bvh"}, {"'grid,bvh', which is 2 algorithms; expected one"}}});
  }
}

TEST(Vocabulary, ScenesAreTakenByPositionAndAsAnOption) {
  const TemporaryFolder folder;
  const std::string comma = folder.put("a,b.csv", "0,0,1,1\n1,1,2,2\n");
  const auto output = [](const std::vector<std::string>& arguments) {
    const Ended ended = run(arguments);
    EXPECT_EQ(ended.status, 0) << ended.errors;
    return ended.output;
  };
  for (const std::vector<std::string>& scenes : {std::vector<std::string>{"uniform", "lattice"},
                                                 {"uniform,lattice"},
                                                 {"--scenes", "uniform,lattice"},
                                                 {"--scenes", "uniform", "lattice"}}) {
    std::vector<std::string> arguments = {"compare", "-n", "20", "--algorithms", "grid", "--dimension", "2"};
    arguments.insert(arguments.end(), scenes.begin(), scenes.end());
    EXPECT_THAT(output(arguments), AllOf(HasSubstr("\nuniform, 2D, "), HasSubstr("\nlattice, 2D, ")));
  }
  EXPECT_THAT(output({"compare", comma, "--algorithms", "grid"}), HasSubstr("a,b.csv, 2D, 2 boxes"));
  for (const std::string verb : {"info", "verify"}) {
    EXPECT_THAT(output({verb, "uniform", "-n", "20"}), StartsWith("uniform: "));
    EXPECT_THAT(output({verb, "--scenes", comma}), HasSubstr("a,b.csv: "));
    EXPECT_THAT(output({verb, "churn", "-n", "20", "--dimension", "3"}),
                HasSubstr("in 3D, as floats, 21 frames"));
  }
  EXPECT_EQ(output({"draw", "--scenes", "uniform", "-n", "9", "-o", "-"}),
            output({"draw", "uniform", "-n", "9", "-o", "-"}));
  EXPECT_EQ(output({"scene", "--scenes", "uniform", "-n", "9", "-o", "-", "--to", "csv"}),
            output({"scene", "uniform", "-n", "9", "-o", "-", "--to", "csv"}));
  for (const std::string verb : {"draw", "scene"})
    expect_refused(verb, {{{"uniform", "lattice", "-o", "-"}, {"2 scenes: uniform, lattice; expected one"}}});
}

TEST(Vocabulary, SaysWhatWasMeant) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", "0,0,1,1\n1,1,2,2\n");
  expect_refused("compare", {{{"--algoritms", "grid"}, {"'--algoritms' (did you mean '--algorithms'?)"}},
                             {{"--algorithms", "gird"}, {"'gird' (did you mean 'grid'?)"}},
                             {{"--algorithms", "grid:cel=2"}, {"'cel' (did you mean 'cell'?)"}},
                             {{"unifrom"}, {"'unifrom' (did you mean 'uniform'?)"}},
                             {{"-n", "10", "20"}, {"'20' is a number", "-n 1000,20"}},
                             {{"--budget", "much"}, {"--budget is 'much'; expected a number"}}});
  expect_refused("convert", {{{file, "--format", "cvs", "-o", "-"}, {"expected --to"}},
                             {{file, "--format", "cvs", "-o", "a.csv"}, {"'cvs' (did you mean 'csv'?)"}},
                             {{file, "--to", "trac", "-o", "-"}, {"'trac' (did you mean 'trace'?)"}}});
}

}  // namespace
}  // namespace broadside::cli

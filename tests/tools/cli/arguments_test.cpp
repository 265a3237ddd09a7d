// What the program says of itself, and of arguments that it cannot use.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "broadside/algorithm.hpp"
#include "broadside/version.hpp"

#include "lab/formats/format.hpp"
#include "lab/scenes/scene.hpp"
#include "process.hpp"
#include "refusal.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;

TEST(Help, NamesEveryVerbAndEveryOption) {
  const Ended help = run({"--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_THAT(help.output, AllOf(HasSubstr("compare"), HasSubstr("scene"), HasSubstr("list"),
                                 HasSubstr("--version"), HasSubstr("Exit status: 0 fine")));
  const Ended compare = run({"compare", "--help"});
  EXPECT_EQ(compare.status, 0);
  for (const char* const option :
       {"--algorithms", "--scenes", "-n", "--dimension", "--moving", "--frames", "--drift", "--teleport",
        "--threads", "--seed", "--json", "--budget", "--long"})
    EXPECT_THAT(compare.output, HasSubstr(option));
}

TEST(Version, IsTheLibrarys) {
  const Ended ended = run({"--version"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_EQ(ended.output, "broadside " BROADSIDE_VERSION "\n");
}

TEST(List, NamesEveryAlgorithmSceneAndFormat) {
  const Ended ended = run({"list"});
  EXPECT_EQ(ended.status, 0);
  for (const Algorithm& algorithm : algorithms()) {
    EXPECT_THAT(ended.output, HasSubstr("\n  " + algorithm.name + " "));
    for (const Tunable& tunable : algorithm.tunables)
      EXPECT_THAT(ended.output, HasSubstr(":" + tunable.name + "="));
  }
  for (const lab::Scene& scene : lab::scenes())
    EXPECT_THAT(ended.output, HasSubstr("\n  " + scene.name + " "));
  for (const lab::Format& format : lab::formats())
    EXPECT_THAT(ended.output, HasSubstr("\n  " + format.name + " "));
  for (const lab::Format& format : lab::formats()) {
    for (const lab::ElementKind& part : format.parts)
      EXPECT_THAT(ended.output, HasSubstr("\n      --boxes " + part.name + "  "));
  }
  std::istringstream lines(ended.output);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
}

TEST(Arguments, ThatCannotBeUsedAreNamedWithWhatIsExpected) {
  const std::vector<Refusal> refusals = {
      {{}, {"no verb", "expected one of: compare, advise, measure, pairs"}},
      {{"jump"}, {"unknown verb 'jump'", "expected one of: compare, advise, measure, pairs"}},
      {{"experiment", "--quick"}, {"verb 'experiment' is no longer there", "`make experiments`"}},
      {{"compare", "--sceens", "uniform"}, {"--sceens"}},
      {{"compare", "--algorithms", "grid:cell=5,threads=2"},
       {"a comma before 'threads=2'", "name:tunable=value:tunable=value"}},
      {{"compare", "--algorithms", "gird"}, {"'gird'", "expected one of: ", "grid"}},
      {{"compare", "--algorithms", "grid:cell=-1"}, {"grid: cell is '-1'", "expected a number"}},
      {{"compare", "--scenes", "unifrom"}, {"'unifrom'", "expected a file or one of: ", "uniform"}},
      {{"compare", "--scenes", "uniform:neighbours=no"}, {"neighbours is 'no'", "expected a number"}},
      {{"compare", "--scenes", "/nowhere/boxes.csv"}, {"/nowhere/boxes.csv"}},
      {{"compare", "-n", "12x"}, {"-n is '12x'", "expected a whole number"}},
      {{"compare", "-n", "0"}, {"-n is '0'", "expected a whole number from 1"}},
      {{"compare", "-n", "1.5"}, {"-n is '1.5'"}},
      {{"compare", "--frames", "-3"}, {"--frames is '-3'"}},
      {{"compare", "--dimension", "4"}, {"--dimension is 4", "expected 2 or 3"}},
      {{"compare", "--moving", "0.5", "--teleport", "2"},
       {"--teleport is 2", "expected a fraction from 0 to 1"}},
      {{"compare", "--moving", "0.5", "--drift", "-1"}, {"--drift is -1", "expected a number of at least 0"}},
      {{"compare", "--drift", "1"}, {"--drift and --teleport say how boxes move", "expected --moving"}},
      {{"compare", "--moving", "1.5"}, {"--moving is 1.5", "expected a fraction from 0 to 1"}},
      {{"compare", "--threads", "2000"}, {"--threads is 2000", "expected at most 1024"}},
      {{"compare", "--threads", "two"}, {"--threads is 'two'", "expected a whole number from 0"}},
      {{"pairs", "boxes.csv", "--threads", "2", "--algorithm", "paper_grid"},
       {"--threads is 2", "paper_grid"}},
      {{"pairs", "boxes.csv", "--threads", "1", "--algorithm", "grid:threads=2"},
       {"--threads is 1", "grid:threads=2"}},
      {{"compare", "--seed", "-1"}, {"--seed", "'-1'", "expected a whole number"}},
      {{"compare", "--scenes", "boxes.csv", "--json", "boxes.csv"}, {"--json is boxes.csv", "another file"}},
      {{"compare", "--budget", "0"}, {"--budget is 0", "expected a number of seconds above 0"}},
      {{"compare", "--long", "-n", "100"}, {"--long", "expected it without"}},
      {{"compare", "--json", "/nowhere/out.json"},
       {"--json", "'/nowhere/out.json'", "expected one that is there"}},
      {{"compare", "--json", "/"}, {"--json is '/'", "expected a file"}},
      {{"scene", "uniform"}, {"--output"}},
      {{"scene", "unifrom", "-o", "boxes.csv"}, {"'unifrom'"}},
      {{"scene", "uniform", "-o", "boxes.unknown"}, {"'.unknown'", ".csv"}},
      {{"scene", "uniform", "-o", "/nowhere/boxes.csv"}, {"-o", "'/nowhere'"}},
      {{"scene", "uniform", "--dimension", "5", "-o", "boxes.csv"}, {"--dimension is 5"}},
  };
  expect_refused(refusals);
}

TEST(Output, ThatCannotBeWrittenIsAnError) {
  const std::string to_nowhere = " --help > /dev/full 2> /dev/null";
  const int status = std::system((BROADSIDE_PROGRAM + to_nowhere).c_str());
  EXPECT_EQ(WEXITSTATUS(status), 2);
}

TEST(Signals, EndTheProgramWithALine) {
  const TemporaryFolder folder;
  const std::string pipe = folder.file("pipe");
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::signal(SIGHUP, SIG_DFL);  // the tests may run where it is ignored
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    Process process({"info", pipe});
    std::this_thread::sleep_for(std::chrono::milliseconds(1000));
    process.signal(signal);
    const Ended ended = process.wait();
    EXPECT_EQ(ended.status, 130);
    EXPECT_EQ(ended.errors, "broadside: interrupted\n");
  }
}

}  // namespace
}  // namespace broadside::cli

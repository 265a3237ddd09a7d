// broadside-mpi: what it writes is what broadside writes, byte for byte, for any number of ranks; and it
// ends, whatever becomes of one of them.
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/rng.hpp"
#include "tests/tools/cli/process.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Runs a shell command line in which $MPI starts the program on `ranks` ranks, with a time limit of a
/// minute.
Ended on_ranks(int ranks, const std::string& line) {
  return shell(fmt::format("MPI=\"timeout -k 5 60 {} -n {} {}\"; DYING=\"timeout -k 5 60 {} -n {} {}\"; {}",
                           BROADSIDE_MPIEXEC, ranks, BROADSIDE_MPI_PROGRAM, BROADSIDE_MPIEXEC, ranks,
                           BROADSIDE_DYING_RANK, line));
}

std::string table(int count, std::uint64_t seed, int columns = 4) {
  Rng rng(seed);
  std::string rows = columns == 4 ? "min_x,min_y,max_x,max_y\n" : "min_x,min_y,min_z,max_x,max_y,max_z\n";
  for (int i = 0; i < count; ++i) {
    std::string max;
    for (int axis = 0; axis < columns / 2; ++axis) {
      const int min = rng.whole(0, 300);
      rows += fmt::format("{},", min);
      max += fmt::format("{}{}", axis == 0 ? "" : ",", min + rng.whole(0, 12));
    }
    rows += max + "\n";
  }
  return rows;
}

TEST(MpiProgram, WritesThePairsOfTheProgramByteForByte) {
  const TemporaryFolder folder;
  const std::string csv = folder.put("boxes.csv", table(700, 1));
  const std::string other = folder.put("other.csv", table(300, 2));
  const std::string solid = folder.put("solid.csv", table(900, 3, 6));
  const std::string npy = folder.file("boxes.npy");
  ASSERT_EQ(run({"convert", solid, "-o", npy}).status, 0);
  ASSERT_EQ(shell("gzip -k " + csv).status, 0);
  for (const std::string& input : {csv, csv + " " + other, npy, csv + ".gz", solid + " " + npy,
                                   csv + " --precision float", npy + " --dimension 2"})
    for (const std::string name : {"pairs.csv", "pairs.npy"}) {
      const std::string expected = folder.file("expected_" + name);
      ASSERT_EQ(shell("$BROADSIDE pairs " + input + " -o " + expected).status, 0);
      // To start ranks takes longer than all else here.
      for (const int ranks : input == csv ? std::vector{1, 3} : std::vector{3}) {
        const std::string found = folder.file(name);
        const Ended ended = on_ranks(ranks, "$MPI pairs " + input + " -o " + found);
        ASSERT_EQ(ended.status, 0) << ended.errors;
        EXPECT_EQ(text_of(found), text_of(expected)) << input;
        EXPECT_THAT(ended.errors, HasSubstr(fmt::format("on {} rank", ranks)));
      }
    }
}

TEST(MpiProgram, CountsAndHashesAlikeForAnyNumberOfRanks) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", table(700, 1));
  const std::string count = shell("$BROADSIDE pairs --count " + file).output;
  std::string first;
  for (const int ranks : {1, 2, 4}) {
    const Ended ended = on_ranks(ranks, "$MPI pairs --count --hash --statistics " + file);
    if (first.empty()) first = ended.output;
    EXPECT_EQ(ended.output, first);
    EXPECT_THAT(ended.output, testing::StartsWith(count));
    EXPECT_THAT(ended.errors, HasSubstr("bytes sent a box"));
  }
}

TEST(MpiProgram, ReadsStandardInputAndWritesStandardOutput) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", table(100, 1));
  EXPECT_EQ(on_ranks(2, "$MPI pairs - < " + file).output, run({"pairs", file}).output);
}

TEST(MpiProgram, SaysOnceWhatIsWrongWithAFileWhicheverRankReadsIt) {
  const TemporaryFolder folder;
  const std::string output = folder.put("pairs.csv", "as it was");
  for (const int line : {2, 250, 701}) {
    std::string rows;
    for (int i = 1; i <= 701; ++i)
      rows += i == line ? "0,0,-1,1\n" : i == 1 ? "min_x,min_y,max_x,max_y\n" : "0,0,1,1\n";
    const std::string file = folder.put("bad.csv", rows);
    const Ended ended = on_ranks(3, "$MPI pairs " + file + " -o " + output);
    EXPECT_EQ(ended.status, 2);
    EXPECT_THAT(ended.errors, HasSubstr(fmt::format("broadside-mpi: {}:{}: ", file, line)));
    EXPECT_EQ(ended.errors.find("broadside-mpi: "), ended.errors.rfind("broadside-mpi: ")) << ended.errors;
    EXPECT_EQ(text_of(output), "as it was");
  }
  EXPECT_EQ(folder.names().size(), 2U) << "something was left behind";
}

TEST(MpiProgram, RefusesWhatDoesNotGoTogether) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", table(10, 1));
  const auto expect_refusal = [&](const std::string& arguments, const std::string& text) {
    const Ended ended = on_ranks(2, "$MPI " + arguments);
    EXPECT_EQ(ended.status, 2) << arguments;
    EXPECT_THAT(ended.errors, HasSubstr(text));
  };
  expect_refusal("pairs", "files is missing; expected: A file, or two");
  expect_refusal("pears " + file, "unknown verb 'pears' (did you mean 'pairs'?)");
  expect_refusal("pairs " + file + " --conut", "unknown option '--conut' (did you mean '--count'?)");
  expect_refusal("pairs " + file + " --hash -o " + folder.file("a.csv"), "--output");
  expect_refusal("pairs " + file + " --algorithm none", "none");
  expect_refusal("pairs " + file + " -o " + folder.file("no/a.csv"), "a.csv");
  expect_refusal("pairs " + file + " " + folder.put("solid.csv", table(10, 1, 6)),
                 "expected both in the same");
  expect_refusal("pairs " + folder.file("none.csv"), "none.csv");
  EXPECT_THAT(on_ranks(2, "$MPI help pairs").output, HasSubstr("--statistics"));
}

/// Joins boxes.csv or boxes.npy by two ranks, each of which looks for it in a folder of its own.
Ended in_two_folders(const std::string& first, const std::string& second, const std::string& name) {
  const auto rank_in = [&](const std::string& folder) {
    return fmt::format("-n 1 sh -c 'cd {} && exec {} pairs --count {}'", folder, BROADSIDE_MPI_PROGRAM, name);
  };
  return shell(fmt::format("timeout -k 5 60 {} {} : {}", BROADSIDE_MPIEXEC, rank_in(first), rank_in(second)));
}

TEST(MpiProgram, RefusesAFileThatIsAnotherOnAnotherRank) {
  const TemporaryFolder first;
  const TemporaryFolder second;
  const std::string header = "min_x,min_y,max_x,max_y\n";
  const auto expect = [&](const std::string& name, const std::string& text) {
    const Ended ended = in_two_folders(first.file(""), second.file(""), name);
    EXPECT_EQ(ended.status, text.empty() ? 0 : 2) << name << ended.errors;
    EXPECT_THAT(ended.errors, HasSubstr(text));
  };
  for (const TemporaryFolder* const folder : {&first, &second}) {
    folder->put("same.csv", table(100, 1));
    folder->put("longer.csv", header + (folder == &first ? "0,0,1,1\n" : "0,0,1,1\n0,0,1,2\n"));
    folder->put("stale.csv", header + (folder == &first ? "0,0,1,1\n5,5,6,6\n" : "5,5,6,6\n0,0,1,1\n"));
    for (const std::string name : {"flat", "solid"})
      ASSERT_EQ(run({"convert", folder->put(name + ".csv", table(8, 1, name == "flat" ? 4 : 6)), "-o",
                     folder->file(name + ".npy")})
                    .status,
                0);
  }
  expect("same.csv", "");
  expect("longer.csv", "rank 1 finds 40 bytes in longer.csv; expected 32 as on rank 0");
  expect("stale.csv", "rank 1 finds other content in stale.csv than rank 0");
  ASSERT_EQ(shell(fmt::format("cp {} {}", second.file("solid.npy"), second.file("flat.npy"))).status, 0);
  expect("flat.npy", "in flat.npy; expected");
}

TEST(MpiProgram, EndsWhereTheOutputCannotBeTaken) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", table(2000, 1));
  const Ended ended = on_ranks(3, "$MPI pairs " + file + " --to npy -o /dev/full");
  EXPECT_EQ(ended.status, 2);
  EXPECT_THAT(ended.errors, HasSubstr("/dev/full"));
}

TEST(MpiProgram, EndsWhereARankIsKilled) {
  for (const int ranks : {2, 4}) {
    const Ended ended = on_ranks(ranks, "$DYING");
    EXPECT_NE(ended.status, 0);
    EXPECT_NE(ended.status, 124) << "it hung";
    EXPECT_THAT(ended.output, Not(HasSubstr("was given pairs"))) << "it was not killed in the middle";
    EXPECT_THAT(ended.output, Not(HasSubstr("came to the end")));
    EXPECT_THAT(ended.errors + ended.output, HasSubstr("signal 9"));
  }
}

}  // namespace
}  // namespace broadside::cli

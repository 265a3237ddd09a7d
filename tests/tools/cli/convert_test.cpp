// broadside convert, and scene's output: formats, pipes, what is lost and said.
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"
#include "refusal.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

const std::string tenths =
    "min_x,min_y,max_x,max_y\n"
    "0.1,0,1,1\n"
    "2,2,2.5,3.7\n";

TEST(ConvertVerb, ReachesTheSamePairsThroughEveryFormat) {
  const TemporaryFolder folder;
  const std::string file = folder.file("boxes.csv");
  ASSERT_EQ(run({"scene", "integers", "-n", "300", "--dimension", "3", "-o", file}).status, 0);
  const std::string expected = run({"pairs", file}).output;
  for (const std::string name : {"a.btrace", "b.csv"}) {
    const Ended ended = run({"convert", file, "-o", folder.file(name)});
    EXPECT_EQ(ended.status, 0);
    EXPECT_EQ(ended.output, "");
    EXPECT_THAT(ended.errors, AllOf(HasSubstr("1 frame of 300 boxes in 3D"), Not(HasSubstr("rounded"))));
    EXPECT_EQ(run({"pairs", folder.file(name)}).output, expected);
  }
}

TEST(ConvertVerb, KeepsEveryFrame) {
  const TemporaryFolder folder;
  const std::string file = folder.file("moving.csv");
  ASSERT_EQ(run({"scene", "churn", "-n", "50", "--frames", "6", "-o", file}).status, 0);
  const Ended there = run({"convert", file, "-o", folder.file("moving.btrace")});
  EXPECT_THAT(there.errors, HasSubstr("7 frames of "));
  ASSERT_EQ(run({"convert", folder.file("moving.btrace"), "-o", folder.file("back.csv")}).status, 0);
  for (const std::string frame : {"0", "3", "6"}) {
    EXPECT_EQ(run({"pairs", file, "--frame", frame}).output,
              run({"pairs", folder.file("back.csv"), "--frame", frame}).output);
  }
}

TEST(ConvertVerb, SaysHowManyCoordinatesAreRounded) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", tenths);
  const Ended ended = run({"convert", file, "--precision", "float", "-o", folder.file("boxes.btrace")});
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(ended.errors, AllOf(HasSubstr("1 frame of 2 boxes in 2D, as floats, in format "),
                                  EndsWith("; 2 of 8 coordinates were rounded to float\n")));
}

TEST(ConvertVerb, ReadsWhatIsCompressedAndWritesNothingThatIs) {
  const std::string corpus = BROADSIDE_SOURCE_DIR "/tests/fuzz/corpus/compressed/";
  for (const std::string extension : {".gz", ".zst"}) {
    const std::string file = corpus + "boxes.csv" + extension;
    const Ended ended = run({"pairs", "--count", file});
    if (ended.status != 0) {
      EXPECT_THAT(ended.errors, HasSubstr("missing at configure time"));
      continue;
    }
    EXPECT_EQ(ended.output, "2\n");
    EXPECT_EQ(shell("cat " + file + " | $BROADSIDE pairs --count -").output, "2\n");
    EXPECT_THAT(run({"info", corpus + "cut_off.csv" + extension}).errors,
                HasSubstr("cut_off.csv" + extension + ": the compressed file is cut off"));
  }
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", tenths);
  for (const std::string name : {"out.csv.gz", "out.csv.zst"}) {
    const std::vector<Refusal> refusals = {
        {{file, "-o", folder.file(name)}, {"nothing is compressed as it is written"}},
        {{file, "-o", folder.file(name), "--to", "csv"}, {"nothing is compressed as it is written"}}};
    expect_refused("convert", refusals);
    expect_refused("pairs", refusals);
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"boxes.csv"});
}

TEST(ConvertVerb, StandsInAPipe) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", tenths);
  const Ended piped = shell("cat " + file + " | $BROADSIDE convert - --to trace -o - | " +
                            "$BROADSIDE convert - --to csv -o - | cat");
  EXPECT_THAT(piped.output, AllOf(HasSubstr("0.1,0,1,1\n"), HasSubstr("2,2,2.5,3.7\n")));
  EXPECT_EQ(shell("$BROADSIDE scene lattice -n 9 -o - --to csv | $BROADSIDE pairs - --count").output, "20\n");
}

TEST(ConvertVerb, TakesAnExtensionAsAFormatsName) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", tenths);
  EXPECT_EQ(run({"convert", file, "--format", ".csv", "--to", "btrace", "-o", folder.file("a")}).status, 0);
  EXPECT_EQ(run({"pairs", folder.file("a"), "--format", "BTRACE", "--count"}).output, "0\n");
}

TEST(ConvertVerb, AddsToWhatAnOpenDescriptorAppendsTo) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", tenths);
  const std::string log = folder.put("log.csv", "old\n");
  for (const std::string device : {"/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
    const std::string to = " --to csv -o " + device;
    EXPECT_EQ(shell("$BROADSIDE convert " + file + to + " >> " + log).status, 0) << device;
    EXPECT_THAT(shell("$BROADSIDE convert " + file + to + " | cat").output, HasSubstr("0.1,0,1,1\n"))
        << device;
  }
  EXPECT_EQ(shell("$BROADSIDE pairs " + file + " -o /dev/fd/3 3>> " + log).status, 0);
  const std::string text = text_of(log);
  EXPECT_THAT(text, AllOf(StartsWith("old\n"), EndsWith("2,2,2.5,3.7\nfirst,second\n")));
  EXPECT_EQ(text.size(), 4 + 3 * run({"convert", file, "--to", "csv", "-o", "-"}).output.size() + 13);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"boxes.csv", "log.csv"}));
}

TEST(ConvertVerb, KeepsIdsAndNamesTheColumnsItLeavesOut) {
  const TemporaryFolder folder;
  const std::string file = folder.put("named.csv",
                                      "ID,name,min_x,min_y,max_x,max_y,area\n"
                                      "7,\"a, \"\"b\"\"\",0,0,1,1,1\n"
                                      "7,c,2,2,3,3,1\n");
  const Ended kept = run({"convert", file, "--to", "csv", "-o", "-"});
  EXPECT_EQ(kept.output, "id,min_x,min_y,max_x,max_y\n7,0,0,1,1\n7,2,2,3,3\n");
  EXPECT_THAT(kept.errors,
              HasSubstr("left out the columns 'name', 'area': format csv holds bounds and ids (--ids)\n"));
  EXPECT_EQ(run({"convert", file, "--ids", "name", "--to", "csv", "-o", "-"}).output,
            "id,min_x,min_y,max_x,max_y\n\"a, \"\"b\"\"\",0,0,1,1\nc,2,2,3,3\n");
  const Ended dropped = run({"convert", file, "-o", folder.file("boxes.npy")});
  EXPECT_EQ(dropped.status, 0);
  EXPECT_THAT(dropped.errors,
              HasSubstr("left out the columns 'ID', 'name', 'area': format npy holds bounds"));
  EXPECT_THAT(run({"convert", folder.put("plain.csv", tenths), "-o", folder.file("a.csv")}).errors,
              Not(HasSubstr("left out")));
  EXPECT_THAT(
      run({"convert", BROADSIDE_SOURCE_DIR "/tests/fuzz/corpus/npy/fields.npy", "--to", "csv", "-o", "-"})
          .errors,
      HasSubstr("fields.npy: has named fields; expected numbers: python3 -c "));
  expect_refused("convert", {{{file, "--ids", "id", "-o", folder.file("b.npy")},
                              {"--ids with format npy", "expected csv"}}});
}

TEST(ConvertVerb, KeepsTheIdsOfBoxesThatMove) {
  const TemporaryFolder folder;
  const std::string text =
      "frame,box,id,min_x,min_y,max_x,max_y\n"
      "0,0,red,0,0,1,1\n"
      "1,0,red,1,0,2,1\n"
      "1,1,blue,5,5,6,6\n"
      "2,,,,,,\n";
  EXPECT_EQ(run({"convert", folder.put("moving.csv", text), "--to", "csv", "-o", "-"}).output, text);
}

TEST(ConvertVerb, LeavesNothingWhereAFileGrowsTooLarge) {
  const TemporaryFolder folder;
  const Ended ended = shell("ulimit -f 1; $BROADSIDE scene uniform -n 10000 -o " + folder.file("boxes.csv"));
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(folder.names(), std::vector<std::string>{});
}

TEST(ConvertVerb, LeavesNothingBehindThatIsNotWhole) {
  const TemporaryFolder folder;
  const std::string good = folder.put("good.csv", tenths);
  const std::string late = folder.put("late.csv",
                                      "frame,box,min_x,min_y,max_x,max_y\n"
                                      "0,0,0,0,1,1\n"
                                      "1,0,0,0,1,-1\n");
  const std::vector<Refusal> refusals = {
      {{good}, {"--output"}},
      {{good, "-o", good}, {"-o is '" + good, "the input", "expected another file"}},
      {{folder.file("missing.csv"), "-o", folder.file("out.csv")}, {"missing.csv", "No such file"}},
      {{late, "-o", folder.file("out.btrace")}, {"late.csv:3", "min <= max"}},
      {{late, "-o", folder.file("out.npy")}, {"late.csv:3", "min <= max"}},
      {{good, "-o", folder.file("out.ply")}, {"out.ply", "'.ply'", "can be written"}},
      {{good, "-o", folder.file("out.csv"), "--to", "mesh"}, {"'mesh'", "can be written"}},
      {{good, "-o", "-"}, {"standard output", "expected --to FORMAT, one of: ", "csv (.csv)"}},
      {{good, "-o", "/dev/full", "--to", "csv"}, {"/dev/full", "No space left"}},
      {{good, "-o", "/nowhere/out.csv"}, {"no folder '/nowhere'"}},
      {{good, "-o", folder.file("out.csv"), "--dimension", "3"}, {"good.csv", "2D"}},
  };
  expect_refused("convert", refusals);
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"good.csv", "late.csv"}));
}

TEST(ConvertVerb, ReadsWhatIsWholeOfATraceThatIsCutOff) {
  const TemporaryFolder folder;
  const std::string file = folder.file("moving.btrace");
  ASSERT_EQ(run({"scene", "churn", "-n", "50", "--frames", "6", "-o", file}).status, 0);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 5);
  const Ended ended = run({"convert", file, "-o", folder.file("whole.btrace")});
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(ended.errors, AllOf(HasSubstr("is cut off in frame 6"), HasSubstr("6 frames of ")));
}

}  // namespace
}  // namespace broadside::cli

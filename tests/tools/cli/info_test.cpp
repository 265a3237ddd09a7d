// broadside info: what it tells of a file.
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
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

TEST(InfoVerb, TellsCountBoundsExtentsAndSizes) {
  const TemporaryFolder folder;
  const Ended ended = run({"info", folder.put("boxes.csv",
                                              "min_x,min_y,max_x,max_y\n"
                                              "0,0,1,1\n"
                                              "-2,0,2,0\n"
                                              "7,7.1,7,7.1\n"
                                              "0,-inf,1,inf\n"
                                              ",,,\n")});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(
      ended.output,
      AllOf(HasSubstr("boxes.csv: csv, 5 boxes, 1 of them absent, in 2D, as doubles, 1 frame\n"),
            HasSubstr("  14 coordinates: 12 whole, 12 exactly floats"),
            HasSubstr("  1 point, 1 flat (without extent on some axis, but not on all), 1 infinite\n"),
            HasSubstr("  read in "), HasSubstr("  1 point left out\n  1 infinite box left out\n"),
            Not(HasSubstr(" boxes a second\n")), Not(HasSubstr("frames after"))));
  EXPECT_THAT(ended.output, testing::ContainsRegex("\n  x +-2 +7 +0 +0 +1 +1 +1 +4 +4\n"));
  EXPECT_THAT(ended.output, testing::ContainsRegex("\n +1 to 2 +1 +#+\n +2 to 4 +0\n +4 to 8 +1 +#+\n"));
}

TEST(InfoVerb, TellsBoundsToTheLastDigit) {
  const TemporaryFolder folder;
  const std::string file = folder.put("utm.csv", "412345.125,5654321.75,412350.5,5654330.0625\n");
  EXPECT_THAT(run({"info", file}).output, AllOf(testing::ContainsRegex("\n  x +412345.125 +412350.5 "),
                                                testing::ContainsRegex("\n  y +5654321.75 +5654330.0625 ")));
  const std::string tenth = folder.put("tenth.csv", "0.1,0,0.3,1\n");
  const std::string trace = folder.file("tenth.btrace");
  ASSERT_EQ(run({"convert", tenth, "-o", trace}).status, 0);
  EXPECT_THAT(run({"info", trace, "--precision", "float"}).errors,
              HasSubstr("tenth.btrace: 2 of 4 coordinates were rounded to float"));
  EXPECT_THAT(run({"info", tenth, "--precision", "float"}).output,
              testing::ContainsRegex("\n  x +0.1 +0.3 "));
}

TEST(InfoVerb, TellsHowBoxesMove) {
  const TemporaryFolder folder;
  const Ended ended = run({"info", folder.put("moving.csv",
                                              "frame,box,min_x,min_y,max_x,max_y\n"
                                              "0,0,0,0,1,1\n"
                                              "0,1,5,5,6,6\n"
                                              "1,0,1,1,2,2\n"
                                              "1,2,3,3,4,4\n"
                                              "2,1,,,,\n"
                                              "3,,,,,\n")});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, AllOf(HasSubstr("moving.csv: csv, 3 boxes in 2D, as doubles, 4 frames\n"),
                                  HasSubstr("  3 frames after the first: in a frame, 0 % of the boxes move "
                                            "(median; 0 % to 50 %); in all, 1 added, 1 removed\n")));
}

TEST(InfoVerb, ReadsEveryFormatAndAPipe) {
  const TemporaryFolder folder;
  for (const std::string name : {"a.csv", "b.btrace", "c.npy"}) {
    ASSERT_EQ(run({"scene", "integers", "-n", "100", "--dimension", "3", "-o", folder.file(name)}).status, 0);
    const Ended ended = run({"info", folder.file(name)});
    EXPECT_EQ(ended.status, 0) << ended.errors;
    EXPECT_THAT(ended.output,
                AllOf(HasSubstr(", 100 boxes in 3D, as "), HasSubstr("all whole"), HasSubstr("  read in ")));
  }
  const Ended piped = shell("cat " + folder.file("b.btrace") + " | $BROADSIDE info -");
  EXPECT_THAT(piped.output, HasSubstr("standard input: trace, 100 boxes in 3D, as floats, 1 frame\n"));
}

TEST(InfoVerb, SaysWhatIsMissingOfADamagedFileAndTellsTheRest) {
  const TemporaryFolder folder;
  const std::string file = folder.file("moving.btrace");
  ASSERT_EQ(run({"scene", "churn", "-n", "50", "--frames", "6", "-o", file}).status, 0);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 5);
  const Ended ended = run({"info", file});
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(ended.errors, HasSubstr("is cut off in frame 6"));
  EXPECT_THAT(ended.output, HasSubstr(", 6 frames\n"));
}

TEST(InfoVerb, RefusesWhatItCannotReadAndSaysWhy) {
  const TemporaryFolder folder;
  const std::vector<Refusal> refusals = {
      {{}, {"file"}},
      {{folder.file("missing.csv")}, {"missing.csv", "No such file"}},
      {{"/"}, {"Is a directory"}},
      {{folder.put("empty.csv", "")}, {"empty.csv", "empty"}},
      {{folder.put("noise.bin", std::string(300, '\1'))}, {"noise.bin", "no format known here"}},
      {{folder.put("cut.npy", "\x93NUMPY")}, {"cut.npy"}},
      {{folder.put("words.csv", "min_x,min_y,max_x,max_y\n0,0,much,1\n")}, {"words.csv:2", "'much'"}},
  };
  expect_refused("info", refusals);
}

}  // namespace
}  // namespace broadside::cli

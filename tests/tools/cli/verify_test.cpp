// broadside verify: what it says of algorithms and of files.
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"
#include "refusal.hpp"
#include "tests/support/recorded.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(VerifyVerb, ChecksEveryFrameOfAFileWithEveryAlgorithm) {
  const TemporaryFolder folder;
  const std::string file = folder.file("moving.btrace");
  ASSERT_EQ(run({"scene", "churn", "-n", "50", "--frames", "6", "-o", file}).status, 0);
  const Ended ended = run({"verify", file});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, AllOf(HasSubstr("in 2D, as floats, 7 frames, "),
                                  HasSubstr("  grid                   verified  against the definition\n"),
                                  HasSubstr("  paper_quadtree         verified  against the definition\n")));
  EXPECT_THAT(ended.errors, IsEmpty());
  EXPECT_EQ(folder.names(), std::vector<std::string>{"moving.btrace"});
}

TEST(VerifyVerb, ChecksInThePrecisionOfTheInputFromAPipeToo) {
  const Ended ended = shell(
      "$BROADSIDE scene uniform -n 500 --dimension 3 -o - --to csv | "
      "$BROADSIDE verify - --algorithms own,paper_grid");
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, AllOf(HasSubstr("standard input: 500 boxes in 3D, as doubles, 1 frame, "),
                                  ContainsRegex("  paper_grid +skipped   does not support 3D\n")));
}

TEST(VerifyVerb, EndsWithStatusOneWhereNothingIsVerified) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", "min_x,min_y,min_z,max_x,max_y,max_z\n0,0,0,1,1,1\n");
  const Ended ended = run({"verify", file, "--algorithms", "paper_grid"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.output, AllOf(HasSubstr("1 frame\n"), HasSubstr("nothing was verified")));
  const Ended compared = run({"compare", "--scenes", file, "--dimension", "3", "--algorithms", "paper_grid"});
  EXPECT_EQ(compared.status, 1);
  EXPECT_THAT(compared.output,
              HasSubstr("nothing was verified\nleft out: 1 measurement (1 'does not support 3D')\n"));
}

TEST(VerifyVerb, SaysWhatItDidNotRead) {
  const TemporaryFolder folder;
  const std::string file = folder.file("moving.btrace");
  ASSERT_EQ(run({"scene", "churn", "-n", "50", "--frames", "6", "-o", file}).status, 0);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) - 5);
  const Ended ended = run({"verify", file, "--algorithms", "grid"});
  EXPECT_EQ(ended.status, 0);
  EXPECT_THAT(ended.errors, HasSubstr("is cut off in frame 6"));
  EXPECT_THAT(ended.output, HasSubstr("6 frames"));
}

TEST(VerifyVerb, ChecksTheRecordedPairsOfAnEngine) {
  const TemporaryFolder folder;
  const std::string right = folder.put("right.btrace", falling_box(report_rightly));
  const Ended fine = run({"verify", right, "--algorithms", "grid"});
  EXPECT_EQ(fine.status, 0) << fine.output;
  EXPECT_THAT(fine.output,
              HasSubstr("  recorded pairs  verified  against the definition; margin 0.25, needed 0\n"));

  const std::string wrong = folder.put("wrong.btrace", falling_box([](Recorder2&, std::size_t) {}));
  const std::string small = folder.file("small.btrace");
  const Ended failed = run({"verify", wrong, "--algorithms", "grid", "--counterexample", small});
  EXPECT_EQ(failed.status, 1);
  EXPECT_THAT(failed.output, AllOf(HasSubstr("recorded pairs: frame 3, pair (0, 1) is missed"),
                                   HasSubstr("to see it again: broadside verify " + small)));
  EXPECT_EQ(run({"verify", small}).status, 1);

  const Ended refused = run({"verify", wrong, "--counterexample", folder.file("small.csv")});
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("small.csv: would hold recorded pairs"));
}

TEST(VerifyVerb, SaysWhereRecordedPairsAreLeftOut) {
  const TemporaryFolder folder;
  const std::string file = folder.put("a.btrace", falling_box(report_rightly));
  EXPECT_THAT(run({"convert", file, "-o", folder.file("a.csv")}).errors,
              HasSubstr("left out the recorded pairs: format csv holds boxes alone"));
  EXPECT_THAT(run({"scene", file, "-o", folder.file("b.btrace")}).errors,
              HasSubstr("left out the recorded pairs, which scenes do not have"));
  EXPECT_EQ(run({"convert", file, "-o", folder.file("c.btrace")}).status, 0);
  EXPECT_THAT(run({"info", folder.file("c.btrace")}).output, HasSubstr("  recorded pairs, margin 0.25: "));
}

TEST(VerifyVerb, RefusesWhatItCannotUseAndSaysWhy) {
  const TemporaryFolder folder;
  const std::string file = folder.put("boxes.csv", "min_x,min_y,max_x,max_y\n0,0,1,1\n");
  const std::string late = folder.put("late.csv",
                                      "frame,box,min_x,min_y,max_x,max_y\n"
                                      "0,0,0,0,1,1\n"
                                      "1,0,0,0,1,-1\n");
  const std::vector<Refusal> refusals = {
      {{}, {"file"}},
      {{folder.file("missing.csv")}, {"missing.csv", "No such file"}},
      {{"/"}, {"Is a directory"}},
      {{folder.put("empty.csv", "")}, {"empty.csv", "empty"}},
      {{late}, {"late.csv:3", "min <= max"}},
      {{file, "--algorithms", "gird"}, {"'gird'", "grid"}},
      {{file, "--budget", "0"}, {"--budget is 0", "above 0"}},
      {{file, "--counterexample", folder.file("out.ply")}, {"out.ply", "'.ply'"}},
      {{file, "--counterexample", "/nowhere/out.csv"}, {"no folder '/nowhere'"}},
  };
  expect_refused("verify", refusals);
}

}  // namespace
}  // namespace broadside::cli

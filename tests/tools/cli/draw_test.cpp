// broadside draw: the pictures it writes and what it refuses.
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "process.hpp"
#include "refusal.hpp"

namespace broadside::cli {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

TEST(DrawVerb, WritesAPictureOfASceneWithWhatAlgorithmsLayOverIt) {
  const TemporaryFolder folder;
  const std::string file = folder.file("grid.svg");
  const Ended ended =
      run({"draw", "uniform", "--algorithm", "grid,quadtree:capacity=16", "-n", "100", "-o", file});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_EQ(ended.output, "");
  EXPECT_THAT(ended.errors, HasSubstr("grid.svg: 100 of 100 boxes in 2D, "));
  EXPECT_THAT(folder.names(), ElementsAre("grid.svg"));
  EXPECT_THAT(text_of(file), AllOf(StartsWith("<svg "), HasSubstr(">grid</text>"),
                                   HasSubstr(">quadtree:capacity=16</text>"), EndsWith("</svg>\n")));
}

TEST(DrawVerb, DrawsAFileAndStandardInputInWhichBoxesAreAbsent) {
  const Ended ended =
      shell("printf '0,0,1,1\\n,,,\\n3,3,4,4\\n' | $BROADSIDE draw - --format csv --algorithm bvh -o -");
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, AllOf(HasSubstr("2 boxes in 2D"), HasSubstr(">1 leaf of up to 16 boxes")));
}

TEST(DrawVerb, DrawsThreeDimensionsFromThreeSides) {
  const Ended ended = run({"draw", "uniform", "--dimension", "3", "-n", "20", "-o", "-"});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, AllOf(HasSubstr(">uniform, x to the right, y up<"),
                                  HasSubstr(">uniform, x to the right, z up<"),
                                  HasSubstr(">uniform, y to the right, z up<")));
}

TEST(DrawVerb, DrawsOfAGroupThoseThatLaySomethingOverBoxes) {
  const Ended flat = run({"draw", "uniform", "-n", "30", "--algorithm", "all", "-o", "-"});
  EXPECT_EQ(flat.status, 0) << flat.errors;
  EXPECT_THAT(
      flat.output,
      AllOf(HasSubstr(">auto</text>"), HasSubstr(">quadtree</text>"), HasSubstr(">paper_quadtree</text>"),
            Not(HasSubstr("\"t\" y=\"15\">brute_force<")), Not(HasSubstr("nothing laid over the boxes"))));
  const Ended deep =
      run({"draw", "uniform", "-n", "30", "--dimension", "3", "--algorithm", "paper,brute_force", "-o", "-"});
  EXPECT_EQ(deep.status, 0) << deep.errors;
  EXPECT_THAT(deep.output, AllOf(HasSubstr(">paper_sweep_and_prune,"), Not(HasSubstr(">paper_grid,")),
                                 HasSubstr(">brute_force,"), HasSubstr(">nothing laid over the boxes<")));
}

TEST(DrawVerb, DrawsAFrameOfWhatMoves) {
  const TemporaryFolder folder;
  const std::string moving = folder.file("moving.csv");
  ASSERT_EQ(run({"scene", "uniform", "-n", "20", "--moving", "1", "--frames", "3", "--dimension", "2", "-o",
                 moving})
                .status,
            0);
  std::vector<std::string> pictures;
  for (const char* const frame : {"0", "1", "3"}) {
    const Ended ended = run({"draw", moving, "--frame", frame, "-o", "-"});
    EXPECT_EQ(ended.status, 0) << ended.errors;
    EXPECT_EQ(ended.output.find(std::string(", frame ") + frame) != std::string::npos, frame[0] != '0');
    pictures.push_back(ended.output);
  }
  EXPECT_EQ(run({"draw", moving, "-o", "-"}).output, pictures[0]);
  EXPECT_NE(pictures[1], pictures[0]);
  EXPECT_NE(pictures[2], pictures[1]);
  const Ended churn = run({"draw", "churn", "-n", "20", "--frame", "40", "--algorithm", "grid", "-o", "-"});
  EXPECT_EQ(churn.status, 0) << churn.errors;
  EXPECT_THAT(churn.output, HasSubstr(">churn, frame 40, "));

  expect_refused(
      "draw",
      {{{moving, "--frame", "4", "-o", "-"}, {"moving.csv", "--frame is 4", "expected 0 to 3", "4 frames"}},
       {{"uniform", "--frame", "1", "-o", "-"}, {"--frame is 1", "expected 0,", "has 1 frame"}},
       {{"churn", "--frame", "1000000000", "-o", "-"}, {"--frame is 1000000000", "at most 10000"}},
       {{moving, "--frame", "last", "-o", "-"}, {"--frame is 'last'", "expected"}}});
}

TEST(DrawVerb, RefusesWhatItCannotDraw) {
  expect_refused("draw", {{{"uniform", "-o", "-", "--algorithm", "tree"}, {"'tree'", "expected one of"}},
                          {{"uniform", "-o", "-", "--algorithm", "peers"}, {"'peers'", "expected"}},
                          {{"unifrom", "-o", "-"}, {"'unifrom'", "expected"}},
                          {{"uniform", "-o", "-", "-n", "1e6"}, {"-n is 1000000", "expected at most 20000"}},
                          {{"uniform", "-o", "-", "--algorithm", "paper_grid", "--dimension", "3"},
                           {"'paper_grid'", "does not support 3D", "expected --dimension 2"}},
                          {{"uniform", "-o", "/nowhere/at/all.svg"}, {"/nowhere/at/all.svg"}},
                          {{"uniform"}, {"--output"}}});
}

TEST(DrawVerb, DoesNotReplaceItsInput) {
  const TemporaryFolder folder;
  const std::string boxes = folder.file("boxes.csv");
  std::ofstream(boxes) << "0,0,1,1\n";
  for (const char* const verb : {"draw", "scene"})
    expect_refused(verb, {{{boxes, "-o", boxes}, {boxes, "which is the input", "expected another file"}}});
  EXPECT_EQ(text_of(boxes), "0,0,1,1\n");
}

}  // namespace
}  // namespace broadside::cli

// broadside draw: the pictures it writes and what it refuses.
#include <fstream>
#include <string>

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
using testing::StartsWith;

TEST(DrawVerb, WritesAPictureOfASceneWithWhatAlgorithmsLayOverIt) {
  const TemporaryFolder folder;
  const std::string file = folder.file("grid.svg");
  const Ended ended =
      run({"draw", "uniform", "--algorithm", "grid,quadtree:capacity=16", "-n", "100", "-o", file});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_EQ(ended.output, "");
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

TEST(DrawVerb, RefusesWhatItCannotDraw) {
  expect_refused("draw", {{{"uniform", "-o", "-", "--algorithm", "tree"}, {"'tree'", "expected one of"}},
                          {{"unifrom", "-o", "-"}, {"'unifrom'", "expected"}},
                          {{"uniform", "-o", "-", "-n", "1e6"}, {"-n is 1000000", "expected at most 20000"}},
                          {{"uniform", "-o", "-", "--algorithm", "paper_grid", "--dimension", "3"},
                           {"'paper_grid'", "does not do 3D", "expected --dimension 2"}},
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

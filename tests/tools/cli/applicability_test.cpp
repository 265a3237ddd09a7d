// Options that mean nothing to what they are given with: every verb refuses them.
#include <map>
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

class Applicability : public testing::Test {
 protected:
  const TemporaryFolder folder_;
  const std::string file_ = folder_.put("boxes.csv", "min_x,min_y,max_x,max_y\n0,0,1,1\n1,1,2,2\n");
  const std::string moving_ =
      folder_.put("moving.csv", "frame,box,min_x,min_y,max_x,max_y\n0,0,0,0,1,1\n1,0,1,1,2,2\n");
  const std::string out_ = folder_.file("out.csv");
};

// churn moves by itself, terdiman is the same for every seed.
TEST_F(Applicability, AnOptionForFilesIsRefusedWithAScene) {
  const std::map<std::string, std::vector<std::string>> calls = {
      {"compare", {"uniform"}},
      {"advise", {"uniform"}},
      {"scene", {"uniform", "-o", out_}},
      {"draw", {"uniform", "-o", folder_.file("out.svg")}}};
  for (const auto& [verb, call] : calls) {
    for (const std::vector<std::string>& option : {std::vector<std::string>{"--boxes", "1e3"},
                                                   {"--skip-invalid"},
                                                   {"--format", "csv"},
                                                   {"--columns", "a"},
                                                   {"--array", "a"}}) {
      std::vector<std::string> arguments = call;
      arguments.insert(arguments.end(), option.begin(), option.end());
      expect_refused(verb, {{arguments, {option[0], "'uniform'", "expected"}}});
    }
  }
}

TEST_F(Applicability, AnOptionWithoutEffectIsRefused) {
  const std::string svg = folder_.file("out.svg");
  const std::map<std::string, std::vector<Refusal>> refusals = {
      {"compare",
       {{{"uniform,churn", "--array", "a"}, {"--array is 'a' for scenes 'uniform' and 'churn'"}},
        {{file_, "-n", "100"}, {"-n is '100' for file", "a number of boxes of its own", "expected none"}},
        {{file_, "--seed", "3"}, {"--seed is '3'", "is the same for every seed"}},
        {{"terdiman", "--seed", "3"}, {"--seed is '3'"}},
        {{"churn", "--moving", "0.5"}, {"--moving is '0.5'", "moves by itself"}},
        {{"churn", "--frames", "2", "--drift", "1"}, {"--drift is '1'", "moves by itself"}},
        {{moving_, "--frames", "2", "--teleport", "1"}, {"--teleport is '1'", "moves by itself"}},
        {{"uniform", "--moving", "0", "--frames", "2"}, {"--frames 2 with --moving 0", "no box moves"}},
        {{"uniform", "--algorithms", "paper_quadtree,paper_grid", "--threads", "2"},
         {"--threads is '2'", "paper_quadtree,paper_grid"}},
        {{"uniform", "--long"}, {"--long", "expected it without"}}}},
      {"advise",
       {{{"uniform", "--precision", "double"}, {"--precision is 'double'", "is of floats"}},
        {{file_, "-n", "100"}, {"-n is '100'"}},
        {{file_, "--seed", "3"}, {"--seed is '3'"}},
        {{"churn", "--moving", "1"}, {"--moving is '1'"}},
        {{"churn", "--drift", "1"}, {"--drift is '1'"}},
        {{"churn", "--teleport", "1"}, {"--teleport is '1'"}},
        {{"uniform", "--moving", "0", "--drift", "1"}, {"--drift 1 with --moving 0"}},
        {{"uniform", "--algorithms", "paper_grid", "--threads", "1,2"},
         {"--threads is '1,2'", "paper_grid"}}}},
      {"scene",
       {{{file_, "-o", out_, "-n", "100"}, {"-n is '100'"}},
        {{file_, "-o", out_, "--seed", "2"}, {"--seed is '2'"}},
        {{"churn", "-o", out_, "--moving", "0.5"}, {"--moving is '0.5'"}},
        {{moving_, "-o", out_, "--drift", "0.5"}, {"--drift is '0.5'"}},
        {{"uniform", "-o", out_, "--drift", "0.5"}, {"--drift", "nothing moves", "expected --moving"}},
        {{"uniform", "-o", out_, "--moving", "0", "--frames", "3"}, {"--frames 3 with --moving 0"}}}},
      {"draw",
       {{{file_, "-o", svg, "--seed", "2"}, {"--seed is '2'"}},
        {{"uniform", "-o", svg, "--frame", "1"}, {"--frame is 1", "expected 0"}},
        {{"uniform", "-o", folder_.file("out.png")},
         {"out.png'", "expected", ".svg", "rsvg-convert -f png"}}}},
      {"info",
       {{{"uniform", "--skip-invalid"}, {"--skip-invalid for scene 'uniform'"}},
        {{file_, "-n", "5"}, {"-n is '5'"}},
        {{file_, "--seed", "5"}, {"--seed is '5'"}},
        {{"uniform", "--columns", "a"}, {"--columns is 'a'"}},
        {{file_, "--array", "a"}, {"no array 'a'"}}}},
      {"verify",
       {{{"uniform", "--skip-invalid"}, {"--skip-invalid for scene 'uniform'"}},
        {{file_, "-n", "5"}, {"-n is '5'"}},
        {{"uniform", "--boxes", "5"}, {"--boxes is '5'", "or -n 5"}},
        {{"uniform", "--precision", "double"}, {"--precision is 'double'"}},
        {{file_, "--boxes", "edges"}, {"boxes of 'edges' in format csv"}}}},
      {"convert", {{{file_, "-o", out_, "--array", "a"}, {"no array 'a'"}}}},
      {"pairs",
       {{{file_, "--count", "--order", "found"}, {"--order found with --count"}},
        {{file_, "--count", "--to", "npy"}, {"--to npy with --count"}},
        {{file_, "--left", "edges"}, {"--left", "without --swept"}},
        {{file_, "--algorithm", "paper_grid", "--threads", "2"}, {"--threads is 2", "paper_grid"}}}},
      {"list",
       {{{"grid"}, {"unexpected argument 'grid'"}}, {{"--boxes", "3"}, {"unknown option '--boxes'"}}}},
  };
  for (const auto& [verb, refused] : refusals) {
    SCOPED_TRACE(verb);
    expect_refused(verb, refused);
  }
  EXPECT_THAT(folder_.names(), testing::ElementsAre("boxes.csv", "moving.csv"));
}

TEST_F(Applicability, OfResultsAFileOfAnotherKindIsRefused) {
  expect_refused("compare", {{{"--json", "a.html"}, {"--json is 'a.html'", ".json"}},
                             {{"--report", "a.json"}, {"--report is 'a.json'", ".html"}}});
  expect_refused("advise", {{{"uniform", "--json", "a.pdf"}, {"--json is 'a.pdf'", ".json"}}});
}

TEST_F(Applicability, WhereSomeScenesTakeAnOptionTheOthersAreSaid) {
  const Ended ended = run({"compare", file_, "uniform", "-n", "100", "--seed", "3", "--columns",
                           "min_x,min_y,max_x,max_y", "--dimension", "2", "--algorithms", "grid"});
  EXPECT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.errors, AllOf(HasSubstr("-n is ignored by scene '" + file_ + "'"),
                                  HasSubstr("--seed is ignored by scene '" + file_ + "'"),
                                  testing::Not(HasSubstr("--columns"))));
  // Nobody asked for these scenes by name.
  EXPECT_THAT(run({"compare", "--seed", "3", "-n", "20", "--dimension", "2", "--algorithms", "grid"}).errors,
              IsEmpty());
}

}  // namespace
}  // namespace broadside::cli

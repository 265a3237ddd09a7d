// The law on files: that wrong algorithms are found, and shown on a file that is as small as can be.
#include "lab/verify/verify_file.hpp"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"

#include "lab/verify/verify_history.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"
#include "tests/support/wrong_algorithm.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class VerifyFile : public Files {
 protected:
  VerifyFile() {
    const auto add = [this](Algorithm wrong) {
      wrong.kind = AlgorithmKind::peer;
      catalogue_.add(std::move(wrong));
    };
    add(misses_per_pair());
    add(mistakes_per_pair());
    add(spoilt("forgets", [](std::vector<Pair>& pairs, std::size_t searches) {
      if (searches == 2) pairs.pop_back();
    }));
    add(spoilt("throws",
               [](std::vector<Pair>&, std::size_t) { throw std::runtime_error("no more memory cells"); }));
    options_.counterexample = path("small.csv");
  }

  /// A row of boxes, each of which touches the next.
  std::filesystem::path row(std::size_t count) const {
    std::string text = "min_x,min_y,max_x,max_y\n";
    for (std::size_t i = 0; i < count; ++i)
      text += std::to_string(i) + ".1,0," + std::to_string(i + 1) + ".1,1\n";
    return put("row.csv", text);
  }

  Verification verified(const std::filesystem::path& file, const std::string& algorithms,
                        const ReadOptions& read = {}) {
    options_.algorithms = algorithms;
    return verify_file(catalogue_, open_file(file, read), options_);
  }

  Catalogue catalogue_;
  VerifyOptions options_;
};

TEST_F(VerifyFile, PassesAlgorithmsThatAreRightAndWritesNothing) {
  const Verification verification = verified(row(300), "own,paper");
  EXPECT_TRUE(verification.all_verified());
  EXPECT_EQ(verification.pairs, 299u);
  EXPECT_EQ(verification.boxes, 300u);
  EXPECT_EQ(count_files(), 1u);
  EXPECT_THAT(lab::text_of(verification),
              AllOf(HasSubstr("row.csv: 300 boxes in 2D, as doubles, 1 frame, 299 pairs\n"),
                    HasSubstr("  grid                   verified  against the definition\n")));
}

TEST_F(VerifyFile, ShowsAMissingPairWithTheTwoBoxesThatMakeIt) {
  const Verification verification = verified(row(300), "grid,misses");
  EXPECT_FALSE(verification.all_verified());
  ASSERT_EQ(verification.verdicts.size(), 2u);
  EXPECT_EQ(verification.verdicts[0].outcome, Outcome::verified);
  EXPECT_THAT(verification.verdicts[1].reason, names("frame 0", "pair (298, 299)", "box 298", "(298.1, 0)",
                                                     "(299.1, 1)", "box 299", "(299.1, 0)", "(300.1, 1)"));
  ASSERT_TRUE(verification.counterexample);
  EXPECT_EQ(verification.counterexample->boxes, 2u);
  EXPECT_THAT(verification.counterexample->fault, HasSubstr("pair (0, 1) is missing"));
  EXPECT_EQ(verification.counterexample->command,
            "verify " + path("small.csv").string() + " --algorithms misses");
  EXPECT_THAT(lab::text_of(verification), AllOf(HasSubstr("  misses  FAILED    against the definition\n"),
                                                HasSubstr("small.csv: 2 boxes, on which misses fails\n"),
                                                HasSubstr("to see it again: broadside verify ")));
  // What was written is a file of its own, and shows the same.
  const Verification again = verified(path("small.csv"), "misses");
  EXPECT_FALSE(again.all_verified());
  EXPECT_EQ(again.boxes, 2u);
}

TEST_F(VerifyFile, LeavesAnOlderCounterexampleAlone) {
  const std::filesystem::path before = std::filesystem::current_path();
  row(300);
  std::filesystem::current_path(path(""));
  std::filesystem::rename("row.csv", "counterexample.csv");
  const std::string whole = text_of("counterexample.csv");
  options_.counterexample.clear();
  const Verification verification = verified("counterexample.csv", "misses");
  std::filesystem::current_path(before);
  ASSERT_TRUE(verification.counterexample);
  EXPECT_EQ(verification.counterexample->path, "counterexample_2.csv");
  EXPECT_EQ(text_of("counterexample.csv"), whole);
  EXPECT_EQ(count_files(), 2u);
}

TEST_F(VerifyFile, ChecksFloatsAsFloatsAndSaysSoInItsCommand) {
  const Verification verification = verified(row(300), "mistakes", {.precision = Precision::float32});
  ASSERT_TRUE(verification.counterexample);
  EXPECT_THAT(verification.verdicts[0].reason, HasSubstr("pair (0, 2) is reported; expected not to be"));
  EXPECT_THAT(verification.counterexample->command, HasSubstr("--algorithms mistakes --precision float"));
  EXPECT_NE(verification.counterexample->fault, "");
}

TEST_F(VerifyFile, ShowsAFailureThatTakesSeveralFramesAsFrames) {
  std::string text = "frame,box,min_x,min_y,max_x,max_y\n";
  for (int i = 0; i < 40; ++i)
    text += "0," + std::to_string(i) + "," + std::to_string(i) + ",0," + std::to_string(i + 1) + ",1\n";
  for (int frame = 1; frame < 10; ++frame) text += std::to_string(frame) + ",5,70,0,71,1\n";
  options_.counterexample = path("small.btrace");
  const Verification verification = verified(put("moving.csv", text), "forgets");
  EXPECT_EQ(verification.frames, 10u);
  EXPECT_EQ(verification.verdicts[0].frames, 3u);
  ASSERT_TRUE(verification.counterexample);
  EXPECT_EQ(verification.counterexample->frames, 3u);
  EXPECT_EQ(verification.counterexample->boxes, 2u);
  EXPECT_THAT(verification.counterexample->fault, HasSubstr("forgets: frame 2, search: pair (0, 1)"));
}

TEST_F(VerifyFile, TakesAnExceptionForAFailure) {
  const Verification verification = verified(row(50), "throws");
  EXPECT_EQ(verification.verdicts[0].reason, "throws threw: no more memory cells");
  ASSERT_TRUE(verification.counterexample);
  EXPECT_EQ(verification.counterexample->boxes, 2u);
}

TEST_F(VerifyFile, LeavesNothingWhereTheCounterexampleCannotBeWritten) {
  options_.counterexample = "/dev/full";
  EXPECT_THROW(verified(row(50), "misses"), FileError);
  EXPECT_EQ(count_files(), 1u);
}

TEST_F(VerifyFile, SkipsWhatWouldExceedTheBudgetAndSaysWhere) {
  const std::filesystem::path file = row(12'000);
  options_.budget_seconds = 1e-9;
  const Verification verification = verified(file, "brute_force");
  EXPECT_FALSE(verification.all_verified());
  EXPECT_FALSE(verification.pairs);
  EXPECT_THAT(lab::text_of(verification), AllOf(Not(HasSubstr(" pairs")), HasSubstr("nothing was verified")));
  EXPECT_EQ(verification.verdicts[0].outcome, Outcome::skipped);
  EXPECT_THAT(verification.verdicts[0].reason, AllOf(HasSubstr("estimated"), HasSubstr("budget 1e-09 s")));
}

TEST_F(VerifyFile, CountsNoPairsOfALastFrameThatNobodyReached) {
  const std::filesystem::path file =
      put("moving.csv",
          "frame,box,min_x,min_y,max_x,max_y\n0,0,0,0,1,1\n0,1,0,0,1,1\n1,0,5,5,6,6\n2,0,6,6,7,7\n");
  EXPECT_EQ(verified(file, "grid").pairs, 0u);
  const Verification stopped = verified(file, "throws");
  EXPECT_FALSE(stopped.pairs);
  EXPECT_THAT(lab::text_of(stopped), Not(HasSubstr("in the last")));
}

TEST_F(VerifyFile, RefusesAnUnknownAlgorithmBeforeItReads) {
  EXPECT_THROW(verified(put("bad.csv", "min_x,min_y,max_x,max_y\n1,1,0,0\n"), "gird"), InvalidSpec);
}

TEST(VerifyHistory, FindsTheFaultInAReferenceThatIsWrong) {
  // The last pair of a sorted set is not among the sampled ones; an entry that finds it is judged right.
  std::vector<Box2> boxes;
  for (int i = 0; i < 25'000; ++i) {
    const auto x = static_cast<float>(i);
    boxes.push_back({{x, 0}, {x + 1, 1}});
  }
  Algorithm wrong = misses_per_pair();
  wrong.name = "quadtree";
  const std::vector<Algorithm> known = {wrong};
  const Catalogue catalogue;
  const std::vector<Entry> entries = catalogue.select("grid");
  const HistoryVerdicts checked = verify_history<2, float>({boxes, {}}, entries, known, {});
  ASSERT_EQ(checked.verdicts.size(), 2u);
  EXPECT_EQ(checked.verdicts[0].outcome, Outcome::skipped);
  EXPECT_THAT(checked.verdicts[0].reason, HasSubstr("quadtree, which it was compared with, failed"));
  EXPECT_EQ(checked.verdicts[1].algorithm, "quadtree");
  EXPECT_EQ(checked.verdicts[1].outcome, Outcome::failed);
  EXPECT_THAT(checked.verdicts[1].reason, HasSubstr("pair (24998, 24999) is missing"));
}

TEST(VerifyHistory, SamplesAReferenceThatIsWrongInTheSameWayAsTheEntry) {
  std::vector<Box2> boxes;
  for (int i = 0; i < 25'000; ++i) {
    const auto x = static_cast<float>(i);
    boxes.push_back({{x, 0}, {x + 1, 1}});
  }
  const Algorithm blind = spoilt("blind", [](std::vector<Pair>& pairs, std::size_t) { pairs.clear(); });
  Algorithm reference = blind;
  reference.name = "quadtree";
  const std::vector<Algorithm> known = {reference};
  const std::vector<Entry> entries = {{&blind, Spec{"blind", {}}}};
  const HistoryVerdicts checked = verify_history<2, float>({boxes, {}}, entries, known, {});
  ASSERT_EQ(checked.verdicts.size(), 2u);
  EXPECT_NE(checked.verdicts[0].outcome, Outcome::verified);
  EXPECT_EQ(checked.verdicts[1].algorithm, "quadtree");
  EXPECT_EQ(checked.verdicts[1].outcome, Outcome::failed);
}

}  // namespace
}  // namespace broadside::lab

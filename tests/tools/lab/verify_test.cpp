// The law itself: that it sees every way in which an algorithm can be wrong.
#include "lab/verify/verify.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/boxes.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

const std::vector<Box2> chain = {{{0, 0}, {1, 1}}, {{1, 1}, {2, 2}}, {{2, 2}, {3, 3}}, {{5, 5}, {6, 6}}};

/// Reports the same pairs whatever the boxes.
class FixedSearcher final : public Searcher<2> {
 public:
  explicit FixedSearcher(Pairs pairs) : pairs_(std::move(pairs)) {}

  std::optional<Statistics> search(const SearchInput<2>&, PairSink& pairs) override {
    for (const Pair pair : pairs_) *pairs.room(1) = pair, pairs.commit(1);
    return std::nullopt;
  }

 private:
  Pairs pairs_;
};

// By a peer: whether a user's searcher writes pairs of two boxes is checked before the law sees them.
std::optional<PairDivergence> divergence_of(const Pairs& found) {
  const Algorithm fixed = {
      .name = "fixed",
      .summary = "",
      .source = "",
      .kind = AlgorithmKind::peer,
      .in_2d = {.searcher = [found](const Settings&) { return std::make_unique<FixedSearcher>(found); }}};
  Finder<2> finder(fixed, Spec("fixed"));
  return check_finder<2>(finder, chain, "fixed");
}

TEST(ReferencePairs, AreTheClosedOverlapsSorted) {
  EXPECT_EQ(reference_pairs<2>(chain), (Pairs{pair(0, 1), pair(1, 2)}));
}

TEST(ReferencePairs, LeaveOutAbsentBoxesEvenBesideInfiniteOnes) {
  const Box2 whole = {{-infinity, -infinity}, {infinity, infinity}};
  EXPECT_EQ(reference_pairs<2>(std::vector{whole, absent_box<2>(), whole, absent_box<2>()}),
            (Pairs{pair(0, 2)}));
}

TEST(CheckFinder, PassesTheRightPairsInAnyOrder) {
  EXPECT_FALSE(divergence_of({pair(0, 1), pair(1, 2)}).has_value());
  EXPECT_FALSE(divergence_of({pair(1, 2), pair(0, 1)}).has_value());
}

TEST(CheckFinder, SeesAMissingPair) {
  for (const Pairs& found : {Pairs{}, Pairs{pair(0, 1)}, Pairs{pair(1, 2)}}) {
    const auto divergence = divergence_of(found);
    ASSERT_TRUE(divergence.has_value());
    EXPECT_EQ(divergence->kind, PairDivergence::Kind::missing);
  }
}

TEST(CheckFinder, SeesAnExtraPairWhereverItSorts) {
  for (const Pair extra :
       {pair(0, 2), pair(1, 3), pair(2, 3), pair(1, 1), pair(0, 0), pair(1, 0), pair(0, 9)}) {
    const auto divergence = divergence_of({pair(0, 1), pair(1, 2), extra});
    ASSERT_TRUE(divergence.has_value());
    EXPECT_EQ(divergence->kind, PairDivergence::Kind::extra);
    EXPECT_EQ(divergence->pair, extra);
  }
}

TEST(CheckFinder, SeesARepeatedPair) {
  for (const Pair repeated : {pair(0, 1), pair(1, 2)}) {
    const auto divergence = divergence_of({pair(0, 1), pair(1, 2), repeated});
    ASSERT_TRUE(divergence.has_value());
    EXPECT_EQ(divergence->kind, PairDivergence::Kind::repeated);
    EXPECT_EQ(divergence->pair, repeated);
  }
}

TEST(CheckFinder, SaysWhoAndWhichPairAndWhere) {
  EXPECT_THAT(divergence_of({pair(0, 1)})->text,
              names("frame 0", "pair (1, 2)", "box 1", "(1, 1)", "(2, 2)", "box 2", "(3, 3)"));
}

/// Gives frame after frame the events it was made with.
class FixedFollower final : public Follower<2> {
 public:
  struct Events {
    Pairs begun;
    Pairs ended;
  };

  explicit FixedFollower(std::vector<Events> frames) : frames_(std::move(frames)) {}

  std::optional<Statistics> follow(const Change<2>&, PairSink& begun, PairSink& ended) override {
    for (const Pair pair : frames_[frame_].begun) begun.add(pair.first, pair.second);
    for (const Pair pair : frames_[frame_].ended) ended.add(pair.first, pair.second);
    ++frame_;
    return std::nullopt;
  }

 private:
  std::vector<Events> frames_;
  std::size_t frame_ = 0;
};

/// Box 1 leaves box 0 for box 3 (with which no one overlapped) and keeps box 2 behind.
const History<2> leaving = {chain, {Step<2>{4, {BoxId{1}}, {{{6, 6}, {7, 7}}}}, Step<2>{4, {}, {}}}};

std::optional<PairDivergence> tracking_divergence(const std::vector<FixedFollower::Events>& frames) {
  Tracker<2> tracker(std::make_unique<FixedFollower>(frames));
  return check_tracker<2>(tracker, leaving, "fixed");
}

TEST(CheckTracker, PassesTheRightEvents) {
  EXPECT_FALSE(
      tracking_divergence({{{pair(0, 1), pair(1, 2)}, {}}, {{pair(1, 3)}, {pair(0, 1), pair(1, 2)}}, {}}));
}

TEST(CheckTracker, SeesEventsThatAreMissingOrExtra) {
  const FixedFollower::Events first = {{pair(0, 1), pair(1, 2)}, {}};
  const FixedFollower::Events second = {{pair(1, 3)}, {pair(0, 1), pair(1, 2)}};
  using Kind = PairDivergence::Kind;
  const auto expect = [](const std::vector<FixedFollower::Events>& frames, Kind kind, std::size_t frame) {
    const auto divergence = tracking_divergence(frames);
    ASSERT_TRUE(divergence.has_value());
    EXPECT_EQ(divergence->kind, kind) << divergence->text;
    EXPECT_EQ(divergence->frame, frame) << divergence->text;
  };
  expect({{{pair(0, 1)}, {}}, second, {}}, Kind::missing, 0);
  expect({{first.begun, {pair(0, 1)}}, second, {}}, Kind::extra, 0);
  expect({first, {{}, second.ended}, {}}, Kind::missing, 1);
  expect({first, {second.begun, {pair(0, 1)}}, {}}, Kind::missing, 1);
  expect({first, second, {{pair(1, 3)}, {}}}, Kind::extra, 2);
  expect({first, second, {{}, {pair(0, 1)}}}, Kind::extra, 2);
}

TEST(CheckTracker, SeesNothingWrongInAnEventThatAnAlgorithmWritesTwice) {
  EXPECT_FALSE(tracking_divergence({{{pair(0, 1), pair(1, 2), pair(0, 1)}, {}},
                                    {{pair(1, 3)}, {pair(0, 1), pair(1, 2), pair(1, 2)}},
                                    {}}));
}

TEST(CheckTracker, SaysWhichFrameAndWhichEvent) {
  EXPECT_THAT(tracking_divergence({{{pair(0, 1), pair(1, 2)}, {}}, {{}, {pair(0, 1), pair(1, 2)}}, {}})->text,
              names("frame 1", "pair (1, 3)", "box 1", "(6, 6)", "(7, 7)", "box 3", "(5, 5)"));
}

}  // namespace
}  // namespace broadside::lab

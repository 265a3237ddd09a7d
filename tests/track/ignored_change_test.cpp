// IgnoredChange: events of pairs that become ignored or no longer are, and what a failed frame leaves.
#include "track/ignored_change.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/boxes.hpp"

namespace broadside::track {
namespace {

class IgnoredChangeTest : public testing::Test {
 protected:
  /// The events of a frame in which all three boxes overlap, as they did.
  void expect_events(const Pairs& begun, const Pairs& ended) {
    const std::vector<Box2> boxes(3, at(0));
    const Change<2> change{.before = boxes, .now = boxes, .changed = {}, .flags = {}};
    Pairs found_begun;
    Pairs found_ended;
    change_.apply(change, found_begun, found_ended);
    EXPECT_EQ(found_begun, begun);
    EXPECT_EQ(found_ended, ended);
  }

  IgnoredChange change_;
  IgnoredPairs ignored_;
};

TEST_F(IgnoredChangeTest, EndsPairsThatBecomeIgnoredAndBeginsThoseThatNoLongerAre) {
  ignored_.insert(pair(0, 1));
  change_.take(&ignored_, {}, false);
  expect_events({}, {pair(0, 1)});
  change_.insert();
  change_.keep();
  ignored_.erase(pair(0, 1));
  ignored_.insert(pair(1, 2));
  const Pairs listed = {pair(2, 1), pair(1, 0), pair(0, 1), pair(0, 2)};
  change_.take(&ignored_, listed, false);
  expect_events({pair(0, 1)}, {pair(1, 2)});
}

TEST_F(IgnoredChangeTest, SeesOnlyListedPairsUnlessItTakesAll) {
  change_.take(&ignored_, {}, false);
  change_.keep();
  ignored_.insert(pair(0, 2));
  change_.take(&ignored_, {}, false);
  expect_events({}, {});
  change_.take(&ignored_, {}, true);
  expect_events({}, {pair(0, 2)});
}

TEST_F(IgnoredChangeTest, TellsAgainWhatAFailedFrameOwes) {
  ignored_.insert(pair(0, 1));
  change_.take(&ignored_, {}, false);
  change_.insert();
  change_.undo_insert();
  EXPECT_EQ(change_.last(), nullptr);
  change_.take(&ignored_, {}, true);
  expect_events({}, {pair(0, 1)});
}

}  // namespace
}  // namespace broadside::track

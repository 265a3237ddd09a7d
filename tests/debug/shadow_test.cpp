// ShadowTracker: finds the first pair that a tracker reports wrongly, and shows how it came about.
#include "broadside/debug/shadow.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"
#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "lab/measure/memory.hpp"
#include "lab/scenes/motion.hpp"
#include "tests/support/message.hpp"
#include "tests/support/trackers.hpp"
#include "tests/support/wrong_algorithm.hpp"

namespace broadside {
namespace {

using testing::HasSubstr;

/// Brute force that forgets what changes places beyond the third, from some frame on.
class Forgetful final : public Follower<2> {
 public:
  explicit Forgetful(std::size_t from) : from_(from) {}

  std::optional<Statistics> follow(const Change<2>& change, PairSink& begun, PairSink& ended) override {
    const bool forgets = frames_++ >= from_;
    for (const BoxId a : change.changed) {
      if (forgets && index(a) > 2) continue;
      for (std::uint32_t b = 0; b < change.now.size(); ++b) {
        if (BoxId{b} != a) change.report(a, BoxId{b}, begun, ended);
      }
    }
    return std::nullopt;
  }

 private:
  std::size_t from_;
  std::size_t frames_ = 0;
};

Tracker<2> forgetful(std::size_t from) { return Tracker<2>(std::make_unique<Forgetful>(from)); }

/// Nine boxes in a row, of which one goes on in each frame, and the last one but one comes to the last.
History<2> row() {
  History<2> history{{}, {}};
  for (int i = 0; i < 9; ++i) history.boxes.push_back(at(static_cast<float>(10 * i)));
  for (std::uint32_t frame = 0; frame < 7; ++frame)
    history.steps.push_back({9, {BoxId{frame}}, {at(static_cast<float>(10 * frame + 2))}});
  history.steps.push_back({9, {BoxId{7}}, {at(79.5F)}});
  return history;
}

void play(ShadowTracker<2>& tracker, const History<2>& history) {
  Replay<2> replay(history);
  update(tracker, replay.frame());
  for (const Step<2>& step : history.steps) update(tracker, replay.next(step));
}

TEST(ShadowTracker, GivesTheEventsOfTheTrackerThatItRuns) {
  ShadowTracker<2> shadow("grid");
  const std::vector<Box2> first = {at(0), at(0.5F), at(5)};
  PairEvents events = update(shadow, {first, {}});
  EXPECT_EQ(events.begun, (Pairs{pair(0, 1)}));
  const std::vector<Box2> second = {at(5), at(0.5F), at(5)};
  const std::vector<BoxId> changed = {BoxId{0}};
  events = update(shadow, {second, changed});
  EXPECT_EQ(events.begun, (Pairs{pair(0, 2)}));
  EXPECT_EQ(events.ended, (Pairs{pair(0, 1)}));
}

TEST(ShadowTracker, FindsNoFaultInTheLibrarysTrackers) {
  for (const Algorithm& algorithm : algorithms()) {
    const lab::Churn churn{.boxes = 60, .frames = 30, .infinite_boxes = algorithm.limits.infinite_boxes};
    ShadowTracker<2> shadow(algorithm.name);
    EXPECT_NO_THROW(play(shadow, lab::random_history<2>(churn))) << algorithm.name;
  }
}

TEST(ShadowTracker, ThrowsTheFirstPairThatIsReportedWrongly) {
  ShadowTracker<2> shadow([] { return forgetful(1); });
  try {
    play(shadow, row());
    FAIL() << "nothing was thrown";
  } catch (const DivergenceOf<2>& divergence) {
    EXPECT_EQ(divergence.pair(), pair(7, 8));
    EXPECT_EQ(divergence.frame(), 8u);
    EXPECT_TRUE(divergence.holds());
    EXPECT_THAT(divergence.what(), HasSubstr("did not report that the pair (7, 8) began in frame 8"));
    EXPECT_THAT(divergence.what(), HasSubstr("box 7 has min (79.5, 0) and max (80.5, 1)"));
    EXPECT_THAT(divergence.what(), HasSubstr("box 8 has min (80, 0) and max (81, 1)"));
    EXPECT_THAT(divergence.what(), HasSubstr("the pair holds, and before this frame it did not"));
  }
}

TEST(ShadowTracker, ShowsTheSmallestHistoryOfAFault) {
  ShadowTracker<2> shadow([] { return forgetful(1); });
  try {
    play(shadow, row());
    FAIL() << "nothing was thrown";
  } catch (const DivergenceOf<2>& divergence) {
    ASSERT_TRUE(divergence.reproduced());
    // Two boxes beyond the first three, whose changes are forgotten, and one step.
    EXPECT_EQ(divergence.history().boxes.size(), 5u);
    ASSERT_EQ(divergence.history().steps.size(), 1u);
    EXPECT_EQ(divergence.history().steps[0].changed.size(), 1u);
    EXPECT_THAT(divergence.what(), HasSubstr("frame 0: 5 boxes\n  0: min ("));
    EXPECT_THAT(divergence.what(), HasSubstr("frame 1: 5 boxes, changed\n  3: min (79.5, 0)"));
    ShadowTracker<2> fails([] { return forgetful(1); });
    EXPECT_THROW(play(fails, divergence.history()), Divergence);
  }
}

TEST(ShadowTracker, ShowsWhatTheTwoBoxesDidWhereTheFaultTakesMoreThanWasKept) {
  ShadowTracker<2> shadow([] { return forgetful(4); }, {.frames = 2});
  try {
    play(shadow, row());
    FAIL() << "nothing was thrown";
  } catch (const DivergenceOf<2>& divergence) {
    EXPECT_FALSE(divergence.reproduced());
    EXPECT_EQ(divergence.history().boxes, (std::vector<Box2>{at(70), at(80)}));
    EXPECT_EQ(divergence.history().steps.size(), 2u);
    EXPECT_THAT(divergence.what(), HasSubstr("does not fail in the last 3 frames"));
  }
}

/// The bytes that a ShadowTracker has come to hold after many frames in which all boxes are listed.
std::optional<std::int64_t> bytes_held(const ShadowOptions& options) {
  std::vector<Box2> boxes;
  Ids all;
  for (std::uint32_t i = 0; i < 100; ++i) {
    boxes.push_back(at(static_cast<float>(3 * i)));
    all.push_back(BoxId{i});
  }
  const lab::AllocationMeter meter;
  ShadowTracker<2> shadow("brute_force", options);
  for (int frame = 0; frame < 100; ++frame) update(shadow, {boxes, all});
  const auto allocation = meter.read();
  return allocation ? std::optional(allocation->kept) : std::nullopt;
}

TEST(ShadowTracker, KeepsNoMoreBytesOfHistoryThanAllowed) {
  const auto limited = bytes_held({.bytes = 10'000});
  if (!limited) GTEST_SKIP() << "this build does not count allocations";
  EXPECT_LT(*limited + 100'000, *bytes_held({}));
}

TEST(ShadowTracker, ThrowsTheSameAgainOnceItHasDiverged) {
  ShadowTracker<2> shadow(forgetful(1));
  EXPECT_THROW(play(shadow, row()), Divergence);
  const std::vector<Box2> none;
  EXPECT_THAT(message_of<Divergence>([&] { update(shadow, {none, {}}); }), HasSubstr("in frame 8"));
}

TEST(ShadowTracker, SaysWhichPairsAreReportedThoughTheyDoNotHold) {
  const Algorithm wrong = lab::mistakes_per_pair();
  ShadowTracker<2> shadow([&] { return Tracker<2>(wrong, Spec{}); });
  const std::vector<Box2> boxes = {at(0), at(5), at(5.5F), at(20)};
  EXPECT_THAT(message_of<Divergence>([&] {
                update(shadow, {boxes, {}});
              }),
              HasSubstr("reported that the pair (0, 1) began in frame 0"));
}

TEST(ShadowTracker, RefusesAChangeThatIsNotListed) {
  ShadowTracker<2> shadow("grid");
  std::vector<Box2> boxes = {at(0), at(5)};
  update(shadow, {boxes, {}});
  boxes[1] = at(7);
  const std::string message = message_of<InvalidFrame>([&] { update(shadow, {boxes, {}}); });
  EXPECT_THAT(message, HasSubstr("frame 1: box 1 had min (5, 0) and max (6, 1), now has min (7, 0)"));
  EXPECT_THAT(message, HasSubstr("not listed"));
  boxes[1] = at(0);
  EXPECT_EQ(update(shadow, {boxes, {}}).begun, (Pairs{pair(0, 1)})) << "after a refusal all is taken anew";
}

TEST(ShadowTracker, RefusesAFilterThatIsNotListed) {
  ShadowTracker<2> shadow("grid");
  const std::vector<Box2> boxes = {at(0), at(0)};
  std::vector<Filter> filters(2);
  update(shadow, {boxes, {}, filters});
  filters[0].mask = 0;
  EXPECT_THAT(message_of<InvalidFrame>([&] {
                update(shadow, {boxes, {}, filters});
              }),
              HasSubstr("box 0 has a different filter"));
}

TEST(ShadowTracker, RefusesAnIgnoredPairThatIsNotListed) {
  ShadowTracker<2> shadow("grid");
  const std::vector<Box2> boxes = {at(0), at(0)};
  IgnoredPairs ignored;
  EXPECT_EQ(update(shadow, {boxes, {}, {}, &ignored}).begun.size(), 1u);
  ignored.insert(pair(0, 1));
  EXPECT_THAT(message_of<InvalidFrame>([&] {
                update(shadow, {boxes, {}, {}, &ignored});
              }),
              HasSubstr("the pair (0, 1)"));
  EXPECT_EQ(update(shadow, {boxes, {}, {}, &ignored}).ended.size(), 1u);
}

TEST(ShadowTracker, TakesFiltersAndIgnoredPairsAsOthersDo) {
  ShadowTracker<2> shadow("bvh");
  const std::vector<Box2> boxes = {at(0), at(0), at(0)};
  std::vector<Filter> filters(3);
  filters[2].mask = 0;
  IgnoredPairs ignored;
  ignored.insert(pair(0, 1));
  EXPECT_TRUE(update(shadow, {boxes, {}, filters, &ignored}).begun.empty());
  filters[2].mask = 1;
  ignored.clear();
  const std::vector<BoxId> changed = {BoxId{2}};
  const std::vector<Pair> toggled = {pair(0, 1)};
  EXPECT_EQ(update(shadow, {boxes, changed, filters, &ignored, toggled}).begun.size(), 3u);
}

TEST(ShadowTracker, DeliversAgainWhatASinkDidNotTake) {
  ShadowTracker<2> shadow("brute_force");
  std::vector<Box2> boxes = {at(0), at(5), at(20)};
  update(shadow, {boxes, {}});
  boxes[1] = at(0);
  const std::vector<BoxId> changed = {BoxId{1}};
  PairFunction full([](std::span<const Pair>) { throw std::length_error("full"); });
  PairCounter ended;
  EXPECT_THROW(shadow.update({boxes, changed}, full, ended), std::length_error);
  boxes[2] = at(0);
  const std::vector<BoxId> last = {BoxId{2}};
  EXPECT_EQ(update(shadow, {boxes, last}).begun, (Pairs{pair(0, 1), pair(0, 2), pair(1, 2)}));
}

TEST(ShadowTracker, StandsBehindAWorldThatAsksForIt) {
  World<2> world(forgetful(1), {.shadow = true});
  std::vector<Handle> handles;
  for (int i = 0; i < 5; ++i) handles.push_back(world.add(at(static_cast<float>(10 * i))));
  world.update();
  world.move(handles[0], at(1));
  world.update();
  world.move(handles[4], at(30));
  EXPECT_THROW(world.update(), Divergence);
}

TEST(ShadowTracker, FindsNoFaultInAWorld) {
  WorldOptions options;
  options.shadow = true;
  World<2> right(options);
  for (int i = 0; i < 5; ++i) right.add(at(0));
  EXPECT_EQ(right.update().begun.size(), 10u);
  EXPECT_GT(right.statistics().bytes.tracker, World<2>().statistics().bytes.tracker);
}

TEST(ShadowTracker, RefusesAnUnknownAlgorithm) {
  EXPECT_THROW(ShadowTracker<2>("nothing_of_that_name"), InvalidSpec);
}

}  // namespace
}  // namespace broadside

// Tracker: frames that grow and shrink, changes listed and not, frames that fail.
#include "broadside/tracker.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/sinks.hpp"

#include "tests/support/message.hpp"
#include "tests/support/trackers.hpp"

namespace broadside {
namespace {

/// Compares all boxes of a frame.
class ComparingSearcher final : public Searcher<2> {
 public:
  std::optional<Statistics> search(const SearchInput<2>& input, PairSink& pairs) override {
    Statistics statistics;
    for (std::uint32_t a = 0; a < input.boxes.size(); ++a) {
      for (std::uint32_t b = a + 1; b < input.boxes.size(); ++b, ++statistics.tests) {
        if (overlap(input.boxes[a], input.boxes[b])) pairs.add(BoxId{a}, BoxId{b});
      }
    }
    return statistics;
  }
};

/// A tracker that finds all pairs anew.
Tracker<2> diff_tracker() { return Tracker<2>(std::make_unique<ComparingSearcher>()); }

/// What a StubFollower was last shown, copied.
struct Seen {
  std::vector<Box2> before;
  std::vector<Box2> now;
  Ids changed;
  std::vector<std::uint8_t> flags;
  bool rebuild = false;

  StubFollower::Follow recorder() {
    return [this](const Change<2>& change, PairSink&, PairSink&) {
      before.assign(change.before.begin(), change.before.end());
      now.assign(change.now.begin(), change.now.end());
      changed.assign(change.changed.begin(), change.changed.end());
      flags.assign(change.flags.begin(), change.flags.end());
      rebuild = change.rebuild;
    };
  }
};

TEST(Tracker, TakesEveryBoxOfTheFirstFrameForChanged) {
  Seen seen;
  Tracker<2> tracker = stub_tracker(seen.recorder());
  update(tracker, {at(0), at(5)}, {});
  EXPECT_TRUE(seen.rebuild);
  EXPECT_EQ(seen.before, (std::vector<Box2>{absent_box<2>(), absent_box<2>()}));
  EXPECT_EQ(seen.now, (std::vector<Box2>{at(0), at(5)}));
  EXPECT_EQ(seen.changed, (Ids{BoxId{0}, BoxId{1}}));
  EXPECT_EQ(seen.flags, (std::vector<std::uint8_t>{1, 1}));
}

TEST(Tracker, ShowsAChangedBoxOnceHoweverOftenItIsListed) {
  Seen seen;
  Tracker<2> tracker = stub_tracker(seen.recorder());
  update(tracker, {at(0), at(5), at(9)}, {});
  update(tracker, {at(0), at(6), at(9)}, {BoxId{1}, BoxId{1}, BoxId{1}});
  EXPECT_FALSE(seen.rebuild);
  EXPECT_EQ(seen.before, (std::vector<Box2>{at(0), at(5), at(9)}));
  EXPECT_EQ(seen.now, (std::vector<Box2>{at(0), at(6), at(9)}));
  EXPECT_EQ(seen.changed, (Ids{BoxId{1}}));
  EXPECT_EQ(seen.flags, (std::vector<std::uint8_t>{0, 1, 0}));
}

TEST(Tracker, DoesNotSeeAChangeThatIsNotListed) {
  Seen seen;
  Tracker<2> tracker = stub_tracker(seen.recorder());
  update(tracker, {at(0), at(5)}, {});
  update(tracker, {at(3), at(6)}, {BoxId{1}});
  EXPECT_EQ(seen.now, (std::vector<Box2>{at(0), at(6)}));
}

TEST(Tracker, FillsUpTheShorterFrameWithAbsentBoxes) {
  Seen seen;
  Tracker<2> tracker = stub_tracker(seen.recorder());
  update(tracker, {at(0)}, {});
  update(tracker, {at(0), at(1), at(2)}, {});
  EXPECT_EQ(seen.before, (std::vector<Box2>{at(0), absent_box<2>(), absent_box<2>()}));
  EXPECT_EQ(seen.changed, (Ids{BoxId{1}, BoxId{2}}));
  update(tracker, {at(0)}, {BoxId{2}});
  EXPECT_EQ(seen.before, (std::vector<Box2>{at(0), at(1), at(2)}));
  EXPECT_EQ(seen.now, (std::vector<Box2>{at(0), absent_box<2>(), absent_box<2>()}));
  EXPECT_EQ(seen.changed, (Ids{BoxId{2}, BoxId{1}}));
  update(tracker, {at(0)}, {});
  EXPECT_EQ(seen.now, (std::vector<Box2>{at(0)}));
  EXPECT_TRUE(seen.changed.empty());
}

TEST(Tracker, SortsTheEventsOfItsAlgorithm) {
  Tracker<2> tracker = stub_tracker([](const Change<2>&, PairSink& begun, PairSink& ended) {
    begun.add(BoxId{2}, BoxId{1});
    begun.add(BoxId{0}, BoxId{5});
    begun.add(BoxId{0}, BoxId{3});
    ended.add(BoxId{9}, BoxId{8});
    ended.add(BoxId{9}, BoxId{4});
  });
  const PairEvents events = update(tracker, {}, {});
  EXPECT_EQ(events.begun, (Pairs{pair(0, 3), pair(0, 5), pair(1, 2)}));
  EXPECT_EQ(events.ended, (Pairs{pair(4, 9), pair(8, 9)}));
}

TEST(Tracker, WritesToOneSinkWhatBeganAndThenWhatEnded) {
  Tracker<2> tracker = diff_tracker();
  Pairs both;
  PairCollector sink(both);
  const std::vector<Box2> first = {at(0), at(1), at(9)};
  const std::vector<Box2> second = {at(0), at(9), at(9)};
  const Ids changed = {BoxId{1}};
  tracker.update({first, {}}, sink, sink);
  tracker.update({second, changed}, sink, sink);
  EXPECT_EQ(both, (Pairs{pair(0, 1), pair(1, 2), pair(0, 1)}));
}

TEST(Tracker, NamesTheFirstWrongBoxByItsPlaceInTheFrame) {
  Tracker<2> tracker = diff_tracker();
  update(tracker, {at(0), at(1), at(2)}, {});
  const Box2 wrong = {{nan, 0}, {1, 1}};
  const auto index_of = [&](const std::vector<Box2>& boxes, const Ids& changed) -> std::size_t {
    try {
      update(tracker, boxes, changed);
    } catch (const InvalidInput& error) {
      return error.index();
    }
    return 99;
  };
  EXPECT_EQ(index_of({at(0), at(1), at(2), at(3), wrong, wrong}, {}), 4u);
  EXPECT_EQ(index_of({at(0), wrong, at(2), at(3), wrong}, {BoxId{4}, BoxId{1}}), 1u);
  EXPECT_EQ(index_of({wrong, wrong, wrong}, {BoxId{2}, BoxId{0}, BoxId{1}}), 0u);
  EXPECT_EQ(index_of({wrong, at(1), at(2)}, {BoxId{1}}), 99u) << "a change that is not listed is not seen";
}

TEST(Tracker, RefusesAnIdBeyondThisFrameAndTheLast) {
  Tracker<2> tracker = diff_tracker();
  update(tracker, {at(0), at(1), at(2)}, {});
  EXPECT_NO_THROW(update(tracker, {at(0)}, {BoxId{2}}));
  EXPECT_THAT(message_of<InvalidFrame>([&] {
                update(tracker, {at(0), at(1)}, {BoxId{2}});
              }),
              names("box 2", "2 boxes"));
}

TEST(Tracker, IsUnchangedByAFrameThatWasRefused) {
  Tracker<2> tracker = diff_tracker();
  update(tracker, {at(0), at(1)}, {});
  const Box2 wrong = {{0, 0}, {1, -1}};
  EXPECT_THROW(update(tracker, {at(9), wrong, at(0)}, {BoxId{0}, BoxId{1}}), InvalidInput);
  EXPECT_THROW(update(tracker, {at(9), at(1), wrong}, {BoxId{0}}), InvalidInput);
  EXPECT_THROW(update(tracker, {at(9), at(1)}, {BoxId{0}, BoxId{2}}), InvalidFrame);
  const PairEvents rest = update(tracker, {at(0), at(1)}, {});
  EXPECT_TRUE(rest.begun.empty());
  EXPECT_TRUE(rest.ended.empty());
  EXPECT_EQ(update(tracker, {at(0), at(9)}, {BoxId{1}}).ended, (Pairs{pair(0, 1)}));
}

TEST(Tracker, DeliversTheEventsOfAFailedUpdateWithTheNext) {
  for (const bool begun_fails : {true, false}) {
    Tracker<2> tracker = diff_tracker();
    update(tracker, {at(0), at(1), at(9)}, {});

    const std::vector<Box2> boxes = {at(0), at(9), at(9), at(0)};
    const Ids changed = {BoxId{1}};
    Pairs taken;
    PairCollector collector(taken);
    FailingSink failing;
    PairSink& begun = begun_fails ? static_cast<PairSink&>(failing) : collector;
    PairSink& ended = begun_fails ? static_cast<PairSink&>(collector) : failing;
    EXPECT_THROW(tracker.update({boxes, changed}, begun, ended), std::runtime_error);

    // The caller need not list again what the failed frame had changed.
    const PairEvents events = update(tracker, boxes, {});
    EXPECT_EQ(events.begun, (Pairs{pair(0, 3), pair(1, 2)}));
    EXPECT_EQ(events.ended, (Pairs{pair(0, 1)}));
    const PairEvents rest = update(tracker, boxes, {});
    EXPECT_TRUE(rest.begun.empty());
    EXPECT_TRUE(rest.ended.empty());
  }
}

TEST(Tracker, TakesAShorterFrameAfterAFailedLongerOne) {
  Tracker<2> tracker = diff_tracker();
  update(tracker, {at(0), at(1)}, {});
  const std::vector<Box2> longer = {at(0), at(1), at(1), at(0)};
  FailingSink failing;
  PairCounter counter;
  EXPECT_THROW(tracker.update({longer, {}}, failing, counter), std::runtime_error);
  const PairEvents events = update(tracker, {at(0)}, {});
  EXPECT_TRUE(events.begun.empty());
  EXPECT_EQ(events.ended, (Pairs{pair(0, 1)}));
  EXPECT_EQ(update(tracker, {at(0), at(1)}, {}).begun, (Pairs{pair(0, 1)}));
}

TEST(Tracker, ChecksEveryBoxAfterAFailedUpdate) {
  Tracker<2> tracker = diff_tracker();
  update(tracker, {at(0), at(1)}, {});
  const std::vector<Box2> moved = {at(5), at(1)};
  const Ids changed = {BoxId{0}};
  FailingSink failing;
  PairCounter counter;
  EXPECT_THROW(tracker.update({moved, changed}, counter, failing), std::runtime_error);
  EXPECT_THROW(update(tracker, {at(5), {{nan, 0}, {1, 1}}}, {}), InvalidInput);
  EXPECT_EQ(update(tracker, {at(5), at(1)}, {}).ended, (Pairs{pair(0, 1)}));
}

TEST(Tracker, RebuildsAfterItsAlgorithmThrew) {
  bool fails = false;
  Seen seen;
  Tracker<2> tracker =
      stub_tracker([&, record = seen.recorder()](const Change<2>& change, PairSink& begun, PairSink& ended) {
        if (fails) throw std::runtime_error("out of luck");
        record(change, begun, ended);
      });
  update(tracker, {at(0), at(1)}, {});
  fails = true;
  EXPECT_THROW(update(tracker, {at(0), at(2)}, {BoxId{1}}), std::runtime_error);
  fails = false;
  update(tracker, {at(0), at(3)}, {});
  EXPECT_TRUE(seen.rebuild);
  EXPECT_EQ(seen.before, (std::vector<Box2>{at(0), at(1)}));
  EXPECT_EQ(seen.now, (std::vector<Box2>{at(0), at(3)}));
}

TEST(FindAnew, TellsWhatBeganAndWhatEnded) {
  Tracker<2> tracker = diff_tracker();
  EXPECT_EQ(update(tracker, {at(0), at(1), at(9)}, {}).begun, (Pairs{pair(0, 1)}));
  const PairEvents events = update(tracker, {at(0), at(8), at(9)}, {BoxId{1}});
  EXPECT_EQ(events.begun, (Pairs{pair(1, 2)}));
  EXPECT_EQ(events.ended, (Pairs{pair(0, 1)}));
}

TEST(FindAnew, IsSilentWhereAListedBoxDidNotChangeOrItsPairsDidNot) {
  Tracker<2> tracker = diff_tracker();
  update(tracker, {at(0), at(1)}, {});
  EXPECT_TRUE(update(tracker, {at(0), at(1)}, {BoxId{0}, BoxId{1}}).begun.empty());
  const PairEvents events = update(tracker, {at(0), at(0.5f)}, {BoxId{1}});
  EXPECT_TRUE(events.begun.empty());
  EXPECT_TRUE(events.ended.empty());
}

TEST(FindAnew, EndsThePairsOfABoxThatGoesEvenWithInfiniteOnes) {
  const Box2 whole = {{-infinity, -infinity}, {infinity, infinity}};
  Tracker<2> tracker = diff_tracker();
  EXPECT_EQ(update(tracker, {whole, at(1)}, {}).begun, (Pairs{pair(0, 1)}));
  EXPECT_EQ(update(tracker, {whole, absent_box<2>()}, {BoxId{1}}).ended, (Pairs{pair(0, 1)}));
  EXPECT_EQ(update(tracker, {whole, at(1)}, {BoxId{1}}).begun, (Pairs{pair(0, 1)}));
}

TEST(FindAnew, PassesOnTheCountsOfItsSearcher) {
  Tracker<2> tracker = diff_tracker();
  const std::vector<Box2> boxes = {at(0), at(1), at(9)};
  PairCounter none;
  const std::optional<Statistics> statistics = tracker.update({boxes, {}}, none, none);
  ASSERT_TRUE(statistics.has_value());
  EXPECT_EQ(statistics->tests, 3u);
}

TEST(Tracker, RefusesANullSearcherOrFollower) {
  EXPECT_THROW(Tracker<2>(std::unique_ptr<Searcher<2>>()), std::invalid_argument);
  EXPECT_THROW(Tracker<2>(std::unique_ptr<Follower<2>>()), std::invalid_argument);
}

TEST(Tracker, IsAValueThatMoves) {
  Tracker<2> tracker("grid");
  update(tracker, {at(0), at(1)}, {});
  Tracker<2> other = std::move(tracker);
  EXPECT_EQ(update(other, {at(0), at(9)}, {BoxId{1}}).ended, (Pairs{pair(0, 1)}));
  tracker = std::move(other);
  EXPECT_EQ(update(tracker, {at(0), at(1)}, {BoxId{1}}).begun, (Pairs{pair(0, 1)}));
}

/// A searcher must not be asked to check boxes: in a frame that finds anew, it sees the present ones alone.
TEST(Tracker, ShowsItsSearcherPresentBoxesOnly) {
  Tracker<2> tracker = diff_tracker();
  EXPECT_EQ(update(tracker, {absent_box<2>(), at(0), absent_box<2>(), at(1)}, {}).begun, (Pairs{pair(1, 3)}));
}

TEST(Tracker, TellsFunctionsWhatBeganAndEnded) {
  Tracker<2> tracker("grid");
  std::vector<Box2> boxes(3, Box2{{0, 0}, {1, 1}});
  std::vector<Pair> begun;
  std::size_t ended = 0;
  const auto add = [&begun](Pair pair) { begun.push_back(pair); };
  const auto count = [&ended](std::span<const Pair> chunk) { ended += chunk.size(); };
  tracker.update({.boxes = boxes}, add, count);
  EXPECT_EQ(begun, find_pairs(boxes, {.algorithm = "brute_force"}));
  boxes[2] = absent_box<2>();
  const std::vector<BoxId> changed = {BoxId(2)};
  const auto fail = [](Pair) { throw std::runtime_error("full"); };
  EXPECT_THROW(tracker.update({.boxes = boxes, .changed = changed}, add, fail), std::runtime_error);
  EXPECT_EQ(ended, 0U);
  tracker.update({.boxes = boxes}, add, count);
  EXPECT_EQ(ended, 2U) << "the events since the last whole update";
}

}  // namespace
}  // namespace broadside

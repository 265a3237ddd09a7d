// Frames with filters and ignored pairs as a tracker's algorithm sees them, and what a tracker makes of what
// it writes.
#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"
#include "broadside/filter.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "tests/support/message.hpp"
#include "tests/support/rng.hpp"
#include "tests/support/trackers.hpp"

namespace broadside {
namespace {

/// Compares all boxes, and checks that what it is shown holds together: places that changed have a flag and
/// others have none, and whatever did not change is the same in both frames.
class CheckingFollower final : public Follower<2> {
 public:
  std::optional<Statistics> follow(const Change<2>& change, PairSink& begun, PairSink& ended) override {
    const std::size_t size = change.now.size();
    EXPECT_EQ(change.before.size(), size);
    EXPECT_EQ(change.flags.size(), size);
    EXPECT_EQ(change.filters_before.size(), change.filters_now.size());
    EXPECT_TRUE(change.filters_now.empty() || change.filters_now.size() == size);
    std::vector<std::uint8_t> flags(size, 0);
    for (const BoxId id : change.changed) {
      EXPECT_EQ(flags.at(id), 0) << "a place is listed twice";
      flags[id] = 1;
    }
    EXPECT_TRUE(std::equal(flags.begin(), flags.end(), change.flags.begin()));
    for (std::size_t i = 0; i < size; ++i) {
      if (flags[i] != 0) continue;
      EXPECT_EQ(change.before[i], change.now[i]);
      EXPECT_TRUE(change.filters_now.empty() || change.filters_before[i] == change.filters_now[i]);
    }
    changed_ = change.changed.size();
    rebuilt_ = change.rebuild;
    for (std::uint32_t a = 0; a < size; ++a) {
      for (std::uint32_t b = a + 1; b < size; ++b) {
        change.report(BoxId{a}, BoxId{b}, begun, ended);
        change.report(BoxId{b}, BoxId{a}, begun, ended);
      }
    }
    return std::nullopt;
  }

  std::size_t changed() const { return changed_; }
  bool rebuilt() const { return rebuilt_; }

 private:
  std::size_t changed_ = 0;
  bool rebuilt_ = false;
};

TEST(Filters, AcceptByBitsUnlessGroupsDecide) {
  const Filter standard;
  EXPECT_TRUE(accepts(standard, standard));
  const Filter a{.category = 2, .mask = 4};
  const Filter b{.category = 4, .mask = 2};
  const Filter c{.category = 4, .mask = 1};
  EXPECT_TRUE(accepts(a, b));
  EXPECT_FALSE(accepts(a, c)) << "each must want the other";
  EXPECT_FALSE(accepts(c, a));
  const auto of_group = [](Filter filter, std::int32_t group) {
    filter.group = group;
    return filter;
  };
  EXPECT_TRUE(accepts(of_group(a, 3), of_group(c, 3)));
  EXPECT_FALSE(accepts(of_group(a, -3), of_group(b, -3)));
  EXPECT_TRUE(accepts(of_group(a, -3), of_group(b, 3)));
  EXPECT_FALSE(accepts(of_group(a, 3), of_group(c, 4)));
}

TEST(Filters, StaticBoxesNeverMeetWhateverTheirGroup) {
  const Filter still{.group = 1, .is_static = true};
  const Filter moving{.group = 1};
  EXPECT_FALSE(accepts(still, still));
  EXPECT_TRUE(accepts(still, moving));
  EXPECT_TRUE(accepts(moving, still));
}

TEST(IgnoredPairs, AreCopiedAndMoved) {
  IgnoredPairs original;
  original.insert(pair(1, 2));
  IgnoredPairs copy = original;
  copy.insert(pair(3, 4));
  EXPECT_TRUE(copy.contains(pair(1, 2)));
  EXPECT_FALSE(original.contains(pair(3, 4)));
  original = copy;
  EXPECT_EQ(original.size(), 2U);
  const IgnoredPairs moved = std::move(copy);
  EXPECT_EQ(moved.size(), 2U);
  original.clear();
  EXPECT_TRUE(original.empty() && !original.contains(pair(1, 2)) && !original.erase(pair(1, 2)));
}

TEST(IgnoredPairs, TakePairsInEitherOrderAndNoBoxWithItself) {
  IgnoredPairs ignored;
  EXPECT_TRUE(ignored.insert(pair(5, 2)));
  EXPECT_FALSE(ignored.insert(pair(2, 5)));
  EXPECT_TRUE(ignored.contains(pair(2, 5)));
  EXPECT_TRUE(ignored.contains(pair(5, 2)));
  EXPECT_FALSE(ignored.insert(pair(3, 3)));
  EXPECT_FALSE(ignored.contains(pair(3, 3)));
  EXPECT_EQ(ignored.size(), 1u);
  ignored.for_each([](Pair seen) { EXPECT_EQ(seen, pair(2, 5)); });
  EXPECT_TRUE(ignored.erase(pair(5, 2)));
  EXPECT_TRUE(ignored.empty());
}

TEST(IgnoredPairs, AreASetHoweverManyComeAndGo) {
  Rng rng(1);
  IgnoredPairs ignored;
  std::set<Pair> model;
  for (int step = 0; step < 20'000; ++step) {
    // Few boxes, and few enough pairs at times that the table's runs of places are short and long.
    const auto a = static_cast<std::uint32_t>(rng.below(40));
    const auto b = static_cast<std::uint32_t>(rng.below(40));
    const Pair named = pair(a, b);
    const Pair ordered = pair(std::min(a, b), std::max(a, b));
    const bool inserts = rng.below(100) < (step / 2000 % 2 == 0 ? 70U : 30U);
    if (inserts)
      ASSERT_EQ(ignored.insert(named), a != b && model.insert(ordered).second) << "step " << step;
    else
      ASSERT_EQ(ignored.erase(named), model.erase(ordered) != 0) << "step " << step;
    ASSERT_EQ(ignored.size(), model.size());
    ASSERT_EQ(ignored.contains(named), model.contains(ordered));
    if (step % 100 != 0) continue;
    std::set<Pair> listed;
    ignored.for_each([&](Pair each) { EXPECT_TRUE(listed.insert(each).second); });
    ASSERT_EQ(listed, model) << "step " << step;
  }
  ignored.clear();
  EXPECT_TRUE(ignored.empty());
  EXPECT_FALSE(ignored.contains(pair(1, 2)));
}

TEST(Change, ReportsAPairToTheSinkItBelongsTo) {
  // Begins, ends, rests, never is; and by filters alone: begins and ends.
  Tracker<2> tracker = stub_tracker([](const Change<2>& change, PairSink& begun, PairSink& ended) {
    for (std::uint32_t i = 0; i < change.now.size(); i += 2)
      change.report(BoxId{i + 1}, BoxId{i}, begun, ended);
  });
  const Filter none{.mask = 0};
  const std::vector<Box2> before = {at(0), at(9), at(0), at(0), at(0), at(1),
                                    at(0), at(3), at(0), at(0), at(0), at(0)};
  const std::vector<Box2> now = {at(0), at(1), at(0), at(3), at(0), at(0),
                                 at(0), at(4), at(0), at(0), at(0), at(0)};
  std::vector<Filter> filters_before(12);
  std::vector<Filter> filters_now(12);
  filters_before[9] = none;
  filters_now[10] = none;
  Ids all;
  for (std::uint32_t i = 0; i < 12; ++i) all.push_back(BoxId{i});
  update(tracker, {before, {}, filters_before});
  EXPECT_EQ(update(tracker, {now, all, filters_now}),
            (PairEvents{.begun = {pair(0, 1), pair(8, 9)}, .ended = {pair(2, 3), pair(10, 11)}}));
}

TEST(Change, ShowsWhatItsListsSayInEveryFrame) {
  auto owned = std::make_unique<CheckingFollower>();
  const CheckingFollower& follower = *owned;
  Tracker<2> tracker(std::move(owned));
  std::vector<Box2> boxes = {at(0), at(0.5f), at(1), at(9)};
  const Pairs all_three = {pair(0, 1), pair(0, 2), pair(1, 2)};
  EXPECT_EQ(update(tracker, {boxes, {}}), (PairEvents{all_three, {}}));
  EXPECT_EQ(follower.changed(), 4u);
  EXPECT_TRUE(follower.rebuilt());

  EXPECT_EQ(update(tracker, {boxes, {}}), PairEvents());
  EXPECT_EQ(follower.changed(), 0u) << "a frame in which nothing changed shows nothing";
  EXPECT_FALSE(follower.rebuilt());

  boxes[1] = at(20);
  boxes.push_back(at(9));
  const Ids second = {BoxId{1}, BoxId{1}};
  EXPECT_EQ(update(tracker, {boxes, second}), (PairEvents{{pair(3, 4)}, {pair(0, 1), pair(1, 2)}}));
  EXPECT_EQ(follower.changed(), 2u);

  boxes.resize(2);
  EXPECT_EQ(update(tracker, {boxes, {}}), (PairEvents{{}, {pair(0, 2), pair(3, 4)}}));
  EXPECT_EQ(follower.changed(), 3u);

  boxes.resize(5, at(20));
  FailingSink failing;
  EXPECT_THROW(tracker.update({boxes, {}}, failing, failing), std::runtime_error);
  EXPECT_EQ(follower.changed(), 3u);
  boxes.pop_back();
  EXPECT_EQ(update(tracker, {boxes, {}}).begun, (Pairs{pair(1, 2), pair(1, 3), pair(2, 3)}));
  EXPECT_TRUE(follower.rebuilt());
  EXPECT_EQ(update(tracker, {boxes, {}}), PairEvents());
  EXPECT_EQ(follower.changed(), 0u) << "the flags of a failed frame are gone";
}

TEST(Change, ShowsTheSameWhetherOrNotAFrameListsEveryBoxInOrder) {
  auto owned = std::make_unique<CheckingFollower>();
  const CheckingFollower& follower = *owned;
  Tracker<2> tracker(std::move(owned));
  tracker.set_bad_input(BadInput::quarantine);
  std::vector<Box2> boxes = {at(0), at(5), at(5), at(9)};
  std::vector<Filter> filters(4);
  const Ids in_order = {BoxId{0}, BoxId{1}, BoxId{2}, BoxId{3}};
  const Ids out_of_order = {BoxId{3}, BoxId{1}, BoxId{2}, BoxId{0}};
  EXPECT_EQ(update(tracker, {boxes, {}, filters}), (PairEvents{{pair(1, 2)}, {}}));
  Box2 inverted = at(5);
  std::swap(inverted.min, inverted.max);
  for (const Ids& all : {in_order, out_of_order, in_order, in_order}) {
    boxes = {at(0), inverted, at(9), at(0)};
    EXPECT_EQ(update(tracker, {boxes, all, filters}), (PairEvents{{pair(0, 3)}, {pair(1, 2)}}));
    EXPECT_EQ(Ids(tracker.quarantined().begin(), tracker.quarantined().end()), (Ids{BoxId{1}}));
    filters[0].mask = 0;
    EXPECT_EQ(update(tracker, {boxes, all, filters}), (PairEvents{{}, {pair(0, 3)}}));
    boxes[1] = at(9);  // the others must be those of the frame before, whichever array had them
    EXPECT_EQ(update(tracker, {boxes, Ids{BoxId{1}}, filters}), (PairEvents{{pair(1, 2)}, {}}));
    EXPECT_TRUE(tracker.quarantined().empty());
    boxes[0] = at(9);
    filters[0] = {};
    FailingSink failing;
    EXPECT_THROW(tracker.update({boxes, all, filters}, failing, failing), std::runtime_error);
    boxes = {at(0), at(5), at(5), at(9)};
    EXPECT_EQ(update(tracker, {boxes, all, filters}), PairEvents());
    EXPECT_TRUE(follower.rebuilt());
    const Frame<2> last = tracker.last_frame();
    EXPECT_TRUE(std::equal(last.boxes.begin(), last.boxes.end(), boxes.begin(), boxes.end()));
    EXPECT_EQ(update(tracker, {boxes, all, filters}), PairEvents());
    EXPECT_FALSE(follower.rebuilt());
  }
}

TEST(Change, HoldsEveryBoxForChangedWhereFiltersBeginOrCeaseToBeGiven) {
  auto owned = std::make_unique<CheckingFollower>();
  const CheckingFollower& follower = *owned;
  Tracker<2> tracker(std::move(owned));
  const std::vector<Box2> boxes = {at(0), at(0), at(0)};
  std::vector<Filter> filters(3);
  filters[1].mask = 0;
  const Pairs all = {pair(0, 1), pair(0, 2), pair(1, 2)};
  const Pairs without_one = {pair(0, 1), pair(1, 2)};
  EXPECT_EQ(update(tracker, {boxes, {}}), (PairEvents{all, {}}));
  EXPECT_EQ(update(tracker, {boxes, {}, filters}), (PairEvents{{}, without_one}));
  EXPECT_EQ(follower.changed(), 3u);
  EXPECT_FALSE(follower.rebuilt());
  EXPECT_EQ(update(tracker, {boxes, {}, filters}), PairEvents());
  EXPECT_EQ(follower.changed(), 0u);
  EXPECT_EQ(update(tracker, {boxes, {}}), (PairEvents{without_one, {}}));
  EXPECT_EQ(follower.changed(), 3u);
  // The frame after, with every box listed, is taken in another way: CheckingFollower sees no filters in it
  // either.
  EXPECT_EQ(update(tracker, {boxes, Ids{BoxId{0}, BoxId{1}, BoxId{2}}}), PairEvents());
  filters.pop_back();
  EXPECT_THAT(message_of<InvalidFrame>([&] {
                update(tracker, {boxes, {}, filters});
              }),
              names("2 filters", "3 boxes"));
}

TEST(Change, TakesAFilterOfABoxThatIsListedAndOfNoOther) {
  auto owned = std::make_unique<CheckingFollower>();
  const CheckingFollower& follower = *owned;
  Tracker<2> tracker(std::move(owned));
  const std::vector<Box2> boxes = {at(0), at(0), at(0)};
  std::vector<Filter> filters(3);
  update(tracker, {boxes, {}, filters});
  filters[1].mask = 0;
  filters[2].mask = 0;
  const Ids changed = {BoxId{2}};
  EXPECT_EQ(update(tracker, {boxes, changed, filters}), (PairEvents{{}, {pair(0, 2), pair(1, 2)}}));
  EXPECT_EQ(follower.changed(), 1u);
}

TEST(Change, EndsPairsThatAreIgnoredAndBeginsThemAgain) {
  auto owned = std::make_unique<CheckingFollower>();
  const CheckingFollower& follower = *owned;
  Tracker<2> tracker(std::move(owned));
  std::vector<Box2> boxes = {at(0), at(0), at(0)};
  IgnoredPairs ignored;
  ignored.insert(pair(0, 1));
  const Pairs first = {pair(0, 1)};
  EXPECT_EQ(update(tracker, {boxes, {}, {}, &ignored}), (PairEvents{{pair(0, 2), pair(1, 2)}, {}}));
  ignored.clear();
  EXPECT_EQ(update(tracker, {boxes, {}, {}, &ignored}), PairEvents())
      << "a change that is not listed is not seen";
  EXPECT_EQ(update(tracker, {boxes, {}, {}, &ignored, first}), (PairEvents{first, {}}));
  ignored.insert(pair(0, 1));
  EXPECT_EQ(update(tracker, {boxes, {}, {}, nullptr}), PairEvents());
  EXPECT_EQ(update(tracker, {boxes, {}, {}, &ignored}), (PairEvents{{}, first}))
      << "a set that is new is whole";
  EXPECT_EQ(follower.changed(), 0u);
  EXPECT_EQ(update(tracker, {boxes, {}, {}, nullptr}), (PairEvents{first, {}}));

  // Ignored in the frame in which they would have begun, or end; and of boxes that are not there yet.
  boxes[1] = at(5);
  const Ids changed = {BoxId{1}};
  EXPECT_EQ(update(tracker, {boxes, changed, {}, &ignored}), (PairEvents{{}, {pair(0, 1), pair(1, 2)}}));
  boxes[1] = at(0);
  EXPECT_EQ(update(tracker, {boxes, changed, {}, &ignored}), (PairEvents{{pair(1, 2)}, {}}));
  ignored.insert(pair(7, 3));
  const Pairs later = {pair(7, 3), pair(3, 7)};
  EXPECT_EQ(update(tracker, {boxes, {}, {}, &ignored, later}), PairEvents());
  boxes.resize(8, at(50));
  EXPECT_EQ(update(tracker, {boxes, {}, {}, &ignored}).begun.size(), 9u);
}

TEST(Change, DeliversWhatFailedFramesChangedInFiltersAndIgnoredPairs) {
  Tracker<2> tracker(std::make_unique<CheckingFollower>());
  const std::vector<Box2> boxes = {at(0), at(0), at(0), at(0)};
  std::vector<Filter> filters(4);
  update(tracker, {boxes, {}, filters});
  IgnoredPairs ignored;
  ignored.insert(pair(0, 1));
  filters[3].mask = 0;
  FailingSink failing;
  const Ids changed = {BoxId{3}};
  EXPECT_THROW(tracker.update({boxes, changed, filters, &ignored}, failing, failing), std::runtime_error);
  EXPECT_EQ(update(tracker, {boxes, {}, filters, &ignored}),
            (PairEvents{{}, {pair(0, 1), pair(0, 3), pair(1, 3), pair(2, 3)}}));
  EXPECT_EQ(update(tracker, {boxes, {}, filters, &ignored}), PairEvents());
}

}  // namespace
}  // namespace broadside

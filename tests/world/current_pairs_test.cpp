// CurrentPairs against a plain set.
#include "world/current_pairs.hpp"

#include <algorithm>
#include <cstdint>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/drawn_boxes.hpp"

namespace broadside::world {
namespace {

/// A history of events, and what must hold after it.
class CurrentPairsTest : public testing::Test {
 protected:
  void add(const std::set<Pair>& toggled) {
    PairEvents events;
    for (const Pair pair : toggled) (expected_.contains(pair) ? events.ended : events.begun).push_back(pair);
    for (const Pair pair : events.ended) expected_.erase(pair);
    expected_.insert(events.begun.begin(), events.begun.end());
    pairs_.take(events, generations_, user_data_);
  }

  void check() {
    EXPECT_EQ(pairs_.size(), expected_.size());
    std::vector<HandlePair> handles;
    for (const Pair pair : expected_) handles.push_back(handles_of(pair, generations_));
    ASSERT_TRUE(std::ranges::equal(pairs_.pairs(generations_), handles));
  }

  CurrentPairs pairs_{true};
  std::set<Pair> expected_;
  std::vector<std::uint32_t> generations_ = std::vector<std::uint32_t>(100, 1);
  SlotColumn<std::uint64_t> user_data_;
};

TEST_F(CurrentPairsTest, AgreesWithAPlainSet) {
  Rng random(3);
  for (int i = 0; i < 500; ++i) {
    std::set<Pair> toggled;
    const std::size_t boxes = 2 + random.below(98);
    for (std::size_t count = random.below(i % 50 == 0 ? 3000 : 30); count > 0; --count)
      toggled.insert(random_pair(random, boxes));
    add(toggled);
    if (random.below(4) == 0) check();
  }
  check();
}

TEST_F(CurrentPairsTest, GivesAPairThatCameBackTheHandlesOfNow) {
  const Pair pair{BoxId{3}, BoxId{5}};
  add({pair, {BoxId{1}, BoxId{2}}, {BoxId{7}, BoxId{8}}});
  check();
  add({pair});
  generations_[3] = 2;
  add({pair});
  check();
}

TEST_F(CurrentPairsTest, TakesInALogThatHasGrownLong) {
  Rng random(4);
  for (int i = 0; i < 300; ++i) {
    std::set<Pair> toggled;
    for (int j = 0; j < 50; ++j) toggled.insert(random_pair(random, 100));
    add(toggled);
  }
  EXPECT_LE(pairs_.bytes(), 200'000u) << "15,000 events of at most 4,950 pairs";
  check();
}

TEST_F(CurrentPairsTest, TellsThePairsThatPersist) {
  const Pair old{BoxId{1}, BoxId{2}};
  const Pair fresh{BoxId{3}, BoxId{5}};
  add({old});
  add({fresh});
  const std::vector<HandlePair> expected = {{{1, 1}, {2, 1}}};
  EXPECT_TRUE(std::ranges::equal(pairs_.persisting(generations_), expected));
  add({});
  EXPECT_TRUE(std::ranges::equal(pairs_.persisting(generations_), pairs_.pairs(generations_)));
}

TEST_F(CurrentPairsTest, GivesEventsTheHandlesAndUserDataOfTheirBoxes) {
  add({{BoxId{1}, BoxId{2}}});
  EXPECT_TRUE(pairs_.events().begun_data.empty());
  user_data_.use(100);
  user_data_.set(5, 50);
  generations_[5] = 7;
  add({{BoxId{1}, BoxId{2}}, {BoxId{3}, BoxId{5}}});
  const Events events = pairs_.events();
  ASSERT_EQ(events.begun.size(), 1u);
  EXPECT_EQ(events.begun[0], (HandlePair{{3, 1}, {5, 7}}));
  EXPECT_EQ(events.begun_data[0], (UserDataPair{0, 50}));
  ASSERT_EQ(events.ended.size(), 1u);
  EXPECT_EQ(events.ended[0], (HandlePair{{1, 1}, {2, 1}}));
}

TEST(CurrentPairs, GivesBackTheMemoryOfABurstOfEvents) {
  constexpr std::uint32_t boxes = 10'000;
  const std::vector<std::uint32_t> generations(boxes + 1);
  CurrentPairs pairs(true);
  PairEvents events;
  for (std::uint32_t i = 0; i < boxes; ++i) events.begun.push_back({BoxId{i}, BoxId{i + 1}});
  pairs.take(events, generations, {});
  const std::size_t at_first = pairs.bytes();
  for (std::uint32_t i = 0; i < 40; ++i) {
    (i % 2 == 0 ? events.ended : events.begun).assign(1, {BoxId{7}, BoxId{8}});
    pairs.take(events, generations, {});
    ASSERT_EQ(pairs.events().begun.size(), i % 2);
  }
  EXPECT_LT(pairs.bytes(), at_first / 2);
  EXPECT_EQ(pairs.pairs(generations).size(), boxes);
}

TEST(CurrentPairs, CountsPairsThatItDoesNotKeep) {
  CurrentPairs pairs(false);
  const std::vector<std::uint32_t> generations(3);
  const std::vector<Pair> some = {{BoxId{0}, BoxId{1}}, {BoxId{0}, BoxId{2}}};
  PairEvents events{some, {}};
  pairs.take(events, generations, {});
  EXPECT_TRUE(events.empty());
  events.ended = {some[0]};
  pairs.take(events, generations, {});
  EXPECT_EQ(pairs.size(), 1u);
  pairs.shrink_to_fit();
  EXPECT_EQ(pairs.bytes(), sizeof(HandlePair)) << "one event";
}

}  // namespace
}  // namespace broadside::world

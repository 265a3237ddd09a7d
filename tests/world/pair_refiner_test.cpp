// PairRefiner: what becomes of a tracker's events.
#include "world/pair_refiner.hpp"

#include <cstddef>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace broadside::world {
namespace {

using Pairs = std::vector<Pair>;

constexpr Pair ab{BoxId{0}, BoxId{1}};
constexpr Pair bc{BoxId{1}, BoxId{2}};

/// Three boxes in a row, each a unit wide.
class PairRefinerTest : public testing::Test {
 protected:
  PairRefinerTest() {
    slots.reserve(3);
    boxes.reserve(3, false);
    boxes.reserve_changes(100);
    for (std::uint32_t slot = 0; slot < 3; ++slot) {
      slots.add();
      boxes.append();
      put(slot, 2.5F * static_cast<float>(slot));
    }
  }

  void put(std::uint32_t slot, float x) { boxes.set(slot, {{x, 0}, {x + 1, 1}}, nullptr); }

  /// An update in which the tracker tells these events.
  PairEvents update(PairRefiner& refiner, PairEvents events) {
    refiner.candidates() = std::move(events);
    PairEvents& refined = refiner.refine(boxes, slots.generations());
    PairEvents told = refined;
    refined.clear();
    refiner.settle();
    boxes.settle();
    return told;
  }

  SlotTable<2, float> slots{0};
  BoxTable<2, float> boxes{WorldOptions{.margin = 1}};
  PairRefiner by_boxes{true};
  PairRefiner by_predicate{false};
};

TEST_F(PairRefinerTest, LeavesTheTrackersEventsAsTheyAreWhereNothingIsRefined) {
  EXPECT_EQ(update(by_predicate, {{ab}, {}}).begun, (Pairs{ab}));
  EXPECT_FALSE(by_predicate.is_refining());
}

TEST_F(PairRefinerTest, TellsPairsWhenTheBoxesThemselvesMeetAndPart) {
  EXPECT_TRUE(update(by_boxes, {{ab, bc}, {}}).empty());
  put(1, 0.5F);
  EXPECT_EQ(update(by_boxes, {}).begun, (Pairs{ab}));
  EXPECT_TRUE(update(by_boxes, {}).empty());
  put(1, 2.5F);
  EXPECT_EQ(update(by_boxes, {}).ended, (Pairs{ab}));
}

TEST_F(PairRefinerTest, EndsAPairWithItsCandidate) {
  put(1, 0.5F);
  update(by_boxes, {{ab, bc}, {}});
  put(1, 50);
  const PairEvents told = update(by_boxes, {{}, {ab, bc}});
  EXPECT_EQ(told.ended, (Pairs{ab}));
  EXPECT_TRUE(told.begun.empty());
  EXPECT_EQ(by_boxes.state().graph.size(), 0u);
}

TEST_F(PairRefinerTest, AsksThePredicateOncePerPairUntilItIsToAskAgain) {
  int questions = 0;
  bool answer = false;
  PairPredicate predicate = [&](Handle, Handle) { return ++questions, answer; };
  by_predicate.swap_predicate(predicate);
  EXPECT_TRUE(update(by_predicate, {{ab, bc}, {}}).empty());
  update(by_predicate, {});
  EXPECT_EQ(questions, 2);
  answer = true;
  by_predicate.ask_again(0, slots.size());
  by_predicate.ask_again(0, slots.size());
  EXPECT_EQ(by_predicate.state().asked_slots.size(), 1u);
  EXPECT_EQ(update(by_predicate, {}).begun, (Pairs{ab}));
  EXPECT_EQ(questions, 3);
  by_predicate.ask_again();
  EXPECT_EQ(update(by_predicate, {}).begun, (Pairs{bc}));
}

TEST_F(PairRefinerTest, StopsRefiningWithoutAPredicate) {
  PairPredicate predicate = [](Handle, Handle) { return false; };
  by_predicate.swap_predicate(predicate);
  update(by_predicate, {{ab}, {}});
  PairPredicate none;
  by_predicate.swap_predicate(none);
  EXPECT_EQ(update(by_predicate, {}).begun, (Pairs{ab}));
  EXPECT_FALSE(by_predicate.is_refining());
}

TEST_F(PairRefinerTest, TellsNoEventTwiceAfterAPredicateThrew) {
  bool throws = true;
  PairPredicate predicate = [&](Handle, Handle) {
    if (throws) throw std::runtime_error("no answer");
    return true;
  };
  by_predicate.swap_predicate(predicate);
  by_predicate.candidates() = {{ab, bc}, {}};
  EXPECT_THROW(by_predicate.refine(boxes, slots.generations()), std::runtime_error);
  EXPECT_EQ(by_predicate.state().fresh.size(), 2u);
  throws = false;
  // What the tracker told before counts; in the meantime one of its pairs has ended.
  const PairEvents told = update(by_predicate, {{}, {bc}});
  EXPECT_EQ(told.begun, (Pairs{ab}));
  EXPECT_TRUE(told.ended.empty());
}

TEST_F(PairRefinerTest, KnowsWhatTheTrackerFound) {
  update(by_boxes, {{ab, bc}, {}});
  by_boxes.candidates() = {{}, {bc}};
  EXPECT_EQ(by_boxes.tracked({}), (Pairs{ab})) << "bc has ended, and no step has taken that yet";
  EXPECT_TRUE(by_boxes.held_edges().empty());
}

}  // namespace
}  // namespace broadside::world

// The events that a history must give, and how what differs is told.
#include "lab/measure/expected_events.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace broadside::lab {
namespace {

using testing::HasSubstr;

constexpr Pair pair_01{BoxId{0}, BoxId{1}};
constexpr Pair pair_02{BoxId{0}, BoxId{2}};
constexpr Pair pair_12{BoxId{1}, BoxId{2}};

/// Three boxes in a row, of which the first two touch; then the last comes to them and the first goes.
History<2> small_history() {
  History<2> history;
  history.boxes = {{{0, 0}, {1, 1}}, {{1, 0}, {2, 1}}, {{8, 0}, {9, 1}}};
  history.steps.push_back({3, {BoxId{2}}, {{{1, 1}, {2, 2}}}});
  history.steps.push_back({3, {BoxId{0}}, {absent_box<2>()}});
  return history;
}

const std::vector<FrameEvents> small_events = {
    {{pair_01}, {}}, {{pair_02, pair_12}, {}}, {{}, {pair_01, pair_02}}};

TEST(ExpectedEvents, AreThoseOfTheDefinition) {
  const Reference definition({}, algorithms(), 3, 10);
  const ExpectedEvents expected = expected_events(definition, small_history());
  EXPECT_EQ(expected.frames, small_events);
  EXPECT_EQ(expected.fault, "");
}

TEST(ExpectedEvents, AreTheSameFromAnotherReference) {
  const Reference other({}, algorithms(), 3, 2);
  ASSERT_FALSE(other.is_definition());
  const ExpectedEvents expected = expected_events(other, small_history());
  EXPECT_EQ(expected.frames, small_events);
  EXPECT_EQ(expected.fault, "");
}

std::uint64_t hash_of_all(const std::vector<FrameEvents>& frames) {
  EventHasher hasher;
  for (const FrameEvents& events : frames) hasher.add(events);
  return hasher.hash();
}

TEST(EventHasher, TellsFramesAndBeginningsAndEndsApart) {
  const std::uint64_t hash = hash_of_all({{{pair_01}, {}}, {{}, {}}});
  EXPECT_EQ(hash, hash_of_all({{{pair_01}, {}}, {{}, {}}}));
  EXPECT_NE(hash, hash_of_all({{{}, {pair_01}}, {{}, {}}}));
  EXPECT_NE(hash, hash_of_all({{{}, {}}, {{pair_01}, {}}}));
  EXPECT_NE(hash, hash_of_all({{{pair_02}, {}}, {{}, {}}}));
}

TEST(Difference, NamesFrameKindPairAndBoxes) {
  const std::vector<Box2> boxes = small_history().boxes;
  const FrameEvents expected{{pair_01}, {pair_12}};
  EXPECT_EQ(difference<2>(expected, expected, "mine", 4, boxes), "");
  const std::string missing = difference<2>({{pair_01}, {}}, expected, "mine", 4, boxes);
  EXPECT_THAT(missing, HasSubstr("mine: frame 4, ended: pair (1, 2) is missing"));
  EXPECT_THAT(missing, HasSubstr("box 2 is [(8, 0), (9, 1)]"));
  EXPECT_THAT(difference<2>({{pair_01, pair_01}, {pair_12}}, expected, "mine", 4, boxes),
              HasSubstr("begun: pair (0, 1) is reported more than once"));
}

TEST(Difference, TellsUnsortedEvents) {
  const std::vector<Box2> boxes = small_history().boxes;
  EXPECT_THAT(difference<2>({{pair_02, pair_01}, {}}, {{pair_01, pair_02}, {}}, "mine", 1, boxes),
              HasSubstr("events are not sorted by id"));
}

}  // namespace
}  // namespace broadside::lab

// FollowPolicy: when boxes are followed, in which structure, and when all pairs are found anew;
// EnlargePolicy: when boxes stay enlarged.
#include "track/update_policy.hpp"

#include <cstdint>
#include <limits>

#include <gtest/gtest.h>

namespace broadside::track {
namespace {

constexpr FindCosts finding = {.box = 50};
constexpr FollowCosts cheap = {.start = 10, .mover = 100, .mover_alone = 100, .test = 1, .further_test = 1};
constexpr FollowCosts dear = {.start = 10, .mover = 200, .mover_alone = 200, .test = 1, .further_test = 1};
constexpr std::size_t boxes = 10'000;

/// A policy whose structure has the boxes.
FollowPolicy started(std::vector<StructureCosts> structures = {{cheap}}) {
  FollowPolicy policy(Update::automatic, finding, std::move(structures));
  policy.followed(0, Statistics{});
  return policy;
}

TEST(FollowPolicy, FollowsUpToTheNumberOfChangesAtWhichFindingAnewCostsLess) {
  FollowPolicy policy = started();
  EXPECT_TRUE(policy.follows(boxes, 4'900, false));
  EXPECT_FALSE(policy.follows(boxes, 5'100, false));
  EXPECT_EQ(policy.break_even(), 5'000U);
}

TEST(FollowPolicy, FindsAnewWhereMoversMakeFarMoreTestsThanFindingDoes) {
  FollowPolicy policy = started();
  ASSERT_TRUE(policy.follows(boxes, 1'000, false));
  policy.followed(1'000, Statistics{.tests = 1'000 * 10'000});
  EXPECT_FALSE(policy.follows(boxes, 1'000, false));
}

TEST(FollowPolicy, ComesBackToFollowingOnceThatWouldHavePaid) {
  FollowPolicy policy = started();
  policy.found(boxes, 0, Statistics{});
  EXPECT_TRUE(policy.follows(boxes, 100, false)) << "much is saved at once";
  policy.found(boxes, 0, Statistics{});
  EXPECT_FALSE(policy.follows(boxes, 4'900, false)) << "little is saved in a frame";
}

TEST(FollowPolicy, TakesAnotherStructureWhereTheFirstMakesManyTests) {
  FollowPolicy policy = started({{cheap}, {dear}});
  policy.followed(1'000, Statistics{.tests = 1'000 * 500});
  for (int frame = 0; frame < 10 && policy.current() == 0; ++frame) policy.follows(boxes, 1'000, false);
  EXPECT_EQ(policy.current(), 1U);
}

TEST(FollowPolicy, GivesAFrameToAnotherStructureWhereTheFirstMakesTooManyTests) {
  FollowPolicy policy = started({{cheap}, {dear}});
  ASSERT_TRUE(policy.follows(boxes, 1'000, false));
  EXPECT_EQ(policy.max_tests(), 2 * boxes * 50);
  EXPECT_TRUE(policy.passed_max_tests(1'000, true));
  EXPECT_EQ(policy.current(), 1U);
  EXPECT_FALSE(policy.is_following()) << "it has to be built";
  EXPECT_FALSE(policy.passed_max_tests(1'000, true)) << "no other is left";
}

TEST(FollowPolicy, LimitsNoStructureThatIsToFollow) {
  FollowPolicy policy(Update::follow, finding, {{cheap}});
  policy.follows(boxes, boxes, true);
  EXPECT_EQ(policy.max_tests(), std::numeric_limits<std::uint64_t>::max());
}

TEST(FollowPolicy, DoesAsItIsTold) {
  EXPECT_TRUE(FollowPolicy(Update::follow, finding, {{cheap}}).follows(boxes, boxes, true));
  EXPECT_FALSE(FollowPolicy(Update::rebuild, finding, {{cheap}}).follows(boxes, 1, false));
}

constexpr StructureCosts comparing = {
    .costs = {.start = 1, .mover = 60, .mover_alone = 30, .test = 0.5, .further_test = 0.5},
    .max_boxes = 300};

TEST(FollowPolicy, ComparesAllWhereAStructureHasToLookAtItsPairsAgain) {
  FollowPolicy policy = started({{cheap}, comparing});
  policy.found(1'000, 500'000, Statistics{.tests = 500'000});
  policy.followed(1'000, Statistics{.tests = 300'000, .hits = 300'000});
  for (int frame = 0; frame < 10 && policy.current() == 0; ++frame) policy.follows(1'000, 1'000, false);
  EXPECT_EQ(policy.current(), 1U);
}

TEST(FollowPolicy, KeepsToTheStructureWhereOnlyItsTestsAreMany) {
  // 400 tests of a mover cost less than comparing it with 1,000 boxes.
  FollowPolicy policy = started({{cheap}, comparing});
  policy.followed(1'000, Statistics{.tests = 400'000});
  for (int frame = 0; frame < 10; ++frame) policy.follows(1'000, 1'000, false);
  EXPECT_EQ(policy.current(), 0U);
}

TEST(FollowPolicy, ComparesFewBoxesAndKeepsToItForSomeMore) {
  FollowPolicy policy = started({{cheap}, comparing});
  const auto are_few = [&policy](std::size_t count) {
    policy.follows(count, 10, false);
    return policy.are_few();
  };
  EXPECT_FALSE(are_few(comparing.max_boxes + 1));
  EXPECT_TRUE(are_few(comparing.max_boxes));
  EXPECT_TRUE(are_few(comparing.max_boxes + 1));
  EXPECT_FALSE(are_few(2 * comparing.max_boxes));
  EXPECT_FALSE(policy.is_following());
}

TEST(EnlargePolicy, StopsWhereComparingAllCostsLessThanTestingCandidates) {
  const EnlargedFrame frame{.boxes = 1'000, .changed = 1'000, .left = 0, .candidates = 450'000};
  const auto lasts = [&frame](bool may_compare_all) {
    EnlargePolicy policy(may_compare_all);
    policy.started();
    int frames = 0;
    while (frames < 100 && policy.goes_on(frame)) ++frames;
    return frames;
  };
  EXPECT_LT(lasts(true), 20);
  EXPECT_EQ(lasts(false), 100);
}

}  // namespace
}  // namespace broadside::track

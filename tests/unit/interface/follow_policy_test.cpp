// FollowPolicy: when boxes are followed, and when all pairs are found anew.
#include "interface/follow_policy.hpp"

#include <gtest/gtest.h>

namespace broadside::core {
namespace {

constexpr FindCosts finding = {.box = 50};
constexpr FollowCosts cheap = {.start = 10, .mover = 100, .mover_alone = 100, .test = 1, .further_test = 1};
constexpr FollowCosts dear = {.start = 10, .mover = 200, .mover_alone = 200, .test = 1, .further_test = 1};
constexpr std::size_t boxes = 10'000;

/// A policy whose structure has the boxes.
FollowPolicy started(std::vector<FollowCosts> following = {cheap}) {
  FollowPolicy policy(Update::automatic, finding, std::move(following));
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
  FollowPolicy policy = started({cheap, dear});
  policy.followed(1'000, Statistics{.tests = 1'000 * 500});
  for (int frame = 0; frame < 10 && policy.current() == 0; ++frame) policy.follows(boxes, 1'000, false);
  EXPECT_EQ(policy.current(), 1U);
}

TEST(FollowPolicy, DoesAsItIsTold) {
  EXPECT_TRUE(FollowPolicy(Update::follow, finding, {cheap}).follows(boxes, boxes, true));
  EXPECT_FALSE(FollowPolicy(Update::rebuild, finding, {cheap}).follows(boxes, 1, false));
}

}  // namespace
}  // namespace broadside::core

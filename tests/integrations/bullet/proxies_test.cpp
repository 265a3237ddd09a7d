// BulletBroadphase alone: queries for proxies, and what is refused.
#include <limits>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bullet_support.hpp"
#include "tests/support/message.hpp"

namespace broadside::bullet_tests {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr btScalar nan = std::numeric_limits<btScalar>::quiet_NaN();

TEST(BulletProxies, LetsAQuerysCallbackCreateMoveAndDestroyProxies) {
  BulletBroadphase broadphase;
  std::vector<btBroadphaseProxy*> proxies;
  for (std::uintptr_t i = 0; i < 200; ++i) proxies.push_back(cube(broadphase, i, btScalar(i) / 100));
  bool is_first = true;
  const auto disturb = [&](const btBroadphaseProxy* found) {
    if (!std::exchange(is_first, false)) return;
    for (std::uintptr_t i = 0; i < 200; ++i) {
      if (proxies[i] != found) broadphase.destroyProxy(proxies[i], nullptr);
      cube(broadphase, 200 + i, 0);
    }
  };
  Lists<btBroadphaseAabbCallback, decltype(disturb)> list(disturb);
  broadphase.aabbTest({0, 0, 0}, {9, 9, 9}, list);
  EXPECT_EQ(list.numbers.size(), 1U) << "the others were destroyed before their turn";
  EXPECT_EQ(overlapping(broadphase, {0, 0, 0}, {9, 9, 9}).size(), 201U);
}

TEST(BulletProxies, ShowsQueriesABoxAsItWasLastSet) {
  BulletBroadphase broadphase;
  btBroadphaseProxy* const a = cube(broadphase, 1, 0);
  EXPECT_THAT(overlapping(broadphase, {0, 0, 0}, {1, 1, 1}), ElementsAre(1U));
  move_to(broadphase, a, 5);
  EXPECT_THAT(overlapping(broadphase, {0, 0, 0}, {1, 1, 1}), IsEmpty());
  EXPECT_THAT(ray(broadphase, {btScalar(5.5), 9, 0}, {btScalar(5.5), -9, 0}), ElementsAre(1U));
  const btVector3 point(5, 1, 1);
  EXPECT_THAT(ray(broadphase, point, point), ElementsAre(1U)) << "a line without length";
  btVector3 min;
  btVector3 max;
  broadphase.getAabb(a, min, max);
  EXPECT_EQ(min, btVector3(5, 0, 0));
  EXPECT_EQ(max, btVector3(6, 1, 1));
}

TEST(BulletProxies, RefusesWhatIsNoBoxAndChangesNothing) {
  BulletBroadphase broadphase;
  btBroadphaseProxy* const a = cube(broadphase, 1, 0);
  EXPECT_THAT(message_of<InvalidInput>([&] { cube(broadphase, 2, nan); }), HasSubstr("nan"));
  EXPECT_THAT(message_of<InvalidInput>([&] {
                broadphase.setAabb(a, {0, 0, 0}, {1, -1, 1}, nullptr);
              }),
              HasSubstr("expected numbers with min <= max"));
  EXPECT_THROW(overlapping(broadphase, {nan, 0, 0}, {1, 1, 1}), InvalidQuery);
  EXPECT_THROW(ray(broadphase, {0, 0, 0}, {nan, 1, 1}), InvalidQuery);
  EXPECT_THAT(overlapping(broadphase, {0, 0, 0}, {1, 1, 1}), ElementsAre(1U));
  EXPECT_EQ(cube(broadphase, 3, 0)->m_uniqueId, 2);
}

TEST(BulletProxies, TakesInNoBoxWhereToldTo) {
  BulletBroadphase broadphase({.bad_input = BadInput::quarantine});
  btBroadphaseProxy* const a = cube(broadphase, 1, 0);
  cube(broadphase, 2, 0);
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
  move_to(broadphase, a, nan);
  EXPECT_THAT(updated(broadphase), IsEmpty());
  EXPECT_THAT(broadphase.world().quarantined(), ElementsAre(broadphase.handle(a)));
  move_to(broadphase, a, 0);
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
}

TEST(BulletProxies, RefusesAProxyThatWasDestroyedOrIsNotItsOwn) {
  BulletBroadphase broadphase;
  BulletBroadphase other;
  btSimpleBroadphase simple;
  btBroadphaseProxy* const a = cube(broadphase, 1, 0);
  broadphase.destroyProxy(a, nullptr);
  btVector3 corner;
  EXPECT_THAT(
      message_of<InvalidHandle>([&] { broadphase.destroyProxy(a, nullptr); }),
      AllOf(HasSubstr("destroyProxy(): the proxy at 0x"), HasSubstr("was destroyed; expected one of")));
  EXPECT_THROW(move_to(broadphase, a, 0), InvalidHandle);
  EXPECT_THROW(broadphase.getAabb(a, corner, corner), InvalidHandle);
  for (btBroadphaseProxy* const foreign :
       {cube(other, 2, 0), cube(simple, 3, 0), static_cast<btBroadphaseProxy*>(nullptr)}) {
    EXPECT_THAT(message_of<InvalidHandle>([&] { broadphase.destroyProxy(foreign, nullptr); }),
                HasSubstr("was never made by this broad phase"));
    EXPECT_THROW(move_to(broadphase, foreign, 0), InvalidHandle);
  }
  EXPECT_THAT(overlapping(other, {0, 0, 0}, {1, 1, 1}), ElementsAre(2U));
}

TEST(BulletProxies, RefusesAWorldThatDoesNotKnowItsPairs) {
  EXPECT_THAT(message_of<std::invalid_argument>([] { BulletBroadphase({.keep_pairs = false}); }),
              HasSubstr("keep_pairs is false; expected true"));
}

TEST(BulletProxies, StartsOverWhenItsPoolIsReset) {
  BulletBroadphase broadphase;
  btBroadphaseProxy* const a = cube(broadphase, 1, 0);
  btBroadphaseProxy* const b = cube(broadphase, 2, 0);
  broadphase.resetPool(nullptr);
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2))) << "not while there are proxies";
  broadphase.destroyProxy(a, nullptr);
  broadphase.destroyProxy(b, nullptr);
  EXPECT_THAT(cached(broadphase), IsEmpty());
  broadphase.resetPool(nullptr);
  EXPECT_EQ(cube(broadphase, 3, 0), a);
  EXPECT_EQ(a->m_uniqueId, 1);
  cube(broadphase, 4, 0);
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(3, 4)));
}

TEST(BulletProxies, EnclosesAllBoxes) {
  BulletBroadphase broadphase;
  btVector3 min;
  btVector3 max;
  broadphase.getBroadphaseAabb(min, max);
  EXPECT_EQ(min, btVector3(0, 0, 0));
  EXPECT_EQ(max, btVector3(0, 0, 0));
  cube(broadphase, 1, 3, -2);
  cube(broadphase, 2, 7, 4);
  broadphase.getBroadphaseAabb(min, max);
  EXPECT_EQ(min, btVector3(3, -2, 0));
  EXPECT_EQ(max, btVector3(8, 5, 1));
}

TEST(BulletProxies, LeadsFromProxiesToTheWorldAndBack) {
  BulletBroadphase broadphase;
  btBroadphaseProxy* const a = cube(broadphase, 1, 3);
  cube(broadphase, 2, 7);
  std::vector<HandleNeighbour> nearest;
  broadphase.world().nearest({0, 0, 0}, 1, nearest);
  ASSERT_EQ(nearest.size(), 1U);
  EXPECT_EQ(nearest[0].handle, broadphase.handle(a));
  EXPECT_EQ(broadphase.proxy(nearest[0].handle), a);
  broadphase.destroyProxy(a, nullptr);
  EXPECT_THROW(broadphase.proxy(nearest[0].handle), InvalidHandle);
}

}  // namespace
}  // namespace broadside::bullet_tests

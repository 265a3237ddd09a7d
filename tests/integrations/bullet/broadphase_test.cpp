// BulletBroadphase alone: its pairs, and what decides about them.
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "bullet_support.hpp"
#include "tests/support/message.hpp"
#include "tests/support/rng.hpp"

namespace broadside::bullet_tests {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A hundred boxes with filters that come, move and go by chance, the same in both broad phases.
class TwoBroadphases {
 public:
  TwoBroadphases(btBroadphaseInterface& ours, btBroadphaseInterface& bullets)
      : ours_(ours), bullets_(bullets), proxies_(100) {}

  ~TwoBroadphases() {
    for (const auto& [mine, theirs] : proxies_) {
      if (theirs != nullptr) bullets_.destroyProxy(theirs, nullptr);  // which it would leak
    }
  }
  TwoBroadphases(const TwoBroadphases&) = delete;
  TwoBroadphases& operator=(const TwoBroadphases&) = delete;

  void step() {
    for (std::size_t i = 0; i < proxies_.size(); ++i) {
      auto& [mine, theirs] = proxies_[i];
      const btVector3 min(corner(), corner(), corner());
      const btVector3 max = min + btVector3(side(), side(), side());
      if (mine == nullptr) {
        const int group = 1 << rng_.below(4);
        const int mask = static_cast<int>(rng_.below(16)) - (rng_.one_in(4) ? 16 : 0);
        mine = ours_.createProxy(min, max, 0, client(i), group, mask, nullptr);
        theirs = bullets_.createProxy(min, max, 0, client(i), group, mask, nullptr);
      } else if (rng_.one_in(10)) {
        ours_.destroyProxy(std::exchange(mine, nullptr), nullptr);
        bullets_.destroyProxy(std::exchange(theirs, nullptr), nullptr);
      } else if (rng_.one_in(2)) {
        ours_.setAabb(mine, min, max, nullptr);
        bullets_.setAabb(theirs, min, max, nullptr);
      }
    }
  }

  /// Moves half of the boxes a little.
  void tremble() {
    for (auto& [mine, theirs] : proxies_) {
      if (mine == nullptr || rng_.one_in(2)) continue;
      const btVector3 shift(rng_.between(-0.03F, 0.03F), rng_.between(-0.03F, 0.03F), 0);
      ours_.setAabb(mine, mine->m_aabbMin + shift, mine->m_aabbMax + shift, nullptr);
    }
  }

  void expect_equal() {
    EXPECT_EQ(updated(ours_), overlapping_of(updated(bullets_)));
    expect_answers();
  }

  void expect_answers() {
    const btVector3 from(corner(), corner(), corner());
    const btVector3 to(corner(), corner(), corner());
    const btVector3 half(1, 2, 1);
    EXPECT_EQ(ray(ours_, from, to), met(from, to, {0, 0, 0}));
    EXPECT_EQ(ray(ours_, from, to, -half, half), met(from, to, half));
    EXPECT_EQ(overlapping(ours_, from - half, from + half), met(from, from, half));
    for (const auto& [mine, theirs] : proxies_) {
      if (mine != nullptr) {
        EXPECT_EQ(mine->m_uniqueId, theirs->m_uniqueId);
      }
    }
  }

 private:
  btScalar corner() { return btScalar(rng_.whole(0, 40)); }
  btScalar side() { return btScalar(rng_.whole(0, 6)); }

  /// Of Bullet's pairs, whose boxes are enlarged, those of boxes that overlap.
  std::vector<Numbers> overlapping_of(std::vector<Numbers> pairs) const {
    std::erase_if(pairs, [this](const Numbers& pair) {
      const btBroadphaseProxy& a = *proxies_[pair.first].first;
      const btBroadphaseProxy& b = *proxies_[pair.second].first;
      return !TestAabbAgainstAabb2(a.m_aabbMin, a.m_aabbMax, b.m_aabbMin, b.m_aabbMax);
    });
    return pairs;
  }

  /// What a box with half the extents `half` meets on its way.
  std::multiset<std::uintptr_t> met(const btVector3& from, const btVector3& to, const btVector3& half) const {
    const btVector3 way = to - from;
    const BoxCast<3, btScalar> cast = {
        bullet_detail::box_of(from - half, from + half), {way.x(), way.y(), way.z()}, 1};
    std::multiset<std::uintptr_t> hit;
    for (const auto& [proxy, theirs] : proxies_) {
      if (proxy != nullptr && t_enter(cast, bullet_detail::box_of(proxy->m_aabbMin, proxy->m_aabbMax)))
        hit.insert(number_of(*proxy));
    }
    return hit;
  }

  btBroadphaseInterface& ours_;
  btBroadphaseInterface& bullets_;
  std::vector<std::pair<btBroadphaseProxy*, btBroadphaseProxy*>> proxies_;
  Rng rng_{1};
};

TEST(BulletBroadphase, HasThePairsAndAnswersOfBulletsOwn) {
  for (const char* const algorithm : {"auto", "brute_force", "bvh", "grid:threads=2"}) {
    SCOPED_TRACE(algorithm);
    BulletBroadphase ours({.algorithm = algorithm});
    btDbvtBroadphase bullets;
    TwoBroadphases both(ours, bullets);
    for (int step = 0; step < 30 && !testing::Test::HasFailure(); ++step) {
      both.step();
      both.expect_equal();
    }
  }
}

TEST(BulletBroadphase, KeepsACacheThatDefersRemovals) {
  btSortedOverlappingPairCache cache;
  ASSERT_TRUE(cache.hasDeferredRemoval());
  BulletBroadphase ours(&cache, {});
  btDbvtBroadphase bullets;
  TwoBroadphases both(ours, bullets);
  for (int step = 0; step < 30 && !testing::Test::HasFailure(); ++step) {
    both.step();
    both.expect_equal();
  }
}

TEST(BulletBroadphase, TellsOfEnlargedBoxesAndFindsTheBoxesThemselves) {
  BulletBroadphase broadphase({.margin = 1, .events = WorldEvents::enlarged});
  btBroadphaseProxy* const a = cube(broadphase, 1, 0);
  cube(broadphase, 2, btScalar(2.5));
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
  for (int step = 0; step < 40; ++step) {
    const btScalar x = step % 2 == 0 ? btScalar(0.5) : 0;
    move_to(broadphase, a, x);
    EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
    if (step % 3 != 0) continue;
    const btVector3 gap(btScalar(0.4), btScalar(0.5), btScalar(0.5));
    EXPECT_EQ(overlapping(broadphase, gap, gap).count(1), step % 2 == 0 ? 0U : 1U);
    EXPECT_EQ(broadphase.world().box(broadphase.handle(a)).min[0], x);
  }
  move_to(broadphase, a, -4);
  EXPECT_THAT(updated(broadphase), IsEmpty());
  EXPECT_THAT(overlapping(broadphase, {-4, 0, 0}, {-4, 1, 1}), ElementsAre(1U));
}

TEST(BulletBroadphase, FindsBoxesThatTrembleWhereTheyAre) {
  BulletBroadphase ours;
  btDbvtBroadphase bullets;
  TwoBroadphases both(ours, bullets);
  both.step();
  ours.calculateOverlappingPairs(nullptr);
  for (int step = 0; step < 200 && !testing::Test::HasFailure(); ++step) {
    both.tremble();
    both.expect_answers();
    if (step % 2 == 0) ours.calculateOverlappingPairs(nullptr);
    if (step % 20 == 0) ours.world();  // is told of all boxes
  }
}

TEST(BulletBroadphase, MakesAnEnlargedBoxSmallerWhoseBoxHasShrunk) {
  BulletBroadphase broadphase;
  btBroadphaseProxy* const a =
      broadphase.createProxy({0, 0, 0}, {9, 9, 9}, BOX_SHAPE_PROXYTYPE, client(1), 1, -1, nullptr);
  cube(broadphase, 2, 8);
  move_to(broadphase, a, 0);
  for (int step = 0; step < 16; ++step) updated(broadphase);
  EXPECT_THAT(updated(broadphase), IsEmpty());
}

TEST(BulletBroadphase, SeesAheadWhereABoxIsGoing) {
  BulletBroadphase broadphase({.margin = 0.1, .predicted_frames = 4, .events = WorldEvents::enlarged});
  btBroadphaseProxy* const a = cube(broadphase, 1, 0);
  cube(broadphase, 2, 4);
  EXPECT_THAT(updated(broadphase), IsEmpty());
  move_to(broadphase, a, 1);
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
}

TEST(BulletBroadphase, ServesACacheThatHoldsNothing) {
  btNullPairCache cache;
  BulletBroadphase broadphase(&cache);
  btBroadphaseProxy* const a = cube(broadphase, 1, 0);
  cube(broadphase, 2, 0);
  EXPECT_THAT(updated(broadphase), IsEmpty());
  broadphase.destroyProxy(a, nullptr);
  EXPECT_THAT(updated(broadphase), IsEmpty());
}

TEST(BulletBroadphase, MeetsWhatIsInfinite) {
  BulletBroadphase broadphase;
  const btVector3 far(BT_LARGE_FLOAT, BT_LARGE_FLOAT, BT_LARGE_FLOAT);
  broadphase.createProxy(-far, far, STATIC_PLANE_PROXYTYPE, client(1), 1, -1, nullptr);
  btBroadphaseProxy* const body = cube(broadphase, 2, 0);
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
  move_to(broadphase, body, 1e6);
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
}

TEST(BulletBroadphase, TakesInAGroupOrMaskThatIsWrittenIntoAProxy) {
  BulletBroadphase broadphase;
  btBroadphaseProxy* const a = cube(broadphase, 1, 0, 0, 2, 4);
  btBroadphaseProxy* const b = cube(broadphase, 2, 0, 0, 8, 2);
  EXPECT_THAT(updated(broadphase), IsEmpty());
  a->m_collisionFilterMask = 8;
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
  b->m_collisionFilterGroup = 16;
  move_to(broadphase, a, 0);
  EXPECT_THAT(updated(broadphase), IsEmpty());
}

/// Accepts what it is told to accept, whatever the masks say.
struct Whim final : btOverlapFilterCallback {
  bool needBroadphaseCollision(btBroadphaseProxy*, btBroadphaseProxy*) const override {
    ++asked;
    if (action) action();
    return accepts;
  }
  bool accepts = true;
  std::function<void()> action{};
  mutable int asked = 0;
};

TEST(BulletBroadphase, LeavesTheDecisionToAFilterCallback) {
  BulletBroadphase broadphase;
  btBroadphaseProxy* const a = cube(broadphase, 1, 0, 0, 1, 0);
  cube(broadphase, 2, 0);
  EXPECT_THAT(updated(broadphase), IsEmpty()) << "by the masks";

  Whim whim;
  whim.accepts = false;
  broadphase.getOverlappingPairCache()->setOverlapFilterCallback(&whim);
  EXPECT_THAT(updated(broadphase), IsEmpty());
  EXPECT_EQ(whim.asked, 1);
  whim.accepts = true;
  EXPECT_THAT(updated(broadphase), IsEmpty()) << "nothing has moved";
  move_to(broadphase, a, btScalar(0.5));
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
  move_to(broadphase, a, btScalar(0.6));
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
  EXPECT_EQ(whim.asked, 2) << "a pair that there is is not asked about";
  move_to(broadphase, a, 5);
  EXPECT_THAT(updated(broadphase), IsEmpty());

  broadphase.getOverlappingPairCache()->setOverlapFilterCallback(nullptr);
  move_to(broadphase, a, 0);
  EXPECT_THAT(updated(broadphase), IsEmpty()) << "by the masks again";
}

TEST(BulletBroadphase, MakesGoodWhatOthersChangeInTheCache) {
  BulletBroadphase broadphase;
  btBroadphaseProxy* const a = cube(broadphase, 1, 0);
  btBroadphaseProxy* const b = cube(broadphase, 2, 0);
  btBroadphaseProxy* const c = cube(broadphase, 3, 9);
  btOverlappingPairCache* const cache = broadphase.getOverlappingPairCache();
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
  cache->removeOverlappingPairsContainingProxy(a, nullptr);
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
  cache->addOverlappingPair(b, c);
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
}

TEST(BulletBroadphase, LetsAFilterCallbackCreateMoveAndDestroyProxies) {
  BulletBroadphase broadphase;
  btBroadphaseProxy* const a = cube(broadphase, 1, 0);
  btBroadphaseProxy* b = cube(broadphase, 2, 0);
  cube(broadphase, 3, 0);
  Whim whim;
  whim.action = [&] {
    if (b == nullptr) return;
    broadphase.destroyProxy(std::exchange(b, nullptr), nullptr);
    cube(broadphase, 4, 0);
    move_to(broadphase, a, btScalar(0.5));
  };
  broadphase.getOverlappingPairCache()->setOverlapFilterCallback(&whim);
  broadphase.calculateOverlappingPairs(nullptr);
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 3), Numbers(1, 4), Numbers(3, 4)));
}

TEST(BulletBroadphase, DoesInTheNextStepWhatAnExceptionLeftUndone) {
  BulletBroadphase broadphase;
  btBroadphaseProxy* const a = cube(broadphase, 1, 0);
  cube(broadphase, 2, 0);
  btBroadphaseProxy* const c = cube(broadphase, 3, btScalar(1.5));
  cube(broadphase, 4, btScalar(1.5));
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2), Numbers(3, 4)));
  Whim whim;
  whim.action = [] { throw std::runtime_error("no"); };
  broadphase.getOverlappingPairCache()->setOverlapFilterCallback(&whim);
  move_to(broadphase, a, btScalar(0.7));
  move_to(broadphase, c, 9);
  EXPECT_THROW(broadphase.calculateOverlappingPairs(nullptr), std::runtime_error);
  whim.action = {};
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2), Numbers(1, 4)));
}

TEST(BulletBroadphase, RefusesToCalculateInsideACallbackOfItself) {
  BulletBroadphase broadphase;
  cube(broadphase, 1, 0);
  cube(broadphase, 2, 0);
  Whim whim;
  std::string message;
  whim.action = [&] {
    message = message_of<std::logic_error>([&] { broadphase.calculateOverlappingPairs(nullptr); });
  };
  broadphase.getOverlappingPairCache()->setOverlapFilterCallback(&whim);
  EXPECT_THAT(updated(broadphase), ElementsAre(Numbers(1, 2)));
  EXPECT_THAT(message, HasSubstr("callback of its own"));
}

}  // namespace
}  // namespace broadside::bullet_tests

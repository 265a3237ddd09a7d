// The manager's pairs are those of FCL's own managers, whatever is done to it.
#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/fcl.hpp"

#include "tests/integrations/fcl/fcl_support.hpp"

namespace broadside::fcl_tests {
namespace {

using testing::IsEmpty;
using testing::SizeIs;

template <typename S>
class Collide : public testing::Test {
 protected:
  using Objects = std::vector<fcl::CollisionObject<S>*>;

  static std::vector<IdPair> pairs(const fcl::BroadPhaseCollisionManager<S>& manager) {
    std::vector<IdPair> found;
    manager.collide(&found, note_pair<S>);
    return found;
  }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Collide, Scalars);

TYPED_TEST(Collide, FindsThePairsOfFclInRandomHistories) {
  using S = TypeParam;
  RandomObjects<S> objects(200, 8, 1);
  FclCollisionManager<S> manager;
  fcl::NaiveCollisionManager<S> naive;
  std::vector<bool> is_in(objects.size(), false);
  const auto toggle = [&](std::size_t id) {
    for (fcl::BroadPhaseCollisionManager<S>* each :
         std::initializer_list<fcl::BroadPhaseCollisionManager<S>*>{&manager, &naive}) {
      is_in[id] ? each->unregisterObject(objects[id]) : each->registerObject(objects[id]);
    }
    is_in[id] = !is_in[id];
  };
  for (std::size_t id = 0; id < objects.size(); ++id) toggle(id);
  for (int frame = 0; frame < 60; ++frame) {
    SCOPED_TRACE(frame);
    // Few or many, so that pairs are followed and found anew by turns.
    const std::size_t movers = frame % 3 == 0 ? objects.size() : objects.below(10);
    std::vector<fcl::CollisionObject<S>*> moved;
    for (std::size_t i = 0; i < movers; ++i) {
      const std::size_t id = objects.below(objects.size());
      objects.jump(id);
      if (is_in[id]) moved.push_back(objects[id]);
    }
    if (frame % 2 == 0) {
      manager.update();
    } else if (moved.size() == 1) {
      manager.update(moved.front());
    } else {
      manager.update(moved);
    }
    for (std::size_t i = objects.below(4); i > 0; --i) toggle(objects.below(objects.size()));
    ASSERT_EQ(manager.size(), naive.size());
    ASSERT_EQ(as_set(this->pairs(manager)), as_set(this->pairs(naive)));
    ASSERT_EQ(this->pairs(manager), this->pairs(manager)) << "asked again";
  }
  manager.clear();
  EXPECT_TRUE(manager.empty());
  EXPECT_THAT(this->pairs(manager), IsEmpty());
  manager.registerObjects(objects.pointers());
  naive.clear();
  naive.registerObjects(objects.pointers());
  EXPECT_EQ(as_set(this->pairs(manager)), as_set(this->pairs(naive)));
}

TYPED_TEST(Collide, GivesAnObjectThoseThatItsBoxOverlapsNow) {
  using S = TypeParam;
  RandomObjects<S> objects(200, 8, 2);
  typename TestFixture::Objects all = objects.pointers();
  typename TestFixture::Objects registered(all.begin(), all.begin() + 150);
  FclCollisionManager<S> manager;
  manager.registerObjects(registered);
  fcl::DynamicAABBTreeCollisionManager<S> tree;
  tree.registerObjects(registered);
  tree.setup();
  for (int round = 0; round < 3; ++round) {
    for (fcl::CollisionObject<S>* const object : all) {
      std::vector<IdPair> found;
      std::vector<IdPair> expected;
      manager.collide(object, &found, note_pair<S>);
      tree.collide(object, &expected, note_pair<S>);
      std::ranges::sort(found);
      std::ranges::sort(expected);
      ASSERT_EQ(found, expected);
    }
    for (std::size_t id = 0; id < objects.size(); id += 3) objects.jump(id);
    manager.update();
    tree.update();
  }
}

TYPED_TEST(Collide, JoinsTwoManagers) {
  using S = TypeParam;
  RandomObjects<S> objects(200, 8, 3);
  typename TestFixture::Objects all = objects.pointers();
  FclCollisionManager<S> left;
  FclCollisionManager<S> right;
  fcl::NaiveCollisionManager<S> naive_left;
  fcl::NaiveCollisionManager<S> naive_right;
  // They share some objects.
  left.registerObjects({all.begin(), all.begin() + 120});
  naive_left.registerObjects({all.begin(), all.begin() + 120});
  right.registerObjects({all.begin() + 80, all.end()});
  naive_right.registerObjects({all.begin() + 80, all.end()});
  std::vector<IdPair> found;
  std::vector<IdPair> expected;
  left.collide(&right, &found, note_pair<S>);
  naive_left.collide(&naive_right, &expected, note_pair<S>);
  std::ranges::sort(found);
  std::ranges::sort(expected);
  EXPECT_EQ(found, expected);

  found.clear();
  left.collide(&left, &found, note_pair<S>);
  EXPECT_EQ(found, this->pairs(left)) << "with itself";
}

TYPED_TEST(Collide, CallsBackInTheSameOrderForTheSameCalls) {
  using S = TypeParam;
  std::vector<std::vector<IdPair>> orders;
  for (const char* const algorithm : {"auto", "auto:threads=2"}) {
    RandomObjects<S> objects(3000, 12, 4);
    FclCollisionManager<S> manager(algorithm);
    manager.registerObjects(objects.pointers());
    std::vector<IdPair>& order = orders.emplace_back();
    for (const std::size_t movers : {3000U, 5U, 5U, 3000U}) {
      for (std::size_t id = 0; id < movers; ++id) objects.jump(id);
      manager.update();
      manager.collide(&order, note_pair<S>);
      manager.collide(objects[0], &order, note_pair<S>);
    }
  }
  EXPECT_EQ(orders[0], orders[1]);
}

/// Stops at the third call.
template <typename S>
bool stop_at_third(fcl::CollisionObject<S>*, fcl::CollisionObject<S>*, void* data) {
  return ++*static_cast<int*>(data) == 3;
}

TYPED_TEST(Collide, StopsWhereTheCallbackSaysSo) {
  using S = TypeParam;
  RandomObjects<S> objects(50, 1, 5);
  FclCollisionManager<S> manager;
  FclCollisionManager<S> other;
  manager.registerObjects(objects.pointers());
  RandomObjects<S> others(50, 1, 6);
  other.registerObjects(others.pointers());
  int calls = 0;
  manager.collide(&calls, stop_at_third<S>);
  EXPECT_EQ(std::exchange(calls, 0), 3);
  manager.collide(others[0], &calls, stop_at_third<S>);
  EXPECT_EQ(std::exchange(calls, 0), 3);
  manager.collide(&other, &calls, stop_at_third<S>);
  EXPECT_EQ(std::exchange(calls, 0), 3);
}

TYPED_TEST(Collide, AnswersSeveralThreadsAtOnce) {
  using S = TypeParam;
  RandomObjects<S> objects(500, 8, 7);
  FclCollisionManager<S> manager;
  manager.registerObjects(objects.pointers());
  const auto ask = [&] {
    std::vector<IdPair> pairs;
    manager.collide(&pairs, note_pair<S>);
    for (std::size_t id = 0; id < objects.size(); ++id) manager.collide(objects[id], &pairs, note_pair<S>);
    return pairs;
  };
  for (int frame = 0; frame < 20; ++frame) {
    objects.jump(7);
    manager.update(objects[7]);
    std::vector<IdPair> found;
    std::thread second([&] { found = ask(); });
    const std::vector<IdPair> expected = ask();
    second.join();
    ASSERT_EQ(found, expected) << "frame " << frame;
  }
}

TYPED_TEST(Collide, RefusesWhatIsWrongAndChangesNothing) {
  using S = TypeParam;
  RandomObjects<S> objects(100, 3, 8);
  typename TestFixture::Objects all = objects.pointers();
  FclCollisionManager<S> manager;
  manager.registerObjects({all.begin(), all.begin() + 50});
  const std::vector<IdPair> before = this->pairs(manager);
  fcl::CollisionObject<S>* const in = all[7];
  fcl::CollisionObject<S>* const out = all[70];

  EXPECT_THROW(manager.registerObject(in), std::invalid_argument);
  EXPECT_THROW(manager.registerObject(nullptr), std::invalid_argument);
  EXPECT_THROW(manager.registerObjects({all[60], all[61], in}), std::invalid_argument);
  EXPECT_THROW(manager.registerObjects({all[60], all[61], all[60]}), std::invalid_argument);
  EXPECT_THROW(manager.unregisterObject(out), std::invalid_argument);
  EXPECT_THROW(manager.unregisterObject(nullptr), std::invalid_argument);
  EXPECT_THROW(manager.update(out), std::invalid_argument);
  const Box<3, S> box7 = detail::FclObjectSet<S>::box_of(in);
  objects.jump(7);
  EXPECT_THROW(manager.update({in, out}), std::invalid_argument);
  objects[7]->set(box7);
  EXPECT_EQ(manager.size(), 50U);
  EXPECT_EQ(this->pairs(manager), before);

  // A NaN, and min > max.
  for (const S wrong : {std::numeric_limits<S>::quiet_NaN(), std::numeric_limits<S>::infinity()}) {
    Box<3, S> box = detail::FclObjectSet<S>::box_of(all[20]);
    const Box<3, S> box20 = box;
    box.min[1] = wrong;
    objects[20]->set(box);
    objects.jump(7);
    EXPECT_THROW(manager.update(), InvalidInput);
    EXPECT_THROW(manager.update({in, all[20]}), InvalidInput);
    EXPECT_THROW(manager.collide(all[20], nullptr, note_pair<S>), InvalidInput);
    objects[70]->set(box);
    EXPECT_THROW(manager.registerObjects({all[60], out}), InvalidInput);
    objects[20]->set(box20);
    objects[7]->set(box7);
    EXPECT_EQ(manager.size(), 50U);
    EXPECT_EQ(this->pairs(manager), before);
  }

  fcl::NaiveCollisionManager<S> naive;
  EXPECT_THROW(manager.collide(&naive, nullptr, note_pair<S>), std::invalid_argument);
  EXPECT_THROW(
      manager.collide(static_cast<fcl::BroadPhaseCollisionManager<S>*>(nullptr), nullptr, note_pair<S>),
      std::invalid_argument);
  EXPECT_THROW(FclCollisionManager<S>("gird"), InvalidSpec);
}

/// Tries to change the manager that calls it.
template <typename S>
bool change(fcl::CollisionObject<S>* first, fcl::CollisionObject<S>*, void* data) {
  static_cast<FclCollisionManager<S>*>(data)->unregisterObject(first);
  return false;
}

TYPED_TEST(Collide, RefusesChangesWithinACallbackAndGoesOnAfterwards) {
  using S = TypeParam;
  RandomObjects<S> objects(50, 1, 9);
  FclCollisionManager<S> manager;
  manager.registerObjects(objects.pointers());
  EXPECT_THROW(manager.collide(&manager, change<S>), std::logic_error);
  EXPECT_EQ(manager.size(), 50U);
  manager.unregisterObject(objects[0]);
  EXPECT_EQ(manager.size(), 49U);
  std::vector<fcl::CollisionObject<S>*> left;
  manager.getObjects(left);
  EXPECT_THAT(left, SizeIs(49));
}

}  // namespace
}  // namespace broadside::fcl_tests

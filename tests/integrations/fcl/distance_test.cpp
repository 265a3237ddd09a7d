// Distance queries find what FCL's own managers find, nearest boxes first.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include <fcl/broadphase/broadphase_bruteforce.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/shape/box.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/fcl.hpp"

#include "tests/integrations/fcl/fcl_support.hpp"

namespace broadside::fcl_tests {
namespace {

template <typename S>
class Distance : public testing::Test {
 protected:
  /// Best first: callbacks come by the distances of the boxes, and none for boxes farther than what was
  /// found.
  static void expect_best_first(const RandomObjects<S>& objects, const Nearest<S>& found) {
    std::vector<S> distances;
    for (const auto& [a, b] : found.asked)
      distances.push_back(objects[a]->getAABB().distance(objects[b]->getAABB()));
    EXPECT_TRUE(std::ranges::is_sorted(distances));
    EXPECT_LE(distances.back(), found.distance);
  }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(Distance, Scalars);

TYPED_TEST(Distance, IsThatOfFclAmongAllObjectsFromSparseToCrowded) {
  using S = TypeParam;
  for (const double extent : {1.0, 8.0, 40.0, 1000.0}) {
    SCOPED_TRACE(extent);
    RandomObjects<S> objects(120, extent, 1);
    FclCollisionManager<S> manager;
    manager.registerObjects(objects.pointers());
    fcl::NaiveCollisionManager<S> naive;
    naive.registerObjects(objects.pointers());
    Nearest<S> found;
    Nearest<S> expected;
    manager.distance(&found, Nearest<S>::take);
    naive.distance(&expected, Nearest<S>::take);
    EXPECT_EQ(found.distance, expected.distance);
    this->expect_best_first(objects, found);
  }
}

TYPED_TEST(Distance, IsThatOfFclForOneObjectAndForTwoManagers) {
  using S = TypeParam;
  for (const double extent : {1.0, 8.0, 40.0, 1000.0}) {
    SCOPED_TRACE(extent);
    RandomObjects<S> objects(120, extent, 2);
    const std::vector<fcl::CollisionObject<S>*> all = objects.pointers();
    const std::vector<fcl::CollisionObject<S>*> some(all.begin(), all.begin() + 80);
    FclCollisionManager<S> manager;
    manager.registerObjects(some);
    fcl::DynamicAABBTreeCollisionManager<S> tree;
    tree.registerObjects(some);
    tree.setup();
    for (fcl::CollisionObject<S>* const object : all) {
      Nearest<S> found;
      Nearest<S> expected;
      manager.distance(object, &found, Nearest<S>::take);
      tree.distance(object, &expected, Nearest<S>::take);
      ASSERT_EQ(found.distance, expected.distance);
      this->expect_best_first(objects, found);
    }

    const std::vector<fcl::CollisionObject<S>*> others(all.begin() + 80, all.end());
    FclCollisionManager<S> other;
    other.registerObjects(others);
    fcl::DynamicAABBTreeCollisionManager<S> other_tree;
    other_tree.registerObjects(others);
    Nearest<S> found;
    Nearest<S> expected;
    manager.distance(&other, &found, Nearest<S>::take);
    tree.distance(&other_tree, &expected, Nearest<S>::take);
    EXPECT_EQ(found.distance, expected.distance);
    this->expect_best_first(objects, found);
  }
}

/// Counts, and leaves the distance as it is: as callbacks do that filter all pairs out.
template <typename S>
bool count_only(fcl::CollisionObject<S>*, fcl::CollisionObject<S>*, void* data, S&) {
  ++*static_cast<std::size_t*>(data);
  return false;
}

TYPED_TEST(Distance, AsksAboutEachPairOnceWhereNoDistanceIsSet) {
  using S = TypeParam;
  RandomObjects<S> objects(60, 20, 3);
  // One far away, and two that all but touch.
  objects[0]->set({{1e6F, 1e6F, 1e6F}, {1e6F, 1e6F, 1e6F}});
  objects[1]->set({{0, 0, 0}, {1, 1, 1}});
  objects[2]->set({{std::nextafter(S{1}, S{2}), 0, 0}, {2, 1, 1}});
  FclCollisionManager<S> manager;
  manager.registerObjects(objects.pointers());
  std::size_t calls = 0;
  manager.distance(&calls, count_only<S>);
  EXPECT_EQ(calls, 60U * 59 / 2);
  calls = 0;
  manager.distance(objects[5], &calls, count_only<S>);
  EXPECT_EQ(calls, 59U);
  RandomObjects<S> others(10, 20, 4);
  FclCollisionManager<S> other;
  other.registerObjects(others.pointers());
  calls = 0;
  manager.distance(&other, &calls, count_only<S>);
  EXPECT_EQ(calls, 600U);
}

TYPED_TEST(Distance, TakesInfiniteBoxesEmptyManagersAndGapsWhoseSquareVanishes) {
  using S = TypeParam;
  constexpr S infinity = std::numeric_limits<S>::infinity();
  RandomObjects<S> objects(3, 8, 5);
  FclCollisionManager<S> manager;
  std::size_t calls = 0;
  manager.distance(&calls, count_only<S>);
  manager.distance(objects[0], &calls, count_only<S>);
  FclCollisionManager<S> other;
  manager.distance(&other, &calls, count_only<S>);
  EXPECT_EQ(calls, 0U);

  constexpr S tiny = std::numeric_limits<S>::min();
  objects[0]->set({{0, 0, 0}, {0, 0, 0}});
  objects[1]->set({{tiny, 0, 0}, {1, 0, 0}});
  objects[2]->set({{-infinity, 5, -infinity}, {infinity, 6, infinity}});
  manager.registerObjects(objects.pointers());
  manager.distance(&calls, count_only<S>);
  EXPECT_EQ(calls, 3U);
}

TEST(DistanceOfRealShapes, IsThatOfFcl) {
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> owned;
  std::vector<fcl::CollisionObjectd*> objects;
  std::mt19937_64 random(6);
  std::uniform_real_distribution<> place(-60, 60);
  for (int i = 0; i < 40; ++i) {
    const auto shape = std::make_shared<fcl::Boxd>(1, 2, 3);
    fcl::Transform3d transform = fcl::Transform3d::Identity();
    transform.translation() = fcl::Vector3d(place(random), place(random), place(random));
    transform.rotate(fcl::AngleAxis<double>(place(random), fcl::Vector3d(1, 2, 3).normalized()));
    owned.push_back(std::make_unique<fcl::CollisionObjectd>(shape, transform));
    objects.push_back(owned.back().get());
  }
  FclCollisionManagerd manager;
  manager.registerObjects(objects);
  fcl::DynamicAABBTreeCollisionManagerd tree;
  tree.registerObjects(objects);
  fcl::DefaultDistanceData<double> found;
  fcl::DefaultDistanceData<double> expected;
  manager.distance(&found, fcl::DefaultDistanceFunction<double>);
  tree.distance(&expected, fcl::DefaultDistanceFunction<double>);
  EXPECT_GT(found.result.min_distance, 0);
  EXPECT_EQ(found.result.min_distance, expected.result.min_distance);
}

}  // namespace
}  // namespace broadside::fcl_tests

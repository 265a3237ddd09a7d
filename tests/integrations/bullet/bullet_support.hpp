// What the tests of BulletBroadphase share: proxies by number, and the pairs of a cache.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include <btBulletCollisionCommon.h>

#include "broadside/bullet.hpp"

namespace broadside::bullet_tests {

using Numbers = std::pair<std::uintptr_t, std::uintptr_t>;

inline void* client(std::uintptr_t number) { return std::bit_cast<void*>(number); }
inline std::uintptr_t number_of(const btBroadphaseProxy& proxy) {
  return std::bit_cast<std::uintptr_t>(proxy.m_clientObject);
}

/// A cube of side 1 whose lowest corner is at (x, y, 0), as a proxy for `number`.
inline btBroadphaseProxy* cube(btBroadphaseInterface& broadphase, std::uintptr_t number, btScalar x,
                               btScalar y = 0, int group = btBroadphaseProxy::DefaultFilter,
                               int mask = btBroadphaseProxy::AllFilter) {
  return broadphase.createProxy({x, y, 0}, {x + 1, y + 1, 1}, BOX_SHAPE_PROXYTYPE, client(number), group,
                                mask, nullptr);
}

inline void move_to(btBroadphaseInterface& broadphase, btBroadphaseProxy* proxy, btScalar x, btScalar y = 0) {
  broadphase.setAabb(proxy, {x, y, 0}, {x + 1, y + 1, 1}, nullptr);
}

/// The pairs in the cache, in its order, each with the lesser number first.
inline std::vector<Numbers> cached(btBroadphaseInterface& broadphase) {
  std::vector<Numbers> pairs;
  btBroadphasePairArray& array = broadphase.getOverlappingPairCache()->getOverlappingPairArray();
  for (int i = 0; i < array.size(); ++i)
    pairs.push_back(std::minmax({number_of(*array[i].m_pProxy0), number_of(*array[i].m_pProxy1)}));
  return pairs;
}

/// The same after an update, sorted.
inline std::vector<Numbers> updated(btBroadphaseInterface& broadphase) {
  broadphase.calculateOverlappingPairs(nullptr);
  std::vector<Numbers> pairs = cached(broadphase);
  std::ranges::sort(pairs);
  return pairs;
}

/// Lists what a query finds, and calls a function for each.
template <typename Base, typename Function = void (*)(const btBroadphaseProxy*)>
struct Lists final : Base {
  explicit Lists(Function each = [](const btBroadphaseProxy*) {}) : function(each) {}
  bool process(const btBroadphaseProxy* proxy) override {
    numbers.insert(number_of(*proxy));
    function(proxy);
    return false;  // which Bullet's broad phases do not look at
  }
  std::multiset<std::uintptr_t> numbers;
  Function function;
};

inline std::multiset<std::uintptr_t> ray(btBroadphaseInterface& broadphase, const btVector3& from,
                                         const btVector3& to, const btVector3& min = {0, 0, 0},
                                         const btVector3& max = {0, 0, 0}) {
  Lists<btBroadphaseRayCallback> list;
  const btVector3 way = to - from;
  for (int axis = 0; axis < 3; ++axis) {
    list.m_rayDirectionInverse[axis] = way[axis] == 0 ? btScalar(BT_LARGE_FLOAT) : 1 / way[axis];
    list.m_signs[axis] = list.m_rayDirectionInverse[axis] < 0 ? 1 : 0;
  }
  list.m_lambda_max = 1;
  broadphase.rayTest(from, to, list, min, max);
  return list.numbers;
}

inline std::multiset<std::uintptr_t> overlapping(btBroadphaseInterface& broadphase, const btVector3& min,
                                                 const btVector3& max) {
  Lists<btBroadphaseAabbCallback> list;
  broadphase.aabbTest(min, max, list);
  return list.numbers;
}

}  // namespace broadside::bullet_tests

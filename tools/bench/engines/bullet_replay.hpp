// Records the calls that a simulation makes to its broad phase, and replays them to other broad phases.
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <btBulletDynamicsCommon.h>

#include "bench/engines/bullet_simulation.hpp"

namespace broadside::bench {

/// A moved box, by its proxy's place in the order of creation.
struct ProxyMove {
  int proxy;
  btVector3 min;
  btVector3 max;
};

/// Bullet's broad phase, recording the calls it gets.
class NotedCalls final : public btDbvtBroadphase {
 public:
  struct Created {
    ProxyMove call;
    int group;
    int mask;
  };

  btBroadphaseProxy* createProxy(const btVector3& min, const btVector3& max, int type, void* client,
                                 int group, int mask, btDispatcher* dispatcher) override {
    btBroadphaseProxy* const proxy =
        btDbvtBroadphase::createProxy(min, max, type, client, group, mask, dispatcher);
    places_[proxy] = static_cast<int>(created.size());
    created.push_back({{places_[proxy], min, max}, group, mask});
    return proxy;
  }
  void setAabb(btBroadphaseProxy* proxy, const btVector3& min, const btVector3& max,
               btDispatcher* dispatcher) override {
    calls.push_back({places_.at(proxy), min, max});
    btDbvtBroadphase::setAabb(proxy, min, max, dispatcher);
  }
  void calculateOverlappingPairs(btDispatcher* dispatcher) override {
    ends.push_back(calls.size());
    btDbvtBroadphase::calculateOverlappingPairs(dispatcher);
  }

  std::vector<Created> created;
  std::vector<ProxyMove> calls;
  std::vector<std::size_t> ends;  ///< end of each step in the list of calls

 private:
  std::map<btBroadphaseProxy*, int> places_;
};

/// Replays a recording to a broad phase.
class BulletReplay {
 public:
  BulletReplay(const NotedCalls& recording, std::unique_ptr<btBroadphaseInterface> broadphase)
      : recording_(recording), broadphase_(std::move(broadphase)) {
    for (const NotedCalls::Created& made : recording.created)
      proxies_.push_back(
          broadphase_->createProxy(made.call.min, made.call.max, 0, nullptr, made.group, made.mask, nullptr));
  }

  /// Runs one step; returns its microseconds.
  double step(std::size_t number) {
    const std::size_t first = number == 0 ? 0 : recording_.ends[number - 1];
    const ThreadStopwatch watch;
    for (std::size_t i = first; i < recording_.ends[number]; ++i) {
      const ProxyMove& call = recording_.calls[i];
      broadphase_->setAabb(proxies_[static_cast<std::size_t>(call.proxy)], call.min, call.max, nullptr);
    }
    broadphase_->calculateOverlappingPairs(nullptr);
    return watch.microseconds();
  }

  btBroadphaseInterface& broadphase() { return *broadphase_; }
  /// The unique ids of the overlapping pairs in the cache, sorted.
  std::vector<std::pair<int, int>> overlapping_pairs() {
    std::vector<std::pair<int, int>> pairs;
    const btBroadphasePairArray& cached = broadphase_->getOverlappingPairCache()->getOverlappingPairArray();
    for (int i = 0; i < cached.size(); ++i) {
      const btBroadphaseProxy& a = *cached[i].m_pProxy0;
      const btBroadphaseProxy& b = *cached[i].m_pProxy1;
      if (TestAabbAgainstAabb2(a.m_aabbMin, a.m_aabbMax, b.m_aabbMin, b.m_aabbMax))
        pairs.push_back(std::minmax(a.m_uniqueId, b.m_uniqueId));
    }
    std::ranges::sort(pairs);
    return pairs;
  }

  int pairs() const { return broadphase_->getOverlappingPairCache()->getNumOverlappingPairs(); }

 private:
  const NotedCalls& recording_;
  std::unique_ptr<btBroadphaseInterface> broadphase_;
  std::vector<btBroadphaseProxy*> proxies_;
};

/// Counts the proxies that a ray meets.
struct CountingRay final : btBroadphaseRayCallback {
  CountingRay(const btVector3& from, const btVector3& to) {
    const btVector3 way = to - from;
    for (int axis = 0; axis < 3; ++axis) {
      m_rayDirectionInverse[axis] = way[axis] == 0 ? btScalar(BT_LARGE_FLOAT) : 1 / way[axis];
      m_signs[axis] = m_rayDirectionInverse[axis] < 0 ? 1 : 0;
    }
    m_lambda_max = 1;
  }
  bool process(const btBroadphaseProxy*) override {
    ++met;
    return true;
  }
  std::size_t met = 0;
};

}  // namespace broadside::bench

// Keeps the world's pairs in Bullet's pair cache, which may refuse pairs, and which the user may change.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btDispatcher.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include "broadside/bullet/proxies.hpp"
#include "broadside/world.hpp"

namespace broadside::bullet_detail {

/// Synchronises a pair cache with the world's pairs that it accepts. The cache's filter is called when a pair
/// begins and, while it refuses the pair, whenever one of the two boxes has moved.
class CachedPairs {
 public:
  explicit CachedPairs(btOverlappingPairCache& cache)
      : cache_(cache), expected_(cache.getNumOverlappingPairs()) {}

  /// Applies the events of a world's update. `step` is the step in which boxes moved before it.
  void apply(const World& world, const Events& events, std::uint32_t step, btDispatcher* dispatcher);

  /// Offers an overlapping pair that no update has reported yet.
  void offer_early(Proxy& a, Proxy& b);

  /// Removes all pairs of a proxy that is about to be destroyed.
  void remove_all_of(Proxy& proxy, btDispatcher* dispatcher) {
    const int before = cache_.getNumOverlappingPairs();
    cache_.removeOverlappingPairsContainingProxy(&proxy, dispatcher);
    expected_ -= before - cache_.getNumOverlappingPairs();
  }

  /// Forgets everything, once there are no proxies.
  void reset() {
    absent_.clear();
    early_.clear();
    expected_ = cache_.getNumOverlappingPairs();
  }

 private:
  /// A pair and its proxies; they may have been destroyed since.
  struct Link {
    HandlePair pair;
    Proxy* first;
    Proxy* second;

    bool is_live() const noexcept { return first->handle == pair.first && second->handle == pair.second; }
  };

  static Link link(const HandlePair& pair, const UserDataPair& data) noexcept {
    return {pair, &proxy_in(data.first), &proxy_in(data.second)};
  }

  static std::uint64_t key(const btBroadphaseProxy& a, const btBroadphaseProxy& b) noexcept {
    const auto [low, high] = std::minmax(a.m_uniqueId, b.m_uniqueId);
    return std::uint64_t{static_cast<std::uint32_t>(low)} << 32 | static_cast<std::uint32_t>(high);
  }

  static bool has(const std::vector<Link>& links, const HandlePair& pair) {
    return std::ranges::binary_search(links, pair, {}, &Link::pair);
  }

  void offer(const Link& link) {
    if (link.is_live() && cache_.addOverlappingPair(link.first, link.second) == nullptr)
      absent_.push_back(link);
  }

  void remove(const std::vector<Link>& links, btDispatcher* dispatcher);
  void make_equal(const World& world, btDispatcher* dispatcher);

  btOverlappingPairCache& cache_;
  std::vector<Link> absent_;  // sorted pairs of the world that the cache does not hold
  std::vector<Link> early_;   // pairs in the cache that no update has reported yet
  int expected_;              // number of pairs in the cache, unless other code has changed it
};

inline void CachedPairs::offer_early(Proxy& a, Proxy& b) {
  if (cache_.findPair(&a, &b) != nullptr) return;
  const bool is_ordered = a.handle.slot < b.handle.slot;
  Proxy& first = is_ordered ? a : b;
  Proxy& second = is_ordered ? b : a;
  early_.reserve(early_.size() + 1);
  const int before = cache_.getNumOverlappingPairs();
  if (cache_.addOverlappingPair(&first, &second) == nullptr) return;
  expected_ += cache_.getNumOverlappingPairs() - before;
  early_.push_back({{first.handle, second.handle}, &first, &second});
}

inline void CachedPairs::apply(const World& world, const Events& events, std::uint32_t step,
                               btDispatcher* dispatcher) {
  // If a callback of the cache throws, the next call sees -1.
  const int expected = std::exchange(expected_, -1);
  if (cache_.getNumOverlappingPairs() != expected) return make_equal(world, dispatcher);

  std::vector<Link> early;
  std::swap(early, early_);
  std::ranges::sort(early, {}, &Link::pair);
  std::vector<Link> gone;
  for (std::size_t i = 0; i < events.ended.size(); ++i)
    gone.push_back(link(events.ended[i], events.ended_data[i]));
  for (const Link& one : early) {
    if (!std::ranges::binary_search(events.begun, one.pair) && !has(absent_, one.pair)) gone.push_back(one);
  }
  std::erase_if(absent_, [&](const Link& one) {
    return !one.is_live() || has(early, one.pair) || std::ranges::binary_search(events.ended, one.pair);
  });
  remove(gone, dispatcher);

  std::vector<Link> absent;
  std::swap(absent, absent_);
  for (const Link& one : absent) {
    if (one.first->moved == step || one.second->moved == step)
      offer(one);
    else
      absent_.push_back(one);
  }
  for (std::size_t i = 0; i < events.begun.size(); ++i) {
    if (!has(early, events.begun[i])) offer(link(events.begun[i], events.begun_data[i]));
  }
  std::ranges::sort(absent_, {}, &Link::pair);
  expected_ = cache_.getNumOverlappingPairs();
}

/// Removes pairs from the cache if it holds them.
inline void CachedPairs::remove(const std::vector<Link>& links, btDispatcher* dispatcher) {
  if (!cache_.hasDeferredRemoval()) {
    for (const Link& one : links) {
      if (one.is_live()) cache_.removeOverlappingPair(one.first, one.second, dispatcher);
    }
    return;
  }
  // With such a cache, the broad phase must remove pairs from the cache's array.
  std::vector<std::uint64_t> keys;
  for (const Link& one : links) {
    if (one.is_live()) keys.push_back(key(*one.first, *one.second));
  }
  if (keys.empty()) return;
  std::ranges::sort(keys);
  btBroadphasePairArray& pairs = cache_.getOverlappingPairArray();
  int kept = 0;
  for (int i = 0; i < pairs.size(); ++i) {
    if (std::ranges::binary_search(keys, key(*pairs[i].m_pProxy0, *pairs[i].m_pProxy1)))
      cache_.cleanOverlappingPair(pairs[i], dispatcher);
    else
      pairs[kept++] = pairs[i];
  }
  pairs.resize(kept);
}

/// After other code has changed the cache, or a callback threw: removes pairs that the world does not have,
/// and offers missing ones.
inline void CachedPairs::make_equal(const World& world, btDispatcher* dispatcher) {
  absent_.clear();
  early_.clear();
  std::vector<Link> wanted;
  std::vector<std::uint64_t> wanted_keys;
  for (const HandlePair& pair : world.pairs()) {
    wanted.push_back(link(pair, {world.user_data(pair.first), world.user_data(pair.second)}));
    wanted_keys.push_back(key(*wanted.back().first, *wanted.back().second));
  }
  std::ranges::sort(wanted_keys);

  std::vector<Link> strays;
  std::vector<std::uint64_t> held_keys;
  const btBroadphasePairArray& pairs = cache_.getOverlappingPairArray();
  for (int i = 0; i < pairs.size(); ++i) {
    Proxy& first = static_cast<Proxy&>(*pairs[i].m_pProxy0);
    Proxy& second = static_cast<Proxy&>(*pairs[i].m_pProxy1);
    held_keys.push_back(key(first, second));
    if (!std::ranges::binary_search(wanted_keys, held_keys.back()))
      strays.push_back({{first.handle, second.handle}, &first, &second});
  }
  std::ranges::sort(held_keys);
  remove(strays, dispatcher);
  for (const Link& one : wanted) {
    if (!std::ranges::binary_search(held_keys, key(*one.first, *one.second))) offer(one);
  }
  std::ranges::sort(absent_, {}, &Link::pair);
  expected_ = cache_.getNumOverlappingPairs();
}

}  // namespace broadside::bullet_detail

// The member functions of BulletBroadphase. Include broadside/bullet.hpp.
#pragma once

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>

#include "broadside/bullet.hpp"
#include "broadside/error.hpp"
#include "broadside/filter.hpp"
#include "broadside/queries.hpp"

namespace broadside {
namespace bullet_detail {

template <typename Error>
[[noreturn]] inline void refuse(const std::string& message) {
#if defined(__cpp_exceptions)
  throw Error(message);
#else
  std::fprintf(stderr, "broadside: %s\n", message.c_str());
  std::abort();
#endif
}

inline WorldOptions checked(const WorldOptions& options) {
  if (!options.keep_pairs)
    refuse<std::invalid_argument>(
        "BulletBroadphase: keep_pairs is false; expected true, for what others change "
        "in the pair cache is made good from the world's pairs");
  return options;
}

}  // namespace bullet_detail

inline BulletBroadphase::BulletBroadphase(btOverlappingPairCache* pair_cache, const WorldOptions& options)
    : options_(bullet_detail::checked(options)),
      world_(options),
      own_cache_(pair_cache == nullptr ? new PairCache : nullptr),
      pair_cache_(pair_cache == nullptr ? own_cache_.get() : pair_cache),
      cached_pairs_(*pair_cache_) {}

inline btBroadphaseProxy* BulletBroadphase::createProxy(const btVector3& min, const btVector3& max, int,
                                                        void* client_object, int filter_group,
                                                        int filter_mask, btDispatcher*) {
  if (last_id_ == std::numeric_limits<int>::max())
    bullet_detail::refuse<std::length_error>("createProxy(): all " + std::to_string(last_id_) +
                                             " unique ids are used up; expected a resetPool() before");
  Proxy& proxy = proxies_.next();
  proxy.m_collisionFilterGroup = proxy.filter_group = filter_group;
  proxy.m_collisionFilterMask = proxy.filter_mask = filter_mask;
  const Filter filter = is_callback_deciding_ ? Filter{} : filter_of(proxy);
  const Handle handle = world_.add(bullet_detail::box_of(min, max),
                                   {.filter = filter, .user_data = bullet_detail::user_data_of(proxy)});
  proxies_.take();
  proxy.handle = handle;
  proxy.m_clientObject = client_object;
  proxy.m_uniqueId = ++last_id_;
  proxy.m_aabbMin = min;
  proxy.m_aabbMax = max;
  note_enlarged(proxy, bullet_detail::box_of(min, max));
  proxy.moved = proxy.checked = step_;
  ++checked_;
  if (is_ghost(proxy)) offer_overlaps_of(proxy);
  return &proxy;
}

inline void BulletBroadphase::destroyProxy(btBroadphaseProxy* destroyed, btDispatcher* dispatcher) {
  Proxy& proxy = used(destroyed, "destroyProxy()");
  world_.remove(proxy.handle);
  cached_pairs_.remove_all_of(proxy, dispatcher);
  if (proxy.checked == step_) --checked_;
  proxies_.give_back(proxy);
}

inline void BulletBroadphase::setAabb(btBroadphaseProxy* moved, const btVector3& min, const btVector3& max,
                                      btDispatcher*) {
  Proxy& proxy = used(moved, "setAabb()");
  const bullet_detail::Box box = bullet_detail::box_of(min, max);
  if (box != bullet_detail::box_of(proxy.m_aabbMin, proxy.m_aabbMax)) {
    move(proxy, box);
    proxy.m_aabbMin = min;
    proxy.m_aabbMax = max;
    proxy.moved = step_;
  }
  check_filter(proxy);
  if (is_ghost(proxy)) offer_overlaps_of(proxy);
}

/// Moves the proxy's box in the world, unless the move would affect only queries.
inline void BulletBroadphase::move(Proxy& proxy, const bullet_detail::Box& box) {
  // If a box has shrunk, the world shrinks its enlarged box.
  const bool stays =
      options_.events == WorldEvents::enlarged && bullet_detail::encloses(proxy.enlarged, box) &&
      bullet_detail::sides_of(proxy.enlarged) - bullet_detail::sides_of(box) <= 2 * proxy.spare;
  if (stays)
    proxy.is_untold = has_untold_ = true;
  else
    tell(proxy, box);
}

inline void BulletBroadphase::tell(Proxy& proxy, const bullet_detail::Box& box) {
  if (options_.predicted_frames > 0) {
    const bullet_detail::Box before = bullet_detail::box_of(proxy.m_aabbMin, proxy.m_aabbMax);
    world_.move(proxy.handle, box,
                {box.min[0] - before.min[0], box.min[1] - before.min[1], box.min[2] - before.min[2]});
  } else {
    world_.move(proxy.handle, box);
  }
  note_enlarged(proxy, box);
}

/// Copies the proxy's enlarged box from the world, which has just got `box`.
inline void BulletBroadphase::note_enlarged(Proxy& proxy, const bullet_detail::Box& box) {
  proxy.is_untold = false;
  if (options_.events != WorldEvents::enlarged) return;
  proxy.enlarged = world_.enlarged_box(proxy.handle);
  proxy.spare = bullet_detail::sides_of(proxy.enlarged) - bullet_detail::sides_of(box);
  reach_ = std::max(reach_, bullet_detail::reach_beyond(proxy.enlarged, box));
}

inline const BulletBroadphase::World& BulletBroadphase::world() {
  if (has_untold_) {
    proxies_.for_each_used([this](Proxy& proxy) {
      if (proxy.is_untold) tell(proxy, bullet_detail::box_of(proxy.m_aabbMin, proxy.m_aabbMax));
    });
    has_untold_ = false;
  }
  return world_;
}

inline void BulletBroadphase::getAabb(btBroadphaseProxy* proxy, btVector3& min, btVector3& max) const {
  const Proxy& asked = used(proxy, "getAabb()");
  min = asked.m_aabbMin;
  max = asked.m_aabbMax;
}

inline void BulletBroadphase::rayTest(const btVector3& from, const btVector3& to,
                                      btBroadphaseRayCallback& callback, const btVector3& min,
                                      const btVector3& max) {
  const btVector3 way = to - from;
  // The end of the line is rounded; a box that touches it must still be found.
  const btScalar end = 1 + 4 * std::numeric_limits<btScalar>::epsilon();
  const BoxCast<3, btScalar> cast = {
      bullet_detail::box_of(from + min, from + max), {way.x(), way.y(), way.z()}, end};
  BoxCast<3, btScalar> wide = cast;
  wide.box = bullet_detail::widened(cast.box, reach());
  std::vector<Found> all;
  world_.hits(wide, [&](Handle handle, btScalar) {
    const Found one = found(handle);
    if (reach() == 0 || t_enter(cast, bullet_detail::box_of(one.proxy->m_aabbMin, one.proxy->m_aabbMax)))
      all.push_back(one);
    return true;
  });
  process(all, callback);
}

inline void BulletBroadphase::aabbTest(const btVector3& min, const btVector3& max,
                                       btBroadphaseAabbCallback& callback) {
  process(overlapping(bullet_detail::box_of(min, max)), callback);
}

/// The proxies whose boxes overlap the given one.
inline std::vector<BulletBroadphase::Found> BulletBroadphase::overlapping(
    const bullet_detail::Box& box, const World::QueryOptions& options) const {
  std::vector<Found> all;
  world_.overlapping(
      bullet_detail::widened(box, reach()),
      [&](Handle handle) {
        const Found one = found(handle);
        if (reach() == 0 || overlap(box, bullet_detail::box_of(one.proxy->m_aabbMin, one.proxy->m_aabbMax)))
          all.push_back(one);
        return true;
      },
      options);
  return all;
}

template <typename Callback>
void BulletBroadphase::process(const std::vector<Found>& all, Callback& callback) {
  for (const Found& one : all) {
    if (one.proxy->handle == one.handle) callback.process(one.proxy);
  }
}

inline void BulletBroadphase::calculateOverlappingPairs(btDispatcher* dispatcher) {
  if (is_calculating_)
    bullet_detail::refuse<std::logic_error>(
        "calculateOverlappingPairs() was called by a callback of its own; expected it to have returned");
  struct Calculating {
    explicit Calculating(bool& flag) : is_calculating(flag) { is_calculating = true; }
    ~Calculating() { is_calculating = false; }
    bool& is_calculating;
  } const calculating(is_calculating_);
  check_filters();
  const Events events = world_.update();
  checked_ = 0;
  const std::uint32_t step = step_++;
  cached_pairs_.apply(world_, events, step, dispatcher);
}

inline void BulletBroadphase::getBroadphaseAabb(btVector3& min, btVector3& max) const {
  bool is_first = true;
  min = max = btVector3(0, 0, 0);
  proxies_.for_each_used([&](const Proxy& proxy) {
    if (is_first) {
      min = proxy.m_aabbMin;
      max = proxy.m_aabbMax;
    }
    is_first = false;
    min.setMin(proxy.m_aabbMin);
    max.setMax(proxy.m_aabbMax);
  });
}

inline void BulletBroadphase::resetPool(btDispatcher*) {
  if (proxies_.used() > 0) return;
  World fresh(options_);
  fresh.set_workers(world_.workers());
  world_ = std::move(fresh);
  proxies_.reset();
  cached_pairs_.reset();
  has_untold_ = false;
  reach_ = 0;
  last_id_ = 0;
  checked_ = 0;
}

inline void BulletBroadphase::printStats() {
  const WorldStatistics now = world_.statistics();
  std::printf("Broadside %s: %zu boxes, %zu pairs (%zu begun, %zu ended), %zu bytes. %s\n",
              options_.algorithm.text().c_str(), now.boxes, now.pairs, now.begun, now.ended,
              now.bytes.total(), now.explanation.c_str());
}

/// The proxy, if it is a proxy of this broad phase and was not destroyed.
inline bullet_detail::Proxy& BulletBroadphase::used(const btBroadphaseProxy* proxy,
                                                    const char* function) const {
  const bool is_own = proxies_.owns(proxy);
  if (is_own && static_cast<const Proxy*>(proxy)->is_used())
    return const_cast<Proxy&>(static_cast<const Proxy&>(*proxy));
  char address[32];
  std::snprintf(address, sizeof(address), "%p", static_cast<const void*>(proxy));
  bullet_detail::refuse<InvalidHandle>(std::string(function) + ": the proxy at " + address +
                                       (is_own ? " was destroyed" : " was never made by this broad phase") +
                                       "; expected one of createProxy() that is in use");
}

inline btBroadphaseProxy* BulletBroadphase::proxy(Handle handle) const {
  Proxy& proxy = bullet_detail::proxy_in(world_.user_data(handle));
  if (proxy.handle != handle)
    bullet_detail::refuse<InvalidHandle>("proxy(): the box of slot " + std::to_string(handle.slot) +
                                         ", generation " + std::to_string(handle.generation) +
                                         " was removed; expected one in the world");
  return &proxy;
}

/// With Bullet's callback for ghost objects, every client object is a btCollisionObject; that callback relies
/// on it, too.
inline bool BulletBroadphase::is_ghost(const Proxy& proxy) const {
  if (own_cache_ == nullptr || !own_cache_->has_ghosts() || proxy.m_clientObject == nullptr) return false;
  return static_cast<const btCollisionObject*>(proxy.m_clientObject)->getInternalType() ==
         btCollisionObject::CO_GHOST_OBJECT;
}

/// A character controller sets its ghost's box and reads its overlaps at once.
inline void BulletBroadphase::offer_overlaps_of(Proxy& proxy) {
  const bullet_detail::Box box = bullet_detail::box_of(proxy.m_aabbMin, proxy.m_aabbMax);
  if (!is_present(box)) return;
  const Filter filter = world_.filter(proxy.handle);
  const std::vector<Found> all = overlapping(box, {&filter, proxy.handle});
  const Handle handle = proxy.handle;
  for (const Found& one : all) {
    if (one.proxy->handle == one.handle && proxy.handle == handle)
      cached_pairs_.offer_early(proxy, *one.proxy);
  }
}

/// Passes the proxy's group and mask to the world's filter, unless a callback decides.
inline void BulletBroadphase::tell_filter(Proxy& proxy, bool is_callback_deciding) {
  world_.set_filter(proxy.handle, is_callback_deciding ? Filter{} : filter_of(proxy));
  proxy.filter_group = proxy.m_collisionFilterGroup;
  proxy.filter_mask = proxy.m_collisionFilterMask;
}

/// Adopts group and mask if the user has changed them in the proxy.
inline void BulletBroadphase::check_filter(Proxy& proxy) {
  if (proxy.filter_group != proxy.m_collisionFilterGroup || proxy.filter_mask != proxy.m_collisionFilterMask)
    tell_filter(proxy, is_callback_deciding_);
  if (proxy.checked != step_) ++checked_;
  proxy.checked = step_;
}

/// Unless told otherwise, Bullet sets each box in each step; then there is nothing left to do.
inline void BulletBroadphase::check_filters() {
  const bool decides = pair_cache_->getOverlapFilterCallback() != nullptr;
  if (decides != is_callback_deciding_) {
    proxies_.for_each_used([&](Proxy& proxy) { tell_filter(proxy, decides); });
    is_callback_deciding_ = decides;
  } else if (checked_ < proxies_.used()) {
    proxies_.for_each_used([this](Proxy& proxy) { check_filter(proxy); });
  }
}

}  // namespace broadside

// BulletBroadphase: a World as the broad phase of the physics engine Bullet 3, in place of
// btDbvtBroadphase.
//
//   broadside::BulletBroadphase broadphase;
//   btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <BulletCollision/BroadphaseCollision/btBroadphaseInterface.h>
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/BroadphaseCollision/btOverlappingPairCache.h>

#include "broadside/bullet/cached_pairs.hpp"
#include "broadside/bullet/proxies.hpp"
#include "broadside/world.hpp"

namespace broadside {

/// Implements Bullet's broad-phase interface with a World of floats or, with BT_USE_DOUBLE_PRECISION, of
/// doubles.
///
/// calculateOverlappingPairs(), which Bullet calls in each step, brings the pairs up to date; rayTest() and
/// aabbTest() see each box as it was last set. The pair cache then holds the world's pairs that its filter
/// accepts, and the order of its changes is the same in each run. A proxy's group and mask may be changed at
/// any time; changes take effect at the next calculateOverlappingPairs(), also for existing pairs. An overlap
/// filter callback replaces the filter by group and mask. It is called when a pair begins and, while it
/// refuses the pair, in each step in which one of the two boxes has moved. Pairs that the user removes from
/// the cache return in the next step if the boxes overlap, and pairs that the user adds are removed if they
/// do not. Ghost objects get their overlaps as soon as their box is set, if the broad phase uses its own pair
/// cache.
///
/// Not thread-safe; between changes, several threads may call rayTest(), aabbTest() and the const members.
/// Errors are exceptions, and a call that throws has changed nothing. A program compiled without exceptions
/// prints a line on standard error and ends. InvalidHandle: the proxy was destroyed, or belongs to no proxy
/// of this broad phase. InvalidInput: a box has a NaN or min > max (WorldOptions::bad_input can accept it as
/// absent instead). InvalidQuery: a query's box or ray has a NaN, or a ray is infinite.
class BulletBroadphase final : public btBroadphaseInterface {
 public:
  using World = broadside::World<3, btScalar>;

  /// Default options: boxes are enlarged by gDbvtMargin (0.05), as btDbvtBroadphase does, and pairs are those
  /// of the enlarged boxes, which bodies trembling in a heap hardly ever leave. With WorldOptions{}, pairs
  /// are those of the boxes themselves.
  static WorldOptions standard_options() { return {.margin = gDbvtMargin, .events = WorldEvents::enlarged}; }

  /// Uses the caller's pair cache, which must outlive the broad phase, or one of its own. Throws what World
  /// throws, and std::invalid_argument if options.keep_pairs is false. With predicted_frames, a box's
  /// velocity is estimated from its last two positions.
  explicit BulletBroadphase(btOverlappingPairCache* pair_cache = nullptr,
                            const WorldOptions& options = standard_options());
  explicit BulletBroadphase(const WorldOptions& options) : BulletBroadphase(nullptr, options) {}

  BulletBroadphase(const BulletBroadphase&) = delete;
  BulletBroadphase& operator=(const BulletBroadphase&) = delete;

  /// Unique ids count up, as in btDbvtBroadphase, so that m_deterministicOverlappingPairs gives the same
  /// order with both. The shape type and the dispatcher are not used.
  btBroadphaseProxy* createProxy(const btVector3& min, const btVector3& max, int shape_type,
                                 void* client_object, int filter_group, int filter_mask,
                                 btDispatcher* dispatcher) override;

  /// Removes the proxy's pairs from the cache at once.
  void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;

  void setAabb(btBroadphaseProxy* proxy, const btVector3& min, const btVector3& max,
               btDispatcher* dispatcher) override;
  void getAabb(btBroadphaseProxy* proxy, btVector3& min, btVector3& max) const override;

  /// Calls `callback` for each proxy whose box meets the line from `from` to `to` or, if `min` and `max` are
  /// given, meets that box swept along the line. Like Bullet's own broad phases, it ignores the callback's
  /// return value. The callback may create, move and destroy proxies; a proxy destroyed before its turn is
  /// skipped.
  void rayTest(const btVector3& from, const btVector3& to, btBroadphaseRayCallback& callback,
               const btVector3& min = btVector3(0, 0, 0), const btVector3& max = btVector3(0, 0, 0)) override;

  /// As rayTest(), for each proxy whose box overlaps the given one.
  void aabbTest(const btVector3& min, const btVector3& max, btBroadphaseAabbCallback& callback) override;

  /// Throws std::logic_error if called from one of its own callbacks. Otherwise, callbacks may create, move
  /// and destroy proxies. After an exception, the next call completes the work.
  void calculateOverlappingPairs(btDispatcher* dispatcher) override;

  btOverlappingPairCache* getOverlappingPairCache() override { return pair_cache_; }
  const btOverlappingPairCache* getOverlappingPairCache() const override { return pair_cache_; }

  /// The bounds of all boxes; a point at the origin if there are none. O(boxes).
  void getBroadphaseAabb(btVector3& min, btVector3& max) const override;

  /// Resets to the initial state if there are no proxies; otherwise does nothing, like btDbvtBroadphase.
  void resetPool(btDispatcher* dispatcher) override;

  /// Prints a line on standard output: boxes, pairs, figures of the last update.
  void printStats() override;

  /// The world and the proxies of its boxes, for queries beyond Bullet's interface. Throws InvalidHandle as
  /// above. The first call after boxes were set passes the world those that stayed in their enlarged boxes,
  /// O(boxes); no other thread may use the broad phase meanwhile.
  const World& world();
  Handle handle(const btBroadphaseProxy* proxy) const { return used(proxy, "handle()").handle; }
  btBroadphaseProxy* proxy(Handle handle) const;

  /// See World::set_workers().
  void set_workers(const Workers& workers) { world_.set_workers(workers); }

 private:
  using Proxy = bullet_detail::Proxy;

  /// Bullet's pair cache, extended to tell whether there are ghost objects.
  class PairCache final : public btHashedOverlappingPairCache {
   public:
    void setInternalGhostPairCallback(btOverlappingPairCallback* callback) override {
      m_ghostPairCallback = callback;
    }
    bool has_ghosts() const noexcept { return m_ghostPairCallback != nullptr; }
  };

  /// Results of a query, copied so that a callback may change the world.
  struct Found {
    Handle handle;
    Proxy* proxy;
  };

  Proxy& used(const btBroadphaseProxy* proxy, const char* function) const;
  void move(Proxy& proxy, const bullet_detail::Box& box);
  void tell(Proxy& proxy, const bullet_detail::Box& box);
  void note_enlarged(Proxy& proxy, const bullet_detail::Box& box);
  btScalar reach() const noexcept { return has_untold_ ? reach_ : 0; }
  Found found(Handle handle) const { return {handle, &bullet_detail::proxy_in(world_.user_data(handle))}; }
  std::vector<Found> overlapping(const bullet_detail::Box& box,
                                 const World::QueryOptions& options = {}) const;
  template <typename Callback>
  static void process(const std::vector<Found>& all, Callback& callback);
  bool is_ghost(const Proxy& proxy) const;
  void offer_overlaps_of(Proxy& proxy);
  void tell_filter(Proxy& proxy, bool is_callback_deciding);
  void check_filter(Proxy& proxy);
  void check_filters();

  WorldOptions options_;
  World world_;
  bullet_detail::ProxyPool proxies_;
  std::unique_ptr<PairCache> own_cache_;  // null if the cache is the caller's
  btOverlappingPairCache* pair_cache_;
  bullet_detail::CachedPairs cached_pairs_;
  int last_id_ = 0;
  std::uint32_t step_ = 1;   // number of calls of calculateOverlappingPairs()
  std::size_t checked_ = 0;  // proxies whose filter was compared in this step
  bool is_callback_deciding_ =
      false;  // the pair cache has an overlap filter callback, so the world does not filter
  bool is_calculating_ = false;

  // If pairs are those of enlarged boxes, the world does not get moves of a box inside its enlarged box.
  // Queries are widened by the maximum of such moves, and then test the box itself.
  bool has_untold_ = false;
  btScalar reach_ = 0;  // maximum distance by which an enlarged box extends beyond the box that the world has
};

}  // namespace broadside

#include "broadside/bullet/broadphase.hpp"

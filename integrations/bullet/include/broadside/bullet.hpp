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

/// Bullet's interface to broad phases over a World of floats or, with BT_USE_DOUBLE_PRECISION, of doubles.
///
/// Pairs are brought up to date by calculateOverlappingPairs(), which Bullet calls in each step; rayTest()
/// and aabbTest() see each box as it was last set. The pair cache then holds the world's pairs that its
/// filter accepts, and the order of its changes is the same in each run. A proxy's group and mask may be
/// changed at any time and count from the next calculateOverlappingPairs() on, for pairs that there are as
/// well. With an overlap filter callback, that alone decides; it is asked when a pair begins and, while it
/// says no, in each step in which one of the two boxes has moved. What the user takes out of the cache comes
/// back in the next step if the boxes overlap, and what they put in goes if they do not. Ghost objects meet
/// what their box overlaps as soon as it is set, where the pair cache is the broad phase's own.
///
/// One thread at a time; between changes, several may call rayTest(), aabbTest() and the const members.
/// Errors are exceptions, and what throws has changed nothing; a program compiled without exceptions ends
/// after a line on standard error. InvalidHandle: the proxy was destroyed, or is no proxy of this broad
/// phase. InvalidInput: a box has a NaN or min > max (WorldOptions::bad_input may take it in as absent
/// instead). InvalidQuery: a box or ray asked about has a NaN, or a ray is infinite.
class BulletBroadphase final : public btBroadphaseInterface {
 public:
  using World = broadside::World<3, btScalar>;

  /// Pairs of boxes enlarged as btDbvtBroadphase enlarges them, by gDbvtMargin (0.05), which bodies that
  /// tremble in a heap hardly ever leave. With WorldOptions{}, pairs are those of the boxes themselves.
  static WorldOptions standard_options() { return {.margin = gDbvtMargin, .events = WorldEvents::enlarged}; }

  /// With a pair cache of the caller's, which must outlive the broad phase, or with one of its own. Throws
  /// what World does, and std::invalid_argument if options.keep_pairs is false. With predicted_frames, a
  /// box's velocity is taken from its last two places.
  explicit BulletBroadphase(btOverlappingPairCache* pair_cache = nullptr,
                            const WorldOptions& options = standard_options());
  explicit BulletBroadphase(const WorldOptions& options) : BulletBroadphase(nullptr, options) {}

  BulletBroadphase(const BulletBroadphase&) = delete;
  BulletBroadphase& operator=(const BulletBroadphase&) = delete;

  /// Unique ids are counted up, as btDbvtBroadphase does, so that m_deterministicOverlappingPairs gives the
  /// same order with both. The shape's type and the dispatcher are not used.
  btBroadphaseProxy* createProxy(const btVector3& min, const btVector3& max, int shape_type,
                                 void* client_object, int filter_group, int filter_mask,
                                 btDispatcher* dispatcher) override;

  /// Takes the proxy's pairs out of the cache at once.
  void destroyProxy(btBroadphaseProxy* proxy, btDispatcher* dispatcher) override;

  void setAabb(btBroadphaseProxy* proxy, const btVector3& min, const btVector3& max,
               btDispatcher* dispatcher) override;
  void getAabb(btBroadphaseProxy* proxy, btVector3& min, btVector3& max) const override;

  /// Calls `callback` for each proxy whose box meets the line from `from` to `to` or, where `min` and `max`
  /// are given, that box moved along it; whatever the callback returns, as Bullet's own broad phases do. The
  /// callback may create, move and destroy proxies: one that is destroyed before its turn is left out.
  void rayTest(const btVector3& from, const btVector3& to, btBroadphaseRayCallback& callback,
               const btVector3& min = btVector3(0, 0, 0), const btVector3& max = btVector3(0, 0, 0)) override;

  /// The same for each proxy whose box overlaps the given one.
  void aabbTest(const btVector3& min, const btVector3& max, btBroadphaseAabbCallback& callback) override;

  /// Throws std::logic_error inside one of the callbacks that it calls. Those may create, move and destroy
  /// proxies otherwise. After an exception, the next call does what this one left undone.
  void calculateOverlappingPairs(btDispatcher* dispatcher) override;

  btOverlappingPairCache* getOverlappingPairCache() override { return pair_cache_; }
  const btOverlappingPairCache* getOverlappingPairCache() const override { return pair_cache_; }

  /// What encloses all boxes; a point at the origin if there are none. O(boxes).
  void getBroadphaseAabb(btVector3& min, btVector3& max) const override;

  /// Begins anew, as if just made, if there are no proxies; else does nothing, as btDbvtBroadphase.
  void resetPool(btDispatcher* dispatcher) override;

  /// A line on standard output: boxes, pairs, what the last update did.
  void printStats() override;

  /// The world, to ask it more than Bullet does, and the proxies of its boxes. InvalidHandle as above. The
  /// first call after boxes were set tells the world of those that stayed in their enlarged boxes, O(boxes);
  /// no other thread may use the broad phase meanwhile.
  const World& world();
  Handle handle(const btBroadphaseProxy* proxy) const { return used(proxy, "handle()").handle; }
  btBroadphaseProxy* proxy(Handle handle) const;

  /// See World::set_workers().
  void set_workers(const Workers& workers) { world_.set_workers(workers); }

 private:
  using Proxy = bullet_detail::Proxy;

  /// Bullet's pair cache, which tells whether there are ghost objects.
  class PairCache final : public btHashedOverlappingPairCache {
   public:
    void setInternalGhostPairCallback(btOverlappingPairCallback* callback) override {
      m_ghostPairCallback = callback;
    }
    bool has_ghosts() const noexcept { return m_ghostPairCallback != nullptr; }
  };

  /// What a query found, kept so that a callback may change the world.
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
  std::unique_ptr<PairCache> own_cache_;  // null where the cache is the caller's
  btOverlappingPairCache* pair_cache_;
  bullet_detail::CachedPairs cached_pairs_;
  int last_id_ = 0;
  std::uint32_t step_ = 1;   // counts calls of calculateOverlappingPairs()
  std::size_t checked_ = 0;  // proxies whose filter was compared in this step
  bool is_callback_deciding_ =
      false;  // the pair cache has an overlap filter callback: the world filters nothing
  bool is_calculating_ = false;

  // While enlarged boxes make the pairs, the world is not told of a box that moves inside its enlarged one:
  // queries are widened by what that may have moved, and look at the box itself.
  bool has_untold_ = false;
  btScalar reach_ = 0;  // the most by which an enlarged box reaches beyond the box that was told
};

}  // namespace broadside

#include "broadside/bullet/broadphase.hpp"

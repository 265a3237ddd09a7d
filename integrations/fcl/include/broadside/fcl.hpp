// FclCollisionManager: Broadside as the broad phase of FCL, the Flexible Collision Library.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <typeinfo>
#include <vector>

#include <fcl/broadphase/broadphase_collision_manager.h>

#include "broadside/box.hpp"
#include "broadside/fcl/by_distance.hpp"
#include "broadside/fcl/lazy_pairs.hpp"
#include "broadside/fcl/object_set.hpp"
#include "broadside/finder.hpp"
#include "broadside/pair.hpp"

namespace broadside {

/// A replacement for fcl::DynamicAABBTreeCollisionManager<S>, for S = float or double.
///
/// Collides objects by their AABBs as of the last registration or update. Reports the same pairs as FCL's
/// managers, each once; an object is never reported with itself. The caller owns the objects, which must
/// outlive their registration. An FCL octree counts as one box that contains it.
///
/// The order of callbacks is determined by the calls since construction, on every machine and for any number
/// of threads; callbacks of a distance query come in the order of the boxes' distances. A callback may query
/// this manager but must not change it. As with FCL's managers, several threads may query at once while
/// nothing is changed.
///
/// Costs: update() reads each object's box, which takes about ten nanoseconds. collide() of all objects
/// searches from scratch if more than about one in 16 objects changed, and otherwise updates the pairs of the
/// changed ones; without changes, it only calls back. The first query of one object builds an index, which
/// later queries bring up to date.
///
/// Invalid calls throw before anything has changed: std::invalid_argument for null, for an object that is
/// registered twice, or for updating or unregistering one that is not registered; InvalidInput for a box with
/// a NaN or min > max; std::logic_error for a change within a callback; InvalidSpec.
template <typename S>
class FclCollisionManager final : public fcl::BroadPhaseCollisionManager<S> {
 public:
  using Object = fcl::CollisionObject<S>;
  using Manager = fcl::BroadPhaseCollisionManager<S>;
  using CollisionCallBack = fcl::CollisionCallBack<S>;
  using DistanceCallBack = fcl::DistanceCallBack<S>;

  /// `algorithm` is the spec of the algorithm that finds the pairs, such as "auto:threads=2".
  explicit FclCollisionManager(std::string_view algorithm = default_algorithm) : pairs_(algorithm) {}
  FclCollisionManager(const FclCollisionManager&) = delete;
  FclCollisionManager& operator=(const FclCollisionManager&) = delete;

  void registerObjects(const std::vector<Object*>& objects) override { add(objects); }
  void registerObject(Object* object) override { add({&object, 1}); }
  void unregisterObject(Object* object) override;
  void clear() override;

  /// Nothing to do: queries bring their structures up to date.
  void setup() override {}

  void update() override;
  void update(Object* object) override { update_some({&object, 1}); }
  void update(const std::vector<Object*>& objects) override { update_some(objects); }

  void getObjects(std::vector<Object*>& objects) const override {
    objects.assign(objects_.objects().begin(), objects_.objects().end());
  }
  bool empty() const override { return objects_.size() == 0; }
  std::size_t size() const override { return objects_.size(); }

  /// The callback gets the registered object first and then `object`, which is tested with its current box.
  void collide(Object* object, void* data, CollisionCallBack callback) const override;
  void distance(Object* object, void* data, DistanceCallBack callback) const override;

  void collide(void* data, CollisionCallBack callback) const override;
  void distance(void* data, DistanceCallBack callback) const override;

  /// The callback gets this manager's object first. If `other` is this manager, collides its objects with
  /// each other, once. Throws std::invalid_argument if `other` is a manager of another kind.
  void collide(Manager* other, void* data, CollisionCallBack callback) const override;
  void distance(Manager* other, void* data, DistanceCallBack callback) const override;

 private:
  using Pairs = std::vector<detail::DistantPair<S>>;

  /// Marks a query as running.
  class QueryGuard {
   public:
    explicit QueryGuard(const FclCollisionManager& manager) : running_(manager.queries_) { ++running_; }
    QueryGuard(const QueryGuard&) = delete;
    QueryGuard& operator=(const QueryGuard&) = delete;
    ~QueryGuard() { --running_; }

   private:
    std::atomic<int>& running_;
  };

  void refuse_within_query() const {
    if (queries_ > 0)
      throw std::logic_error("the manager is changed within a query's callback; expected it after the query");
  }

  void add(std::span<Object* const> objects);
  void update_some(std::span<Object* const> objects);

  static const FclCollisionManager& same_kind(const Manager* other);

  const BoxIndex<3, S>& box_index() const {
    const std::lock_guard lock(mutex_);
    return pairs_.box_index(objects_.boxes());
  }

  /// `beyond` of visit_by_distance(), for `boxes` against the boxes of this manager.
  S beyond(S reached, std::span<const Box<3, S>> boxes, bool are_own) const;

  detail::FclObjectSet<S> objects_;
  mutable std::mutex mutex_;  // guards what queries bring up to date
  mutable detail::LazyPairs<S> pairs_;
  mutable std::atomic<int> queries_ = 0;
};

using FclCollisionManagerf = FclCollisionManager<float>;
using FclCollisionManagerd = FclCollisionManager<double>;

}  // namespace broadside

#include "broadside/fcl/collision_manager_inl.hpp"

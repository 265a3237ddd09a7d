// What the managers of FCL share: objects whose bounds are our boxes, and a finder over any manager.
#pragma once

#include <span>
#include <vector>

#include <fcl/broadphase/broadphase_collision_manager.h>
#include <fcl/narrowphase/collision_object.h>

#include "broadside/algorithm.hpp"

#include "lab/peers/callback_sink.hpp"

namespace broadside::lab::peers {

/// An object that is nothing but its bounds.
class FclObject final : public fcl::CollisionObjectd {
 public:
  /// What has no geometry can be in a manager and must not be asked for by itself.
  explicit FclObject(BoxId id, const std::shared_ptr<fcl::CollisionGeometryd>& geometry = nullptr)
      : fcl::CollisionObject<double>(geometry), id_(id) {}

  BoxId id() const { return id_; }
  void set(const Box3& box) {
    for (int axis = 0; axis < 3; ++axis) {
      aabb.min_[axis] = box.min[axis];
      aabb.max_[axis] = box.max[axis];
    }
  }

  /// Makes the bounds larger by less than floats lie apart.
  void widen();

 private:
  BoxId id_;
};

/// What a search hands through to its callback, which drops what a manager tells beyond the overlapping
/// pairs.
struct FclSearch {
  std::span<const Box3> boxes;
  CallbackSink pairs;

  static bool take(fcl::CollisionObjectd* first, fcl::CollisionObjectd* second, void* data);
};

using FclManager = std::unique_ptr<fcl::BroadPhaseCollisionManagerd>;
/// Makes an empty manager that suits `boxes`.
using MakeManager = FclManager (*)(std::span<const Box3> boxes);

/// The description of a manager: a finder that fills a new one in each call. `widened` if it goes wrong where
/// two bounds are equal.
Algorithm fcl_manager(MakeManager make, bool widened = false);

}  // namespace broadside::lab::peers

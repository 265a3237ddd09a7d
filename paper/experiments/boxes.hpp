// The boxes that experiments look at themselves, beside what they have measured.
#pragma once

#include <algorithm>
#include <span>
#include <string_view>

#include "broadside/box.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside::lab {

/// The boxes of the scene that `scene` names, in motion if the request has frames; throws as find_scene() and
/// make_history().
template <int D>
History<D> history_of(std::string_view scene, const SceneRequest& request) {
  const NamedScene named = find_scene(scene);
  return make_history<D>(named.scene, named.spec, request);
}

/// The least box that holds all of these; of none, the absent box.
template <int D>
Box<D> bounds_of(std::span<const Box<D>> boxes) {
  Box<D> bounds = absent_box<D>();
  for (const Box<D>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      bounds.min[axis] = std::min(bounds.min[axis], box.min[axis]);
      bounds.max[axis] = std::max(bounds.max[axis], box.max[axis]);
    }
  }
  return bounds;
}

}  // namespace broadside::lab

// Common parts of ODE's three spaces: geoms whose bounds are exactly our boxes.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>

#include <ode/ode.h>

#include "broadside/algorithm.hpp"

namespace broadside::lab::peers {

/// Destroys a space, which no longer holds a geom.
struct DestroySpace {
  void operator()(dSpaceID space) const { dSpaceDestroy(space); }
};
using OdeSpace = std::unique_ptr<dxSpace, DestroySpace>;

/// One of ODE's spaces.
struct OdeSpaceKind {
  /// Makes an empty space that suits `boxes`.
  OdeSpace (*make)(std::span<const Box3> boxes);

  /// The offset to add to every coordinate in a space for `boxes`; null: no offset.
  double (*shift)(std::span<const Box3> boxes) = nullptr;

  /// Whether the structure that the space keeps between frames saves it any work.
  bool tracks = true;

  /// Declared limit.
  std::size_t max_boxes = std::numeric_limits<std::size_t>::max();
};

/// The description of a space: a searcher that fills a new one in each call, and a follower that keeps one.
Algorithm ode_space(const OdeSpaceKind& kind);

}  // namespace broadside::lab::peers

// What ODE's three spaces share: geoms whose bounds are exactly our boxes.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>

#include <ode/ode.h>

#include "broadside/algorithm.hpp"

namespace broadside::lab::peers {

/// Destroys a space, which holds no geom any more.
struct DestroySpace {
  void operator()(dSpaceID space) const { dSpaceDestroy(space); }
};
using OdeSpace = std::unique_ptr<dxSpace, DestroySpace>;

/// One of ODE's spaces.
struct OdeSpaceKind {
  /// Makes an empty space that suits `boxes`.
  OdeSpace (*make)(std::span<const Box3> boxes);

  /// What is added to every coordinate on its way into a space for `boxes`; null where nothing is.
  double (*shift)(std::span<const Box3> boxes) = nullptr;

  /// Whether what the space keeps from one frame to the next saves it anything.
  bool tracks = true;

  /// Declared limit.
  std::size_t max_boxes = std::numeric_limits<std::size_t>::max();
};

/// The description of a space: a searcher that fills a new one in each call, and a follower that keeps one.
Algorithm ode_space(const OdeSpaceKind& kind);

}  // namespace broadside::lab::peers

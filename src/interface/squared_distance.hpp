// The square of the distance from a point to a box, as distance_squared() defines it.
#pragma once

#include <array>

#include "broadside/box.hpp"

namespace broadside::core {

/// distance_squared() for code that is in a DefaultEnvironment already.
template <int D, typename Real>
Real squared_distance(const Point<D, Real>& point, const Box<D, Real>& box) noexcept {
  Real sum = 0;
  for (int axis = 0; axis < D; ++axis) {
    Real outside = 0;
    if (point[axis] < box.min[axis]) outside = box.min[axis] - point[axis];
    if (point[axis] > box.max[axis]) outside = point[axis] - box.max[axis];
    sum += outside * outside;
  }
  return sum;
}

}  // namespace broadside::core

// Whether one box lies within another.
#pragma once

#include "broadside/box.hpp"

namespace broadside::core {

/// Whether no point of `inner` is outside of `outer`; both are present.
template <int D, typename Real>
constexpr bool encloses(const Box<D, Real>& outer, const Box<D, Real>& inner) noexcept {
  bool encloses = true;
  for (int axis = 0; axis < D; ++axis)
    encloses &= outer.min[axis] <= inner.min[axis] && inner.max[axis] <= outer.max[axis];
  return encloses;
}

}  // namespace broadside::core

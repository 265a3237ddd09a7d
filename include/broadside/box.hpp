// Axis-aligned boxes, and what "overlap" and "absent" mean for every algorithm.
#pragma once

#include <array>
#include <limits>

#include "broadside/cpp_version.hpp"

namespace broadside {

/// An axis-aligned box in D dimensions: the points p with min[a] <= p[a] <= max[a] on every axis a.
///
/// Boxes are closed: two that only touch overlap, and a degenerate box (min = max) is a point and counts.
/// Coordinates are in the caller's unit, float or double; infinite ones are allowed and mean what they say.
///
/// Coordinates are compared by value, denormals too, whatever rounding mode, flushing of denormals (FTZ, DAZ)
/// or traps the calling thread has set: the library computes in the default floating-point environment and
/// sets the caller's back before it returns, throws, or calls a sink, a visitor, a predicate or an executor.
/// Functions that are inline in these headers, such as overlap(), compute in the caller's.
template <int D, typename Real = float>
struct Box {
  std::array<Real, D> min;
  std::array<Real, D> max;

  friend constexpr bool operator==(const Box&, const Box&) = default;
};

using Box2 = Box<2>;
using Box3 = Box<3>;
using DoubleBox2 = Box<2, double>;
using DoubleBox3 = Box<3, double>;

/// The box that is not there: min = +inf and max = -inf on every axis. It overlaps nothing, not even an
/// infinite box, and stands in an array for a box that has been removed.
template <int D, typename Real = float>
constexpr Box<D, Real> absent_box() noexcept {
  Box<D, Real> box{};
  box.min.fill(std::numeric_limits<Real>::infinity());
  box.max.fill(-std::numeric_limits<Real>::infinity());
  return box;
}

/// Whether `box` is exactly the absent box.
template <int D, typename Real>
constexpr bool is_absent(const Box<D, Real>& box) noexcept {
  return box == absent_box<D, Real>();
}

/// Whether `box` has min <= max on every axis; false for the absent box and for a box with a NaN.
template <int D, typename Real>
constexpr bool is_present(const Box<D, Real>& box) noexcept {
  bool present = true;
  for (int axis = 0; axis < D; ++axis) present &= box.min[axis] <= box.max[axis];
  return present;
}

/// Whether two present boxes share a point. For an absent box the answer means nothing: ask is_absent first.
template <int D, typename Real>
constexpr bool overlap(const Box<D, Real>& a, const Box<D, Real>& b) noexcept {
  bool touching = true;
  for (int axis = 0; axis < D; ++axis) {
    touching &= a.min[axis] <= b.max[axis];
    touching &= b.min[axis] <= a.max[axis];
  }
  return touching;
}

}  // namespace broadside

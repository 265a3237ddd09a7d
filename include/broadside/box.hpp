// Axis-aligned boxes, and what "overlap" and "absent" mean for every algorithm.
#pragma once

#include <array>
#include <limits>

namespace broadside {

/// An axis-aligned box in D dimensions: the points p with min[a] <= p[a] <= max[a] on every axis a.
///
/// Boxes are closed: two that only touch overlap, and a degenerate box (min = max) is a point and counts.
/// Coordinates are in the caller's unit; infinite ones are allowed and mean what they say.
template <int D>
struct Box {
  std::array<float, D> min;
  std::array<float, D> max;

  friend constexpr bool operator==(const Box&, const Box&) = default;
};

using Box2 = Box<2>;
using Box3 = Box<3>;

/// The box that is not there: min = +inf and max = -inf on every axis. It overlaps nothing, not even an
/// infinite box, and stands in an array for a box that has been removed.
template <int D>
constexpr Box<D> absent_box() noexcept {
  Box<D> box{};
  box.min.fill(std::numeric_limits<float>::infinity());
  box.max.fill(-std::numeric_limits<float>::infinity());
  return box;
}

/// Whether `box` is exactly the absent box.
template <int D>
constexpr bool is_absent(const Box<D>& box) noexcept {
  return box == absent_box<D>();
}

/// Whether `box` has min <= max on every axis; false for the absent box and for a box with a NaN.
template <int D>
constexpr bool is_present(const Box<D>& box) noexcept {
  bool present = true;
  for (int axis = 0; axis < D; ++axis) present &= box.min[axis] <= box.max[axis];
  return present;
}

/// Whether two present boxes share a point. For an absent box the answer means nothing: ask is_absent first.
template <int D>
constexpr bool overlap(const Box<D>& a, const Box<D>& b) noexcept {
  bool touching = true;
  for (int axis = 0; axis < D; ++axis) {
    touching &= a.min[axis] <= b.max[axis];
    touching &= b.min[axis] <= a.max[axis];
  }
  return touching;
}

}  // namespace broadside

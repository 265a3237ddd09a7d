// Box: axis-aligned boxes (AABBs), and what "overlap" and "absent" mean for every algorithm.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include "broadside/version.hpp"

namespace broadside {

/// A position, a direction or a size in D dimensions.
template <int D, typename Real = float>
using Point = std::array<Real, static_cast<std::size_t>(D)>;

namespace detail {
template <int D, typename Real>
inline constexpr bool is_supported = (D == 2 || D == 3) &&
                                     (std::is_same_v<Real, float> || std::is_same_v<Real, double>);

/// Every class template over boxes instantiates this, so that the compiler reports an unsupported type of box
/// in one sentence.
template <int D, typename Real>
struct SupportedBox {
  static_assert(is_supported<D, Real>,
                "Broadside supports boxes of 2 or 3 dimensions with float or double coordinates");
  static constexpr bool value = true;
};
}  // namespace detail

/// An axis-aligned box in D dimensions: the points p with min[a] <= p[a] <= max[a] on every axis a.
///
/// Boxes are closed: two boxes that only touch overlap. half_open() and the option `touching` change that. A
/// degenerate box (min = max) is a valid point.
/// Coordinates are in the caller's unit, float or double. Infinite coordinates are allowed and have their
/// usual meaning.
///
/// Coordinates, denormals included, are compared by value. The calling thread's rounding mode, flushing of
/// denormals (FTZ, DAZ) and traps have no effect: the library computes in the default floating-point
/// environment. It restores the caller's environment before it returns, throws, or calls a sink, a visitor, a
/// predicate or an executor. Inline functions in these headers, such as overlap(), use the caller's
/// environment.
template <int D, typename Real = float>
struct Box {
  Point<D, Real> min;
  Point<D, Real> max;

  /// The box around `centre` that extends by `half_extents` to both sides along each axis, or by the same
  /// `half_extent` along every axis. Bounds are rounded to Real.
  [[nodiscard]] static constexpr Box around(const Point<D, Real>& centre,
                                            const Point<D, Real>& half_extents) noexcept {
    Box box{};
    for (std::size_t axis = 0; axis < centre.size(); ++axis) {
      box.min[axis] = centre[axis] - half_extents[axis];
      box.max[axis] = centre[axis] + half_extents[axis];
    }
    return box;
  }
  [[nodiscard]] static constexpr Box around(const Point<D, Real>& centre, Real half_extent) noexcept {
    Point<D, Real> half_extents{};
    half_extents.fill(half_extent);
    return around(centre, half_extents);
  }

  friend constexpr bool operator==(const Box&, const Box&) = default;
};

using Box2 = Box<2>;
using Box3 = Box<3>;
using DoubleBox2 = Box<2, double>;
using DoubleBox3 = Box<3, double>;

/// The absent box: min = +inf and max = -inf on every axis. It overlaps nothing, not even an infinite box. In
/// an array, it takes the place of a box that was removed.
template <int D, typename Real = float>
[[nodiscard]] constexpr Box<D, Real> absent_box() noexcept {
  Box<D, Real> box{};
  box.min.fill(std::numeric_limits<Real>::infinity());
  box.max.fill(-std::numeric_limits<Real>::infinity());
  return box;
}

/// Whether `box` is exactly the absent box.
template <int D, typename Real>
[[nodiscard]] constexpr bool is_absent(const Box<D, Real>& box) noexcept {
  return box == absent_box<D, Real>();
}

/// Whether `box` has min <= max on every axis; false for the absent box and for a box with a NaN.
template <int D, typename Real>
[[nodiscard]] constexpr bool is_present(const Box<D, Real>& box) noexcept {
  bool present = true;
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) present &= box.min[axis] <= box.max[axis];
  return present;
}

/// Whether two present boxes share a point. The result has no meaning for an absent box: check is_absent().
template <int D, typename Real>
[[nodiscard]] constexpr bool overlap(const Box<D, Real>& a, const Box<D, Real>& b) noexcept {
  bool touching = true;
  for (std::size_t axis = 0; axis < a.min.size(); ++axis) {
    touching &= a.min[axis] <= b.max[axis];
    touching &= b.min[axis] <= a.max[axis];
  }
  return touching;
}

/// Whether the box contains the point, bounds included. An absent box contains none.
template <int D, typename Real>
[[nodiscard]] constexpr bool contains(const Box<D, Real>& box,
                                      const std::type_identity_t<Point<D, Real>>& point) noexcept {
  bool inside = true;
  for (std::size_t axis = 0; axis < box.min.size(); ++axis)
    inside &= box.min[axis] <= point[axis] && point[axis] <= box.max[axis];
  return inside;
}

/// Whether every point of `inner` is in `outer`. An absent `inner` has no points, so the result is true.
template <int D, typename Real, std::same_as<Box<D, Real>> Inner>
[[nodiscard]] constexpr bool contains(const Box<D, Real>& outer, const Inner& inner) noexcept {
  bool inside = true;
  for (std::size_t axis = 0; axis < outer.min.size(); ++axis)
    inside &= outer.min[axis] <= inner.min[axis] && inner.max[axis] <= outer.max[axis];
  return inside;
}

/// The smallest box that contains both boxes, without rounding. An absent box adds nothing.
template <int D, typename Real>
[[nodiscard]] constexpr Box<D, Real> merged(const Box<D, Real>& a, const Box<D, Real>& b) noexcept {
  Box<D, Real> box = a;
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) {
    if (b.min[axis] < box.min[axis]) box.min[axis] = b.min[axis];
    if (b.max[axis] > box.max[axis]) box.max[axis] = b.max[axis];
  }
  return box;
}

/// The box with each side moved outwards by `margin`, which must be finite. A negative margin moves them
/// inwards; min may then exceed max. Bounds are rounded to Real. Infinite bounds and absent boxes do not
/// change.
template <int D, typename Real>
[[nodiscard]] constexpr Box<D, Real> enlarged(Box<D, Real> box, std::type_identity_t<Real> margin) noexcept {
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) {
    box.min[axis] -= margin;
    box.max[axis] += margin;
  }
  return box;
}

namespace detail {
/// The greatest number below a finite one.
template <typename Real>
[[nodiscard]] constexpr Real next_below(Real number) noexcept {
  using Bits = std::conditional_t<sizeof(Real) == 4, std::uint32_t, std::uint64_t>;
  constexpr Bits sign = Bits{1} << (8 * sizeof(Real) - 1);
  const Bits bits = __builtin_bit_cast(Bits, number);
  const bool is_negative = (bits & sign) != 0;  // by its bits: a processor may compare denormals as zeros
  if ((bits & ~sign) == 0) return -std::numeric_limits<Real>::denorm_min();
  return __builtin_bit_cast(Real, is_negative ? bits + 1 : bits - 1);
}
}  // namespace detail

/// The closed box that has the same numbers in it as the half-open box min[a] <= p[a] < max[a]: each max
/// above its min becomes the next lower number. So boxes that only touch do not overlap, and a point on the
/// border of two tiles belongs to the one that begins there. On an axis with min = max, the box keeps its one
/// coordinate. Infinite bounds, NaNs and absent boxes do not change.
template <int D, typename Real>
[[nodiscard]] constexpr Box<D, Real> half_open(Box<D, Real> box) noexcept {
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) {
    if (box.min[axis] < box.max[axis] && box.max[axis] < std::numeric_limits<Real>::infinity())
      box.max[axis] = detail::next_below(box.max[axis]);
  }
  return box;
}

/// The box moved by `offset`, which must be finite. Bounds are rounded to Real. Infinite bounds and absent
/// boxes do not change.
template <int D, typename Real>
[[nodiscard]] constexpr Box<D, Real> translated(Box<D, Real> box,
                                                const std::type_identity_t<Point<D, Real>>& offset) noexcept {
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) {
    box.min[axis] += offset[axis];
    box.max[axis] += offset[axis];
  }
  return box;
}

/// The centre of a present box: min / 2 + max / 2 along each axis, rounded to Real. NaN on an axis where the
/// bounds are -inf and +inf.
template <int D, typename Real>
[[nodiscard]] constexpr Point<D, Real> centre(const Box<D, Real>& box) noexcept {
  Point<D, Real> point{};
  for (std::size_t axis = 0; axis < point.size(); ++axis) point[axis] = box.min[axis] / 2 + box.max[axis] / 2;
  return point;
}

/// The lengths of a present box's sides, rounded to Real.
template <int D, typename Real>
[[nodiscard]] constexpr Point<D, Real> extent(const Box<D, Real>& box) noexcept {
  Point<D, Real> lengths{};
  for (std::size_t axis = 0; axis < lengths.size(); ++axis) lengths[axis] = box.max[axis] - box.min[axis];
  return lengths;
}

}  // namespace broadside

// Axis-aligned boxes, and what "overlap" and "absent" mean for every algorithm.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstring>
#include <limits>
#include <ranges>
#include <type_traits>

#include "broadside/version.hpp"

namespace broadside {

/// A place, a direction or a size in D dimensions.
template <int D, typename Real = float>
using Point = std::array<Real, static_cast<std::size_t>(D)>;

namespace detail {
template <int D, typename Real>
inline constexpr bool is_supported = (D == 2 || D == 3) &&
                                     (std::is_same_v<Real, float> || std::is_same_v<Real, double>);

/// Each class that works on boxes instantiates this, so that the compiler reports an unsupported box type in
/// one sentence.
template <int D, typename Real>
struct SupportedBox {
  static_assert(is_supported<D, Real>, "Broadside works on boxes in 2 or 3 dimensions, of float or double");
  static constexpr bool value = true;
};
}  // namespace detail

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
  Point<D, Real> min;
  Point<D, Real> max;

  /// The box around `centre` that extends by `half_extents` in both directions of each axis, or by the same
  /// `half_extent` on every axis. Bounds are rounded to Real.
  static constexpr Box around(const Point<D, Real>& centre, const Point<D, Real>& half_extents) noexcept {
    Box box{};
    for (std::size_t axis = 0; axis < centre.size(); ++axis) {
      box.min[axis] = centre[axis] - half_extents[axis];
      box.max[axis] = centre[axis] + half_extents[axis];
    }
    return box;
  }
  static constexpr Box around(const Point<D, Real>& centre, Real half_extent) noexcept {
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
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) present &= box.min[axis] <= box.max[axis];
  return present;
}

/// Whether two present boxes share a point. For an absent box the answer means nothing: ask is_absent first.
template <int D, typename Real>
constexpr bool overlap(const Box<D, Real>& a, const Box<D, Real>& b) noexcept {
  bool touching = true;
  for (std::size_t axis = 0; axis < a.min.size(); ++axis) {
    touching &= a.min[axis] <= b.max[axis];
    touching &= b.min[axis] <= a.max[axis];
  }
  return touching;
}

/// Whether the box contains the point, bounds included. An absent box contains none.
template <int D, typename Real>
constexpr bool contains(const Box<D, Real>& box, const std::type_identity_t<Point<D, Real>>& point) noexcept {
  bool inside = true;
  for (std::size_t axis = 0; axis < box.min.size(); ++axis)
    inside &= box.min[axis] <= point[axis] && point[axis] <= box.max[axis];
  return inside;
}

/// Whether every point of `inner` is in `outer`. An absent `inner` has no points, so the result is true.
template <int D, typename Real, std::same_as<Box<D, Real>> Inner>
constexpr bool contains(const Box<D, Real>& outer, const Inner& inner) noexcept {
  bool inside = true;
  for (std::size_t axis = 0; axis < outer.min.size(); ++axis)
    inside &= outer.min[axis] <= inner.min[axis] && inner.max[axis] <= outer.max[axis];
  return inside;
}

/// The smallest box that contains both; exact. An absent box adds nothing.
template <int D, typename Real>
constexpr Box<D, Real> merged(const Box<D, Real>& a, const Box<D, Real>& b) noexcept {
  Box<D, Real> box = a;
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) {
    if (b.min[axis] < box.min[axis]) box.min[axis] = b.min[axis];
    if (b.max[axis] > box.max[axis]) box.max[axis] = b.max[axis];
  }
  return box;
}

/// The box with each side moved outwards by `margin`, which must be finite. A negative margin moves the sides
/// inwards, and min may then exceed max. Bounds are rounded to Real; infinite bounds and absent boxes do not
/// change.
template <int D, typename Real>
constexpr Box<D, Real> enlarged(Box<D, Real> box, std::type_identity_t<Real> margin) noexcept {
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) {
    box.min[axis] -= margin;
    box.max[axis] += margin;
  }
  return box;
}

/// The box moved by `offset`, which must be finite. Bounds are rounded to Real; infinite bounds and absent
/// boxes do not change.
template <int D, typename Real>
constexpr Box<D, Real> translated(Box<D, Real> box,
                                  const std::type_identity_t<Point<D, Real>>& offset) noexcept {
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) {
    box.min[axis] += offset[axis];
    box.max[axis] += offset[axis];
  }
  return box;
}

/// The centre of a present box: half of each bound, and their sum, rounded to Real. NaN on an axis where both
/// bounds are infinite with opposite signs.
template <int D, typename Real>
constexpr Point<D, Real> centre(const Box<D, Real>& box) noexcept {
  Point<D, Real> point{};
  for (std::size_t axis = 0; axis < point.size(); ++axis) point[axis] = box.min[axis] / 2 + box.max[axis] / 2;
  return point;
}

/// The lengths of a present box's sides, rounded to Real.
template <int D, typename Real>
constexpr Point<D, Real> extent(const Box<D, Real>& box) noexcept {
  Point<D, Real> lengths{};
  for (std::size_t axis = 0; axis < lengths.size(); ++axis) lengths[axis] = box.max[axis] - box.min[axis];
  return lengths;
}

/// Boxes where they are: in an array of boxes, or in structs of the caller's own, one every `stride` bytes.
/// Nothing is copied; the memory must outlive the view.
template <int D, typename Real = float>
class BoxView {
 public:
  BoxView() = default;

  /// The boxes of a std::vector, std::array, std::span ...
  template <std::ranges::contiguous_range Boxes>
  requires std::ranges::sized_range<Boxes> &&
      std::is_same_v<std::remove_cv_t<std::ranges::range_value_t<Boxes>>, Box<D, Real>>
  constexpr BoxView(const Boxes& boxes) : boxes_(std::ranges::data(boxes)), size_(std::ranges::size(boxes)) {}

  /// `count` boxes of which the first begins at `first`, each `stride` bytes behind the one before. A box is
  /// its D minima and then its D maxima, as in Box, aligned or not.
  BoxView(const void* first, std::size_t count, std::size_t stride)
      : first_(static_cast<const std::byte*>(first)), stride_(stride), size_(count) {}

  constexpr std::size_t size() const noexcept { return size_; }
  constexpr bool empty() const noexcept { return size_ == 0; }

  constexpr Box<D, Real> operator[](std::size_t place) const noexcept {
    if (first_ == nullptr) return boxes_[place];
    Box<D, Real> box;
    std::memcpy(&box, first_ + place * stride_, sizeof(box));
    return box;
  }

  /// The boxes as an array, if that is what they were given as; else null.
  constexpr const Box<D, Real>* array() const noexcept { return first_ == nullptr ? boxes_ : nullptr; }
  constexpr bool is_array() const noexcept { return first_ == nullptr; }

  /// Where the first box begins.
  const std::byte* first_byte() const noexcept {
    return first_ != nullptr ? first_ : reinterpret_cast<const std::byte*>(boxes_);
  }

 private:
  const Box<D, Real>* boxes_ = nullptr;
  const std::byte* first_ = nullptr;
  std::size_t stride_ = 0;
  std::size_t size_ = 0;
};

}  // namespace broadside

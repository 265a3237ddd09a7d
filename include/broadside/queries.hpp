// Queries: what a BoxIndex or a World can be asked, its answers, and the functions that define these.
#pragma once

#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <type_traits>

#include "broadside/box.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

namespace broadside {

/// The points origin + t * direction with 0 <= t <= t_max. The direction may have any length, which is the
/// unit of t. A ray with a direction of zeros is a point.
template <int D, typename Real = float>
struct Ray {
  Point<D, Real> origin;     ///< finite
  Point<D, Real> direction;  ///< finite
  Real t_max = std::numeric_limits<Real>::infinity();
  bool entering = false;  ///< whether the ray hits only boxes that it enters: see enters()
};

/// A box that moves along a direction: at t it is `box` + t * direction, with 0 <= t <= t_max.
template <int D, typename Real = float>
struct BoxCast {
  Box<D, Real> box;          ///< finite, min <= max
  Point<D, Real> direction;  ///< finite
  Real t_max = std::numeric_limits<Real>::infinity();
  bool entering = false;  ///< as in Ray
};

/// Whether a cast that touches the box at some t >= 0 enters it. It does if it starts outside the box, or
/// touches the box at the start and moves into it. It does not if it starts inside the box, moves along a
/// face that it touches, or leaves the box. A cast that enters would touch the box from some t >= 0 to some
/// t > 0 if nothing stopped it.
///
/// The result is exact, since only coordinates are compared. The cast enters if on some axis its leading side
/// has not passed the near side of the box, and on no axis its trailing side has reached the far side.
template <int D, typename Real>
[[nodiscard]] constexpr bool enters(const BoxCast<D, Real>& cast, const Box<D, Real>& box) noexcept {
  bool is_outside = false;
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) {
    const Real direction = cast.direction[axis];
    const bool is_before = cast.box.max[axis] <= box.min[axis];
    const bool is_behind = cast.box.min[axis] >= box.max[axis];
    if (direction == 0) continue;
    if (direction > 0 ? is_behind : is_before) return false;
    is_outside |= direction > 0 ? is_before : is_behind;
  }
  return is_outside;
}

/// The least t at which the cast box touches a present box: 0 if they touch at the start, nothing if they do
/// not touch up to `t_max`. With `cast.entering`, also nothing if the cast does not enter the box.
///
/// Boxes are closed. The t of each bound is (bound - position) / direction, rounded twice. If the differences
/// of coordinates are exact, as with whole numbers, a cast that grazes a face, an edge or a corner hits it. A
/// box at infinity is hit at infinity.
template <int D, typename Real>
[[nodiscard]] constexpr std::optional<Real> t_enter(const BoxCast<D, Real>& cast,
                                                    const Box<D, Real>& box) noexcept {
  if (cast.entering && !enters(cast, box)) return std::nullopt;
  Real enter = 0;
  Real leave = cast.t_max;
  for (std::size_t axis = 0; axis < box.min.size(); ++axis) {
    const Real direction = cast.direction[axis];
    const Real before = box.min[axis] - cast.box.max[axis];
    const Real behind = box.max[axis] - cast.box.min[axis];
    if (direction == 0) {
      if (!(before <= 0) || !(behind >= 0)) return std::nullopt;
      continue;
    }
    const Real near = (direction > 0 ? before : behind) / direction;
    const Real far = (direction > 0 ? behind : before) / direction;
    if (near > enter) enter = near;
    if (far < leave) leave = far;
  }
  if (!(enter <= leave)) return std::nullopt;
  return enter;
}

/// The ray as a cast of a point.
template <int D, typename Real>
[[nodiscard]] constexpr BoxCast<D, Real> as_cast(const Ray<D, Real>& ray) noexcept {
  return {{ray.origin, ray.origin}, ray.direction, ray.t_max, ray.entering};
}

/// The least t at which the ray touches a present box, as above.
template <int D, typename Real>
[[nodiscard]] constexpr std::optional<Real> t_enter(const Ray<D, Real>& ray,
                                                    const Box<D, Real>& box) noexcept {
  return t_enter(as_cast(ray), box);
}

/// The squared Euclidean distance of two present boxes: 0 if they overlap, otherwise the sum of the squares
/// of the gaps along each axis, in order of the axes. A gap is the lower bound of one box less the upper
/// bound of the other. Each gap, square and sum is rounded to double, also for boxes of floats. So among
/// boxes of floats only the sum of squares is rounded, unless their coordinates differ in size by a factor of
/// 2^29. Infinity if it overflows, which floats do not. Without meaning unless both are present.
///
/// It is compiled into the library, so that every program rounds it in the same way.
template <int D, typename Real>
[[nodiscard]] BROADSIDE_PUBLIC double distance_squared(const Box<D, Real>& a,
                                                       const std::type_identity_t<Box<D, Real>>& b) noexcept;

/// The squared distance from a point, which is a box with min = max.
template <int D, typename Real>
[[nodiscard]] double distance_squared(const std::type_identity_t<Point<D, Real>>& point,
                                      const Box<D, Real>& box) noexcept {
  return distance_squared<D, Real>(Box<D, Real>{point, point}, box);
}

/// A box that a ray or a cast box hits, and the t of the first contact.
template <typename Real>
struct Hit {
  BoxId box;
  Real t_enter;

  friend constexpr bool operator==(const Hit&, const Hit&) = default;
};

/// A box and its squared distance from a query's box or point.
struct Neighbour {
  BoxId box;
  double distance_squared;

  friend constexpr bool operator==(const Neighbour&, const Neighbour&) = default;
};

/// The boxes that a query may find; all by default. `Id` identifies a box: a BoxId or a Handle.
template <typename Id>
struct QueryOptions {
  const Filter* filter = nullptr;  ///< only boxes whose filters accept this one
  std::optional<Id> except{};      ///< a box that is not found, such as the one that a ray starts from
};

/// The boxes that nearest() may find; all by default.
template <typename Id>
struct NearestOptions {
  const Filter* filter = nullptr;  ///< as in QueryOptions
  std::optional<Id> except{};

  /// Boxes that are farther away are not found. At least 0, and may be infinite. A box is near enough if
  /// distance_squared() <= max_distance * max_distance, with the product rounded to double. So a box at
  /// exactly max_distance along one axis is found. With 0, only boxes that overlap the query's are found.
  double max_distance = std::numeric_limits<double>::infinity();
};

/// Receives the results of a query in chunks. `Found` is BoxId, Hit or Neighbour.
template <typename Found>
class Visitor {
 public:
  virtual ~Visitor() = default;

  /// Returns whether the search continues. Chunks are small at first and grow to some hundred results.
  virtual bool visit(std::span<const Found> found) = 0;
};

/// A function of one result. It returns whether the search continues, or nothing, which continues it.
template <typename Function, typename Found>
concept VisitFunction = std::invocable<Function&, Found> &&
    (std::convertible_to<std::invoke_result_t<Function&, Found>, bool> ||
     std::is_void_v<std::invoke_result_t<Function&, Found>>);

namespace detail {
/// The Visitor that calls a function for each result.
template <typename Found, VisitFunction<Found> Function>
class FunctionVisitor final : public Visitor<Found> {
 public:
  explicit FunctionVisitor(Function& function) : function_(function) {}

  bool visit(std::span<const Found> found) override {
    for (const Found& one : found) {
      if constexpr (std::is_void_v<std::invoke_result_t<Function&, Found>>)
        function_(one);
      else if (!function_(one))
        return false;
    }
    return true;
  }

 private:
  Function& function_;
};
}  // namespace detail

}  // namespace broadside

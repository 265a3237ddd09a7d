// Rays, moving boxes and distances, and what it means that they meet a box: the definitions that every query
// to an index equals.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <type_traits>

#include "broadside/box.hpp"

namespace broadside {

/// The points origin + t * direction with 0 <= t <= t_max, the parameters t being in units of the
/// direction's length, which may be any. A direction of zeros is a point.
template <int D, typename Real = float>
struct Ray {
  Point<D, Real> origin;     ///< finite
  Point<D, Real> direction;  ///< finite
  Real t_max = std::numeric_limits<Real>::infinity();
};

/// A box moved along a direction: it stands at `box` + t * direction, 0 <= t <= t_max.
template <int D, typename Real = float>
struct BoxCast {
  Box<D, Real> box;          ///< finite, min <= max
  Point<D, Real> direction;  ///< finite
  Real t_max = std::numeric_limits<Real>::infinity();
};

/// The parameter at which a moved box first touches a present box, 0 if it begins there; none if it does not
/// touch it up to `t_max`.
///
/// Boxes are closed. Each bound's parameter is (bound - place) / direction, rounded twice; so where the
/// coordinates' differences are exact, as those of whole numbers are, a cast that grazes a face, an edge or a
/// corner meets it. A box at infinity is met at infinity.
template <int D, typename Real>
constexpr std::optional<Real> t_enter(const BoxCast<D, Real>& cast, const Box<D, Real>& box) noexcept {
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

/// The ray as a point that is moved.
template <int D, typename Real>
constexpr BoxCast<D, Real> as_cast(const Ray<D, Real>& ray) noexcept {
  return {{ray.origin, ray.origin}, ray.direction, ray.t_max};
}

/// The parameter at which a ray enters a present box, likewise.
template <int D, typename Real>
constexpr std::optional<Real> t_enter(const Ray<D, Real>& ray, const Box<D, Real>& box) noexcept {
  return t_enter(as_cast(ray), box);
}

/// The square of the distance from a point to a present box: the sum over the axes, in their order, of the
/// squares of what the point lies outside; 0 inside, infinite where it is greater than any number.
///
/// Compiled in the library, so that no program's compiler rounds it in another way.
template <int D, typename Real>
Real distance_squared(const std::type_identity_t<Point<D, Real>>& point, const Box<D, Real>& box) noexcept;

}  // namespace broadside

// Squared distances of given pairs of boxes or points.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/bit_cast.hpp"

namespace broadside::kernels {

/// The gap of two boxes on an axis: 0 if they share a coordinate, as infinities of the same sign are.
template <int D, typename Real>
inline double gap(const Box<D, Real>& a, const Box<D, Real>& b, std::size_t axis) {
  const double above = static_cast<double>(a.min[axis]) - static_cast<double>(b.max[axis]);
  const double below = static_cast<double>(b.min[axis]) - static_cast<double>(a.max[axis]);
  const double greater = above > below ? above : below;
  // 0 for NaN. g++ 12 makes an unpredictable branch of the conditional operator.
  return core::bit_cast<double>(core::bit_cast<std::uint64_t>(greater) &
                                (std::uint64_t{0} - static_cast<std::uint64_t>(greater > 0)));
}

/// The sum of the squared gaps in order of the axes. Squares may overflow or vanish.
template <int D, typename Real>
inline double squared_distance(const Box<D, Real>& a, const Box<D, Real>& b) {
  return [&]<std::size_t... Axes>(std::index_sequence<Axes...>) {
    double sum = 0;
    ((sum += gap(a, b, Axes) * gap(a, b, Axes)), ...);
    return sum;
  }
  (std::make_index_sequence<D>());
}

/// The same for boxes that are finite points, to the last bit.
template <std::size_t D, typename Real>
inline double squared_distance(const std::array<Real, D>& a, const std::array<Real, D>& b) {
  double sum = 0;
  for (std::size_t axis = 0; axis < D; ++axis) {
    const double gap = static_cast<double>(a[axis]) - static_cast<double>(b[axis]);
    sum += gap * gap;
  }
  return sum;
}

/// Sets squares[i] to the squared_distance() of two shapes, which are boxes or points: those of pairs[i], one
/// in `left` and one in `right`.
template <typename Shape>
void set_squared_distances(const Shape* left, const Shape* right, std::span<const Pair> pairs,
                           double* squares);

}  // namespace broadside::kernels

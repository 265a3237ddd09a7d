// Squared distances of given pairs of boxes.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::kernels {

/// The gap of two boxes on an axis: 0 if they share a coordinate, as infinities of the same sign are.
template <int D, typename Real>
inline double gap(const Box<D, Real>& a, const Box<D, Real>& b, std::size_t axis) {
  const double above = static_cast<double>(a.min[axis]) - static_cast<double>(b.max[axis]);
  const double below = static_cast<double>(b.min[axis]) - static_cast<double>(a.max[axis]);
  const double greater = above > below ? above : below;
  return greater > 0 ? greater : 0;  // 0 for NaN
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

/// Sets squares[i] to the squared_distance() of the boxes of pairs[i], the first of which is in `left` and
/// the second in `right`.
template <int D, typename Real>
void set_squared_distances(const Box<D, Real>* left, const Box<D, Real>* right, std::span<const Pair> pairs,
                           double* squares);

}  // namespace broadside::kernels

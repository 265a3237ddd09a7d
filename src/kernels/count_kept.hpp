// Tests whether boxes stay within enlarged ones.
#pragma once

#include <cstddef>
#include <span>

#include "broadside/box.hpp"

namespace broadside::kernels {

/// How much longer than a box its enlarged one may be, on an axis: the product of the box's side there and
/// `per_side`, but at least `min` and at most `max`, times `factor`.
template <typename Real>
struct SideSlack {
  Real factor;
  Real per_side;
  Real min;
  Real max;
};

/// Looks for the first box that is not present, is not within the box of the same place in `kept`, or is much
/// shorter than that on an axis. Looks at the first `count` boxes; the spans may be longer. Returns how many
/// boxes come before that one, rounded down: the boxes from there on are yet to be tested one by one.
template <int D, typename Real>
std::size_t count_kept(std::span<const Box<D, Real>> kept, std::span<const Box<D, Real>> boxes,
                       std::size_t count, const SideSlack<Real>& slack);

}  // namespace broadside::kernels

// SpatialOrder: an order of boxes in which neighbours in space mostly follow one another.
#pragma once

#include <span>

#include "broadside/box.hpp"

#include "core/parallel.hpp"
#include "core/radix_sort.hpp"

namespace broadside::find {

/// Sorts boxes along a Z-order curve (Morton 1966) through cells: 2^11 on each axis in 2D, 2^7 in 3D, so that
/// two passes of a radix sort put them in order. Boxes of one cell keep their order.
template <int D, typename Real>
class SpatialOrder {
 public:
  /// The places of the boxes, in order. None of these may be absent. Valid until the next call.
  std::span<const core::KeyedPlace> sort(std::span<const Box<D, Real>> boxes, core::Parallel& parallel);

 private:
  core::RadixSort radix_;
};

}  // namespace broadside::find

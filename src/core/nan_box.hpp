// nan_box(): the sentinel for "no box here".
#pragma once

#include <limits>

#include "broadside/box.hpp"

namespace broadside::core {

/// A box of NaNs: overlaps nothing, not even an infinite box, without asking whether it is present. So it
/// pads unused SIMD lanes. The absent box would not do: it overlaps an infinite one.
template <int D>
constexpr Box<D> nan_box() noexcept {
  Box<D> box{};
  box.min.fill(std::numeric_limits<float>::quiet_NaN());
  box.max.fill(std::numeric_limits<float>::quiet_NaN());
  return box;
}

}  // namespace broadside::core

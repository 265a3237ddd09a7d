// The box that is nowhere.
#pragma once

#include <limits>

#include "broadside/box.hpp"

namespace broadside::kernels {

/// The box that overlaps nothing, not even an infinite one, in a comparison that does not ask who is present:
/// it stands where there is none.
template <int D>
constexpr Box<D> nowhere() noexcept {
  Box<D> box{};
  box.min.fill(std::numeric_limits<float>::quiet_NaN());
  box.max.fill(std::numeric_limits<float>::quiet_NaN());
  return box;
}

}  // namespace broadside::kernels

// Conservative rounding: boxes of floats that contain boxes of doubles, relative to an origin.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>

#include "broadside/box.hpp"

#include "core/bit_cast.hpp"
#include "core/rounding.hpp"

namespace broadside::algorithm {

/// A float below `value` by at least half a unit in the last place, or -inf. At most 2^100, so that
/// computations with it do not overflow.
inline float rounded_down(double value) noexcept {
  constexpr double max_value = 0x1p100;
  const auto nearest = static_cast<float>(std::clamp(value, -max_value, max_value));
  // As integers, positive floats sort as they do and negative ones the other way round.
  const auto bits = core::bit_cast<std::int32_t>(nearest);
  const auto below = core::bit_cast<float>(bits - (bits >> 31 | 1));
  if (nearest == 0) return -std::numeric_limits<float>::min();
  return value < -max_value ? -std::numeric_limits<float>::infinity() : below;
}

/// The same for a float above `value`.
inline float rounded_up(double value) noexcept { return -rounded_down(-value); }

/// Origin and power-of-two scale are chosen for each axis.
template <int D>
class ConservativeRounding {
 public:
  /// Chooses origin and scale by a sample of the boxes.
  void fit(std::span<const Box<D, double>> boxes) { fit_ = core::fit_linear<D>(boxes); }

  Box<D> box(const Box<D, double>& box) const noexcept {
    // A difference that overflows is clamped, so that scaling it does not exceed the true value.
    constexpr double max_value = std::numeric_limits<double>::max();
    Box<D> rounded;
    for (int axis = 0; axis < D; ++axis) {
      const core::LinearRounding& rounding = fit_[axis];
      rounded.min[axis] =
          rounded_down(std::min(box.min[axis] - rounding.origin(), max_value) * rounding.scale());
      rounded.max[axis] =
          rounded_up(std::max(box.max[axis] - rounding.origin(), -max_value) * rounding.scale());
    }
    return rounded;
  }

  /// A length on the axis is multiplied by 2 to this power.
  int exponent(int axis) const noexcept { return std::ilogb(fit_[axis].scale()); }

 private:
  std::array<core::LinearRounding, D> fit_{};
};

}  // namespace broadside::algorithm

// Doubles as floats that lie further outward, about an origin.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "broadside/box.hpp"

namespace broadside::own {

/// A float less than `value` by at least half of its last place, or -inf; at most 2^100, so that what is
/// computed with it does not overflow.
inline float rounded_down(double value) noexcept {
  constexpr double most = 0x1p100;
  if (value >= most) return static_cast<float>(most);
  if (value < -most) return -std::numeric_limits<float>::infinity();
  const auto nearest = static_cast<float>(value);
  if (nearest == 0) return -std::numeric_limits<float>::min();
  const auto bits = std::bit_cast<std::uint32_t>(nearest);
  return std::bit_cast<float>(nearest > 0 ? bits - 1 : bits + 1);
}

/// The same to the other side.
inline float rounded_up(double value) noexcept { return -rounded_down(-value); }

/// Boxes of doubles as boxes of floats that hold them.
template <int D>
class Outward {
 public:
  /// Takes the middle of the boxes' finite coordinates for the origin.
  void choose_origin(std::span<const Box<D, double>> boxes) noexcept {
    for (int axis = 0; axis < D; ++axis) {
      double low = std::numeric_limits<double>::infinity();
      double high = -low;
      for (const Box<D, double>& box : boxes) {
        for (const double at : {box.min[axis], box.max[axis]}) {
          if (!std::isfinite(at)) continue;
          low = std::min(low, at);
          high = std::max(high, at);
        }
      }
      origin_[axis] = low <= high ? low / 2 + high / 2 : 0;
    }
  }

  Box<D> box(const Box<D, double>& box) const noexcept {
    Box<D> rounded;
    for (int axis = 0; axis < D; ++axis) {
      rounded.min[axis] = rounded_down(box.min[axis] - origin_[axis]);
      rounded.max[axis] = rounded_up(box.max[axis] - origin_[axis]);
    }
    return rounded;
  }

 private:
  std::array<double, D> origin_{};
};

}  // namespace broadside::own

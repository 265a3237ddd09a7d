// How boxes are spread over buckets on their way into a tree.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace broadside::algorithm {

inline constexpr std::size_t max_bvh_buckets = 2048;

/// The root of `value` >= 0 of that degree, 1 to 3, in operations that are rounded alike everywhere: which
/// leaf a box is in must not depend on the machine.
inline double root(double value, int degree) {
  if (degree == 1 || !(value > 0)) return value;
  if (degree == 2) return std::sqrt(value);
  double guess = std::sqrt(std::sqrt(value));
  for (int step = 0; step < 64; ++step) guess -= (guess - value / guess / guess) / 3;
  return guess;
}

/// Buckets of equal width for the coordinates on one axis.
struct Buckets {
  Buckets(float least, float greatest, std::size_t max_count) : low(least) {
    const float width = greatest - least;
    if (!(width > 0) || max_count < 2) return;
    scale = static_cast<float>(max_count) / width;
    count = static_cast<std::uint32_t>(max_count);
    if (!std::isfinite(scale)) scale = std::numeric_limits<float>::max();
  }

  std::uint32_t operator()(float value) const {
    const float at = (value - low) * scale;
    // A NaN goes into the first one, too.
    return at > 0 ? static_cast<std::uint32_t>(std::min(at, static_cast<float>(count - 1))) : 0;
  }

  float low;
  float scale = 0;
  std::uint32_t count = 1;
};

}  // namespace broadside::algorithm

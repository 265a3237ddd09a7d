// Order-preserving rounding of doubles to floats.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "broadside/box.hpp"

namespace broadside::core {

/// Rounds one axis about an origin, scaled by a power of two. Each step is monotonic: at worst it makes two
/// values equal. Floats have seven digits of the distance to the origin, over 38 orders of magnitude to
/// either side of a typical distance.
class LinearRounding {
 public:
  LinearRounding() = default;

  /// Maps values about `distance` from the origin to floats about as far from 0, or about 1 from 0 if
  /// `distance` is beyond 2^30 or below 2^-30.
  LinearRounding(double origin, double distance);

  /// Finite even for an infinite value.
  float operator()(double value) const {
    constexpr double largest_float = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp((value - origin_) * scale_, -largest_float, largest_float));
  }

  /// Approximately the value that a float stands for. Equal floats give equal values.
  double back(float rounded) const { return origin_ + rounded * inverse_scale_; }

  double origin() const { return origin_; }
  double scale() const { return scale_; }
  double inverse_scale() const { return inverse_scale_; }

 private:
  double origin_ = 0;
  double scale_ = 1;
  double inverse_scale_ = 1;
};

/// Rounds one axis by its quantiles, for coordinates whose distances differ too much for one scale, such as
/// clusters within clusters. The i-th knot, in ascending order, becomes i less the middle index. Values
/// between two knots are interpolated. Monotonic, like LinearRounding.
class QuantileRounding {
 public:
  QuantileRounding() = default;

  /// The knots are finite, in any order.
  explicit QuantileRounding(std::vector<double> knots);

  float operator()(double value) const;

  std::size_t bytes() const noexcept { return knots_.capacity() * sizeof(double); }

 private:
  std::vector<double> knots_;  // ascending, no two equal
  double middle_ = 0;          // the middle index of the knots, which becomes 0
  double slope_ = 0;           // beyond the first and the last knot
};

/// A rounding for each axis that suits most of the present boxes, judged by a sample.
template <int D>
std::array<LinearRounding, D> fit_linear(std::span<const Box<D, double>> boxes);

/// Whether back() restores every coordinate from `floats`, which are `boxes` rounded by `fit`. Distinct
/// coordinates then stay distinct.
template <int D>
bool is_lossless(const std::array<LinearRounding, D>& fit, std::span<const Box<D, double>> boxes,
                 std::span<const Box<D>> floats) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      if (fit[axis].back(floats[i].min[axis]) != boxes[i].min[axis] ||
          fit[axis].back(floats[i].max[axis]) != boxes[i].max[axis])
        return false;
    }
  }
  return true;
}

/// The key of coordinate `place` of an array in a hash of its boxes.
constexpr std::uint64_t hash_key(std::size_t place) { return place * std::uint64_t{0x9e3779b97f4a7c15U}; }

/// A hash of all boxes and their order. The hash of an array is the sum of the hashes of its parts, each with
/// the place of its first box.
template <int D>
std::uint64_t hash_of(std::span<const Box<D, double>> boxes, std::size_t first_place = 0);

/// A rounding for each axis, with knots from one in sixteen of the boxes. Their hash selects the sample, so
/// no pattern of the array can evade it. O(n log n).
template <int D>
std::array<QuantileRounding, D> fit_quantiles(std::span<const Box<D, double>> boxes, std::uint64_t hash);

/// Whether this rounding makes enough false pairs (they overlap as floats but not as doubles) for another one
/// to pay. If `left_count` is not 0, only pairs between the first `left_count` boxes and the others count.
/// Compares about sqrt(n) boxes, sampled by their hash, with each other: O(n).
template <int D>
bool makes_false_pairs(const std::array<LinearRounding, D>& fit, std::span<const Box<D, double>> boxes,
                       std::size_t left_count, std::uint64_t hash);

/// The box, rounded on each axis; the absent box stays absent.
template <int D, typename Roundings>
Box<D> rounded(const Box<D, double>& box, const Roundings& roundings) {
  Box<D> floats;
  for (int axis = 0; axis < D; ++axis) {
    floats.min[axis] = roundings[axis](box.min[axis]);
    floats.max[axis] = roundings[axis](box.max[axis]);
  }
  return floats;
}

}  // namespace broadside::core

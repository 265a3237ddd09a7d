// Doubles as floats in the same order.
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

/// One axis about an origin, scaled by a power of two: each step keeps the order of values, at worst it makes
/// two equal. Floats have seven digits of the distance to the origin, over 38 orders of magnitude to either
/// side of a typical distance.
class LinearRounding {
 public:
  LinearRounding() = default;

  /// Takes values about `distance` away from the origin to floats about as far away from 0, or where that is
  /// more than 2^30 or less than 2^-30, to floats about 1 away.
  LinearRounding(double origin, double distance);

  /// Finite, for an infinite value as well.
  float operator()(double value) const {
    constexpr double largest_float = std::numeric_limits<float>::max();
    return static_cast<float>(std::clamp((value - origin_) * scale_, -largest_float, largest_float));
  }

  /// About the value that a float stands for, and the same for the same float.
  double back(float rounded) const { return origin_ + rounded * inverse_scale_; }

  double origin() const { return origin_; }
  double scale() const { return scale_; }

 private:
  double origin_ = 0;
  double scale_ = 1;
  double inverse_scale_ = 1;
};

/// One axis by its quantiles, for coordinates whose distances differ too much for one scale, such as clusters
/// within clusters: the i-th knot, in ascending order, becomes about i, and values between two knots are
/// interpolated. Keeps order as LinearRounding does.
class QuantileRounding {
 public:
  QuantileRounding() = default;

  /// The knots are finite, in any order.
  explicit QuantileRounding(std::vector<double> knots);

  float operator()(double value) const;

  std::size_t bytes() const noexcept { return knots_.capacity() * sizeof(double); }

 private:
  std::vector<double> knots_;  // ascending, no two equal
  double middle_ = 0;          // the knots' mean number, which becomes 0
  double slope_ = 0;           // beyond the first and the last knot
};

/// A rounding for each axis that suits most of the present boxes, by a sample.
template <int D>
std::array<LinearRounding, D> fit_linear(std::span<const Box<D, double>> boxes);

/// Whether `floats`, which are `boxes` rounded by `fit`, keep every coordinate that differs from another
/// apart from it, as far as `back` can tell.
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

/// A number that depends on all boxes and their order: the sum of what parts give, each with the place of its
/// first box.
template <int D>
std::uint64_t hash_of(std::span<const Box<D, double>> boxes, std::size_t first_place = 0);

/// A rounding for each axis whose knots are from one in sixteen of the boxes, a sample by their hash: no
/// pattern of the array can evade it. O(n log n).
template <int D>
std::array<QuantileRounding, D> fit_quantiles(std::span<const Box<D, double>> boxes, std::uint64_t hash);

/// Whether this rounding makes enough false pairs (they overlap in float, not in double) that another pays.
/// Where `left_count` is not 0, only pairs between the boxes before that place and the others matter.
/// Compares a sample of about sqrt(n) boxes, by their hash, with each other: O(n).
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

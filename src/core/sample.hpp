// A sample of the boxes, axis by axis: the signals from which algorithms choose their tunables.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/bit_cast.hpp"

namespace broadside::core {

/// What a sample tells about one axis.
struct AxisSample {
  /// The chance that two boxes overlap in their projections on this axis. A sweep along the axis compares
  /// about n / 2 times this many pairs per box.
  double overlap = 1;

  float low = 0;           ///< a finite lower bound of the sampled boxes, except far outliers
  float high = 0;          ///< a finite upper bound of the sampled boxes, except far outliers
  float extent = 0;        ///< the median of the boxes' extents, at most FLT_MAX
  double mean_extent = 0;  ///< the mean of the boxes' extents, each limited to high - low

  std::vector<float> minima;  ///< of the sampled boxes, ascending
};

/// `value`, or -infinity for a NaN, which cannot be sorted. Boxes had no NaN when they were checked, but
/// another thread may have written to the caller's array since.
inline float without_nan(float value) noexcept {
  return std::max(-std::numeric_limits<float>::infinity(), value);
}

/// The median of `values`, which must not have a NaN; 0 if there are none. Reorders `values`.
template <typename Real>
Real median(std::vector<Real>& values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// The place of the i-th box of a sample from an array of `boxes` boxes. The places are spread over the
/// array, without a period that a regular scene could share.
inline std::size_t sampled_place(std::size_t i, std::size_t boxes) {
  // Multiples of the golden ratio, modulo 1, are spread evenly and never in step with a pattern in the array.
  const auto fraction = static_cast<std::uint32_t>(i * 0x9e3779b9U);
  return static_cast<std::size_t>(fraction * std::uint64_t{boxes} >> 32);
}

/// The same for a sample of `count` boxes: all boxes in order if there are no more.
inline std::size_t sampled_place(std::size_t i, std::size_t count, std::size_t boxes,
                                 std::uint32_t shift = 0) {
  return count == boxes ? i : sampled_place(i + shift, boxes);
}

/// A number to add to each `i` of sampled_place(), by a hash of up to `max_hashed` boxes: so the same boxes
/// are always sampled at the same places, but no order of an array is misleading at the places of every
/// sample.
template <int D, typename Real>
std::uint32_t sample_shift(std::span<const Box<D, Real>> boxes, std::size_t max_hashed) {
  const std::size_t count = std::min(boxes.size(), max_hashed);
  using Bits = std::conditional_t<std::is_same_v<Real, float>, std::uint32_t, std::uint64_t>;
  std::uint64_t hash = boxes.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Box<D, Real>& box = boxes[sampled_place(i, count, boxes.size())];
    for (const Real coordinate : box.min) hash = detail::mixed(hash + bit_cast<Bits>(coordinate));
  }
  return static_cast<std::uint32_t>(hash);
}

/// Calls `take(box)` for up to `max_count` present boxes, sampled from the whole array.
template <int D, typename Real, typename Take>
void for_present_sample(std::span<const Box<D, Real>> boxes, std::size_t max_count, Take take) {
  const std::size_t tries = std::min(boxes.size(), 4 * max_count);
  std::size_t taken = 0;
  for (std::size_t i = 0; i < tries && taken < max_count; ++i) {
    // A copy, since another thread may change the caller's array.
    const Box<D, Real> box = boxes[sampled_place(i, tries, boxes.size())];
    if (!is_present(box)) continue;
    take(box);
    ++taken;
  }
}

/// A sample of at most a few hundred boxes: the same for the same boxes, at places given by sampled_place().
/// O(1) for large arrays.
template <int D>
class Sample {
 public:
  /// Samples at most `max_count` of the boxes, or fewer if the array is small. `shift`: by sample_shift().
  void take(std::span<const Box<D>> boxes, std::size_t max_count = 256, std::uint32_t shift = 0);

  const AxisSample& operator[](int axis) const noexcept { return axes_[axis]; }

  /// The axes, the one with the least overlap first: the best to sweep along.
  std::array<int, D> axes_by_overlap() const;

  /// The same with the axis `first` before the others, unless it is -1.
  std::array<int, D> axes_from(int first) const;

 private:
  std::array<AxisSample, D> axes_;
  std::vector<float> maxima_;
  std::vector<float> extents_;
};

}  // namespace broadside::core

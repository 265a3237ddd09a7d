// OverlapEstimate: estimates density and clustering by testing a small sample all against all. It says less
// than a sorted sample (core::Sample), but is faster.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "broadside/box.hpp"

#include "core/sample.hpp"

namespace broadside::algorithm {

/// The same boxes always give the same sample. Cost: O(max_count^2), without branches: about a microsecond
/// for 64 boxes. Results are shares of the pairs in the sample. An absent box overlaps at most infinite ones.
template <int D>
class OverlapEstimate {
 public:
  static constexpr std::size_t max_boxes = 96;

  /// Samples `max_count` of the boxes, but at most max_boxes.
  void take(std::span<const Box<D>> boxes, std::size_t max_count) {
    count_ = std::min({boxes.size(), max_count, max_boxes});
    for (std::size_t i = 0; i < count_; ++i) {
      const Box<D>& box = boxes[core::sampled_place(i, boxes.size())];
      for (int axis = 0; axis < D; ++axis) {
        min_[axis][i] = box.min[axis];
        max_[axis][i] = box.max[axis];
      }
    }
  }

  /// Compares the sample all against all. Sets the shares of its pairs that overlap on each axis and on all
  /// axes.
  void compare() {
    std::array<std::uint32_t, D> on_axis{};
    std::uint32_t on_all = 0;
    for (std::size_t i = 1; i < count_; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        std::uint32_t all = 1;
        for (int axis = 0; axis < D; ++axis) {
          const std::uint32_t overlaps = static_cast<std::uint32_t>(min_[axis][i] <= max_[axis][j]) &
                                         static_cast<std::uint32_t>(min_[axis][j] <= max_[axis][i]);
          on_axis[axis] += overlaps;
          all &= overlaps;
        }
        on_all += all;
      }
    }
    const double pairs = static_cast<double>(count_ * (count_ - 1)) / 2;
    for (int axis = 0; axis < D; ++axis) overlap_[axis] = pairs > 0 ? on_axis[axis] / pairs : 1;
    overlap_on_all_ = pairs > 0 ? on_all / pairs : 1;
  }

  const std::array<double, D>& overlap() const noexcept { return overlap_; }
  double overlap_on_all() const noexcept { return overlap_on_all_; }

  /// The number of pairs that are near on all axes, over the number that independent axes would give: 1 if
  /// boxes are spread evenly. Two boxes are near if their minima differ by at most `reach`.
  double clustering(const std::array<float, D>& reach) const {
    std::array<std::uint32_t, D> on_axis{};
    std::uint32_t on_all = 0;
    for (std::size_t i = 1; i < count_; ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        std::uint32_t all = 1;
        for (int axis = 0; axis < D; ++axis) {
          const float difference = min_[axis][i] - min_[axis][j];
          const std::uint32_t is_near = static_cast<std::uint32_t>(difference <= reach[axis]) &
                                        static_cast<std::uint32_t>(-difference <= reach[axis]);
          on_axis[axis] += is_near;
          all &= is_near;
        }
        on_all += all;
      }
    }
    const double pairs = static_cast<double>(count_ * (count_ - 1)) / 2;
    double expected = pairs;
    for (int axis = 0; axis < D; ++axis) expected *= on_axis[axis] / pairs;
    // Up to four pairs may be near by chance.
    return on_all / std::max(expected, 4.0);
  }

  /// The distance between the least and the greatest finite minimum on each axis.
  std::array<float, D> range() const {
    std::array<float, D> range;
    for (int axis = 0; axis < D; ++axis) {
      float lowest = std::numeric_limits<float>::max();
      float highest = std::numeric_limits<float>::lowest();
      for (std::size_t i = 0; i < count_; ++i) {
        if (!std::isfinite(min_[axis][i])) continue;
        lowest = std::min(lowest, min_[axis][i]);
        highest = std::max(highest, min_[axis][i]);
      }
      range[axis] = std::max(highest - lowest, 0.0F);
    }
    return range;
  }

 private:
  std::size_t count_ = 0;
  std::array<std::array<float, max_boxes>, D> min_;
  std::array<std::array<float, max_boxes>, D> max_;
  std::array<double, D> overlap_{};
  double overlap_on_all_ = 0;
};

/// Statistics of the sides of some boxes. An axis with a zero or infinite mean does not count in
/// `unevenness`; `longest_over_shortest` may be infinite or NaN.
struct ExtentStats {
  double unevenness;  ///< mean of the squared sides over the squared mean, on the axis where that is greatest
  double longest_over_shortest;  ///< the mean of the boxes' longest sides over that of their shortest
};

/// Samples up to 256 boxes: a smaller sample might miss the few large ones.
template <int D>
ExtentStats extent_stats(std::span<const Box<D>> boxes) {
  const std::size_t count = std::min<std::size_t>(boxes.size(), 256);
  std::array<double, D> sum{};
  std::array<double, D> squares{};
  double longest = 0;
  double shortest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Box<D>& box = boxes[core::sampled_place(i, count, boxes.size())];
    if (!is_present(box)) continue;
    std::array<double, D> sides;
    for (int axis = 0; axis < D; ++axis) {
      sides[axis] = static_cast<double>(box.max[axis]) - box.min[axis];
      sum[axis] += sides[axis];
      squares[axis] += sides[axis] * sides[axis];
    }
    longest += *std::max_element(sides.begin(), sides.end());
    shortest += *std::min_element(sides.begin(), sides.end());
  }
  double unevenness = 0;
  for (int axis = 0; axis < D; ++axis)
    unevenness = std::max(unevenness, squares[axis] * static_cast<double>(count) / (sum[axis] * sum[axis]));
  return {unevenness, longest / shortest};
}

}  // namespace broadside::algorithm

// OverlapEstimate: density and clustering, by testing a small sample all against all. It says less than a
// sorted sample (core::Sample), and is faster.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"

namespace broadside::algorithm {

/// The same boxes always give the same sample. Cost O(most^2), without branches: about a microsecond for 64
/// boxes. Parts are of the pairs in the sample; absent boxes overlap none.
template <int D>
class OverlapEstimate {
 public:
  static constexpr std::size_t max_boxes = 96;

  /// Samples `max_count` of the boxes, or fewer if there are fewer or `max_count` is above max_boxes.
  void take(std::span<const Box<D>> boxes, std::size_t max_count);

  /// Compares the sample all against all. Then the part of the pairs that overlaps on each axis, and on all
  /// axes.
  void compare();
  const std::array<double, D>& overlap() const noexcept { return overlap_; }
  double overlap_on_all() const noexcept { return overlap_on_all_; }

  /// The pairs near each other on all axes, over the number that independent axes would give: 1 where boxes
  /// are spread evenly. Two boxes are near if their minima differ by at most `reach`.
  double clustering(const std::array<float, D>& reach) const;

  /// The distance between the least and the greatest minimum on each axis, of those that are finite.
  std::array<float, D> range() const;

 private:
  std::size_t count_ = 0;
  std::array<std::array<float, max_boxes>, D> min_;
  std::array<std::array<float, max_boxes>, D> max_;
  std::array<double, D> overlap_{};
  double overlap_on_all_ = 0;
};

/// Statistics of the sides of some boxes. NaN where a mean is zero or infinite.
struct ExtentStats {
  double unevenness;  ///< mean of the squared sides over the squared mean, on the axis where that is greatest
  double longest_over_shortest;  ///< the mean of the boxes' longest sides over that of their shortest
};

/// Samples up to 256 boxes: a smaller sample might miss the few large ones.
template <int D>
ExtentStats extent_stats(std::span<const Box<D>> boxes);

}  // namespace broadside::algorithm

// What a few boxes, each held against each other, say of all: less than a sorted sample, and sooner.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"

namespace broadside::core {

/// A look at a few boxes, the same for the same boxes, sampled as a Sample's. Cost O(most^2), without
/// branches: about a microsecond for 64 boxes. Parts are of the pairs among the boxes that were looked at;
/// boxes that are absent overlap none.
template <int D>
class OverlapEstimate {
 public:
  static constexpr std::size_t most_boxes = 96;

  /// Looks at `most` of the boxes, or fewer where there are fewer, or more than most_boxes are asked for.
  void take(std::span<const Box<D>> boxes, std::size_t most);

  /// The part of the pairs that overlaps on each axis, and on all. Pairs are compared when this is called.
  void compare();
  const std::array<double, D>& overlap() const noexcept { return overlap_; }
  double overlap_on_all() const noexcept { return overlap_on_all_; }

  /// How many times as many pairs are near each other on all axes as the single axes would let expect: 1
  /// where boxes are spread evenly. Boxes are near whose minima differ by no more than `reach`.
  double clustering(const std::array<float, D>& reach) const;

  /// The distance between the least and the greatest minimum on each axis, of those that are finite.
  std::array<float, D> range() const;

 private:
  std::size_t count_ = 0;
  std::array<std::array<float, most_boxes>, D> min_;
  std::array<std::array<float, most_boxes>, D> max_;
  std::array<double, D> overlap_{};
  double overlap_on_all_ = 0;
};

/// What the sides of some boxes are like. Not a number where a mean is zero or infinite.
struct ExtentStats {
  double unevenness;  ///< of the axes' means of the squares over the squares of the means, the greatest
  double longest_over_shortest;  ///< the mean of the boxes' longest sides over that of their shortest
};

/// Looks at up to 256 of the boxes: of few that are large, a smaller sample may have none.
template <int D>
ExtentStats extent_stats(std::span<const Box<D>> boxes);

}  // namespace broadside::core

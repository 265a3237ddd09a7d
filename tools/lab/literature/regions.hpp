// A grid of regions over the world: a box is in every region that it touches.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "broadside/box.hpp"

namespace broadside::lab::literature {

/// The regions that a box touches: from `first` to `last` on each axis, inclusive.
template <int D>
struct RegionRange {
  std::array<std::uint32_t, D> first;
  std::array<std::uint32_t, D> last;

  bool has(const std::array<std::uint32_t, D>& region) const noexcept {
    bool has = true;
    for (int axis = 0; axis < D; ++axis) has &= first[axis] <= region[axis] && region[axis] <= last[axis];
    return has;
  }

  std::size_t count() const noexcept {
    std::size_t count = 1;
    for (int axis = 0; axis < D; ++axis) count *= last[axis] - first[axis] + std::size_t{1};
    return count;
  }

  friend bool operator==(const RegionRange&, const RegionRange&) = default;
};

/// Equal regions over the finite coordinates of some boxes; the outer ones extend to infinity.
template <int D>
class Regions {
 public:
  using Place = std::array<std::uint32_t, D>;

  /// About `wanted` regions, but so few that a sample's boxes are in at most four regions each on average.
  Regions(std::span<const Box<D>> boxes, double wanted) {
    measure(boxes);
    constexpr std::size_t sample_size = 1000;
    const std::size_t step = std::max<std::size_t>(boxes.size() / sample_size, 1);
    std::vector<Box<D>> sample;
    for (std::size_t i = 0; i < boxes.size(); i += step) {
      if (is_present(boxes[i])) sample.push_back(boxes[i]);
    }
    std::array<bool, D> is_done{};
    while (static_cast<double>(count()) < wanted) {
      // Halves the axis whose regions are widest, unless too many boxes would be in both halves.
      int widest = -1;
      for (int axis = 0; axis < D; ++axis) {
        if (!is_done[axis] && (widest < 0 || width(axis) > width(widest))) widest = axis;
      }
      if (widest < 0) break;
      cut(widest, counts_[widest] * 2);
      std::size_t references = 0;
      for (const Box<D>& box : sample) references += range_of(box).count();
      constexpr std::size_t max_references = 4;
      if (width(widest) > 0 && references <= max_references * sample.size()) continue;
      cut(widest, counts_[widest] / 2);
      is_done[widest] = true;
    }
  }

  std::size_t count() const noexcept {
    std::size_t count = 1;
    for (const std::uint32_t on_axis : counts_) count *= on_axis;
    return count;
  }

  RegionRange<D> range_of(const Box<D>& box) const noexcept {
    RegionRange<D> range;
    for (int axis = 0; axis < D; ++axis) {
      range.first[axis] = place(box.min[axis], axis);
      range.last[axis] = place(box.max[axis], axis);
    }
    return range;
  }

  std::size_t index_of(const Place& region) const noexcept {
    std::size_t index = 0;
    for (int axis = D; axis-- > 0;) index = index * counts_[axis] + region[axis];
    return index;
  }

  /// Calls visit(region) with the index of each region in the range.
  template <typename Visit>
  void for_each(const RegionRange<D>& range, Visit visit) const {
    Place region = range.first;
    for (;;) {
      visit(region);
      int axis = 0;
      while (axis < D && region[axis] == range.last[axis]) {
        region[axis] = range.first[axis];
        ++axis;
      }
      if (axis == D) return;
      ++region[axis];
    }
  }

 private:
  void measure(std::span<const Box<D>> boxes) {
    high_.fill(-std::numeric_limits<double>::infinity());
    low_.fill(std::numeric_limits<double>::infinity());
    for (const Box<D>& box : boxes) {
      if (!is_present(box)) continue;
      for (int axis = 0; axis < D; ++axis) {
        if (std::isfinite(box.min[axis])) low_[axis] = std::min(low_[axis], double{box.min[axis]});
        if (std::isfinite(box.max[axis])) high_[axis] = std::max(high_[axis], double{box.max[axis]});
      }
    }
    for (int axis = 0; axis < D; ++axis) {
      if (!(low_[axis] < high_[axis])) low_[axis] = high_[axis] = 0;  // empty range
      cut(axis, 1);
    }
  }

  void cut(int axis, std::uint32_t count) {
    counts_[axis] = count;
    scale_[axis] = high_[axis] > low_[axis] ? count / (high_[axis] - low_[axis]) : 0;
  }

  double width(int axis) const noexcept { return (high_[axis] - low_[axis]) / counts_[axis]; }

  std::uint32_t place(float coordinate, int axis) const noexcept {
    if (counts_[axis] == 1) return 0;
    const double place = (double{coordinate} - low_[axis]) * scale_[axis];
    return place > 0 ? static_cast<std::uint32_t>(std::min(place, counts_[axis] - 1.0)) : 0;
  }

  std::array<double, D> low_;
  std::array<double, D> high_;
  std::array<double, D> scale_;
  std::array<std::uint32_t, D> counts_;
};

}  // namespace broadside::lab::literature

// OverlapEstimate: density and clustering, by testing a small sample all against all.
#include "algorithms/auto/overlap_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/sample.hpp"

namespace broadside::algorithm {
namespace {

std::size_t place(std::size_t i, std::size_t count, std::size_t boxes) {
  return count == boxes ? i : core::sampled_place(i, boxes);
}

}  // namespace

template <int D>
void OverlapEstimate<D>::take(std::span<const Box<D>> boxes, std::size_t max_count) {
  count_ = std::min({boxes.size(), max_count, max_boxes});
  for (std::size_t i = 0; i < count_; ++i) {
    const Box<D>& box = boxes[core::sampled_place(i, boxes.size())];
    for (int axis = 0; axis < D; ++axis) {
      min_[axis][i] = box.min[axis];
      max_[axis][i] = box.max[axis];
    }
  }
}

template <int D>
void OverlapEstimate<D>::compare() {
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

template <int D>
double OverlapEstimate<D>::clustering(const std::array<float, D>& reach) const {
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
  // Up to four may be near each other by chance.
  return on_all / std::max(expected, 4.0);
}

template <int D>
std::array<float, D> OverlapEstimate<D>::range() const {
  std::array<float, D> range;
  for (int axis = 0; axis < D; ++axis) {
    float least = std::numeric_limits<float>::max();
    float greatest = std::numeric_limits<float>::lowest();
    for (std::size_t i = 0; i < count_; ++i) {
      if (!std::isfinite(min_[axis][i])) continue;
      least = std::min(least, min_[axis][i]);
      greatest = std::max(greatest, min_[axis][i]);
    }
    range[axis] = std::max(greatest - least, 0.0F);
  }
  return range;
}

template <int D>
ExtentStats extent_stats(std::span<const Box<D>> boxes) {
  const std::size_t count = std::min<std::size_t>(boxes.size(), 256);
  std::array<double, D> sum{};
  std::array<double, D> squares{};
  double longest = 0;
  double shortest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Box<D>& box = boxes[place(i, count, boxes.size())];
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

template class OverlapEstimate<2>;
template class OverlapEstimate<3>;
template ExtentStats extent_stats(std::span<const Box2>);
template ExtentStats extent_stats(std::span<const Box3>);

}  // namespace broadside::algorithm

// A sample of the boxes, axis by axis: the signals from which algorithms choose their tunables.
#include "core/sample.hpp"

#include <numeric>
#include <optional>
#include <utility>

namespace broadside::core {
namespace {

constexpr float largest = std::numeric_limits<float>::max();

/// Few boxes are sampled densely, many so sparsely that sampling is a small part of the work.
std::size_t sample_count(std::size_t boxes, std::size_t max_count) {
  return std::min({boxes, 64 + boxes / 16, max_count});
}

/// The fraction of all pairs of intervals that overlap. The minima and the maxima are each sorted.
double overlapping_part(std::span<const float> minima, std::span<const float> maxima) {
  // Two intervals are disjoint if one ends before the other begins.
  std::uint64_t disjoint = 0;
  std::size_t ended = 0;
  for (const float min : minima) {
    while (ended < maxima.size() && maxima[ended] < min) ++ended;
    disjoint += ended;
  }
  const auto count = static_cast<double>(minima.size());
  const double pairs = count * (count - 1) / 2;
  return pairs > 0 ? 1 - static_cast<double>(disjoint) / pairs : 1;
}

/// With fewer overlaps among the sampled boxes, their number is due to chance. A lattice in order has none: a
/// sample spread over the array is then spread over each axis as well, and no two of its boxes are near.
constexpr double telling_overlaps = 8;

/// The chance that two boxes overlap on an axis, estimated from the local density of the sampled boxes, which
/// accounts for clusters. Empty if five neighbouring minima coincide.
std::optional<double> overlap_by_density(std::span<const float> minima, double mean_extent) {
  constexpr std::size_t steps = 4;
  const auto size = static_cast<double>(minima.size());
  double density = 0;  // the fraction of all boxes that begin in a unit of length
  for (std::size_t i = 0; i + steps < minima.size(); ++i) {
    const double distance = static_cast<double>(minima[i + steps]) - minima[i];
    if (!(distance > 0)) return std::nullopt;
    density += (steps - 1) / (distance * size * (size - steps));
  }
  return std::min(1.0, 2 * density * mean_extent);
}

/// Sets the bounds of a sample from its sorted minima and maxima: those of the middle three quarters, and as
/// much again on either side if the sample reaches that far.
void set_bounds(AxisSample& sample, std::span<const float> maxima) {
  if (maxima.empty()) return;
  const std::size_t eighth = maxima.size() / 8;
  const auto finite = [](float value) { return static_cast<double>(std::clamp(value, -largest, largest)); };
  const double low = finite(sample.minima[eighth]);
  const double high = finite(maxima[maxima.size() - 1 - eighth]);
  sample.low = static_cast<float>(std::max(finite(sample.minima.front()), low - (high - low)));
  sample.high = static_cast<float>(std::min(finite(maxima.back()), high + (high - low)));
}

}  // namespace

template <int D>
void Sample<D>::take(std::span<const Box<D>> boxes, std::size_t max_count, std::uint32_t shift) {
  const std::size_t count = sample_count(boxes.size(), max_count);
  for (int axis = 0; axis < D; ++axis) {
    AxisSample& sample = axes_[axis];
    sample.minima.clear();
    maxima_.clear();
    extents_.clear();
    for (std::size_t i = 0; i < count; ++i) {
      const Box<D>& box = boxes[sampled_place(i, count, boxes.size(), shift)];
      const float min = without_nan(box.min[axis]);
      const float max = without_nan(box.max[axis]);
      sample.minima.push_back(min);
      maxima_.push_back(max);
      extents_.push_back(max > min ? std::min(max - min, largest) : 0);  // inf - inf is not a number
    }
    std::sort(sample.minima.begin(), sample.minima.end());
    std::sort(maxima_.begin(), maxima_.end());
    sample.overlap = overlapping_part(sample.minima, maxima_);
    set_bounds(sample, maxima_);
    const double range = static_cast<double>(sample.high) - sample.low;
    sample.mean_extent = 0;
    for (const float extent : extents_)
      sample.mean_extent += std::min<double>(extent, range) / static_cast<double>(count);
    sample.extent = median(extents_);
    const auto size = static_cast<double>(count);
    if (sample.overlap * size * (size - 1) / 2 >= telling_overlaps || count == boxes.size()) continue;
    sample.overlap = overlap_by_density(sample.minima, sample.mean_extent).value_or(sample.overlap);
  }
}

template <int D>
std::array<int, D> Sample<D>::axes_by_overlap() const {
  std::array<int, D> axes;
  std::iota(axes.begin(), axes.end(), 0);
  // Not a stable sort, which takes memory.
  const auto key = [this](int axis) { return std::pair(axes_[axis].overlap, axis); };
  std::sort(axes.begin(), axes.end(), [&](int a, int b) { return key(a) < key(b); });
  return axes;
}

template <int D>
std::array<int, D> Sample<D>::axes_from(int first) const {
  std::array<int, D> axes = axes_by_overlap();
  for (int i = D - 1; i > 0; --i) {
    if (axes[i] == first) std::swap(axes[i], axes[i - 1]);
  }
  return axes;
}

template class Sample<2>;
template class Sample<3>;

}  // namespace broadside::core

// Pairs of boxes of doubles, by a finder of floats and a last test in double.
#include "core/double_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/exact_sink.hpp"

namespace broadside::core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Half of a float's last place, relative to the number.
constexpr double rounding = 0x1p-24;

/// The coarsest rounding that is let be, in median extents: a few per cent more candidates than pairs.
constexpr double tolerated_coarseness = 1.0 / 16;

/// A region of so few boxes is not split: all its pairs together are few.
constexpr std::size_t few_boxes = 256;

constexpr std::size_t most_samples = 256;

/// Neighbours are brought together in memory by squares, in 3D cubes, of so many boxes: some cache lines of
/// floats.
constexpr double boxes_per_bucket = 64;

/// Limits the buckets to as many as a bucket_of_ can tell apart.
template <int D>
constexpr double most_buckets_per_side = D == 2 ? 181 : 31;

}  // namespace

template <int D>
DoubleFinder<D>::DoubleFinder(std::unique_ptr<PairFinder<D>> finder) : finder_(std::move(finder)) {
  this->set_workers(finder_->workers());
}

template <int D>
void DoubleFinder<D>::find_valid(std::span<const Box<D, double>> boxes, PairSink& pairs) {
  boxes_ = boxes;
  statistics_ = {};
  counted_ = true;
  stack_.clear();
  Region everywhere;
  everywhere.begin.fill(-infinity);
  everywhere.end.fill(infinity);
  search(0, boxes.size(), everywhere, pairs);
  if (counted_) this->count(statistics_);
}

template <int D>
void DoubleFinder<D>::search(std::size_t begin, std::size_t end, const Region& region, PairSink& pairs) {
  const std::size_t count = end - begin;
  std::array<Axis, D> axes;
  for (int axis = 0; axis < D; ++axis) axes[axis] = sample(places(begin, end), region, axis);
  measure(places(begin, end), region, axes);
  const auto coarsest =
      static_cast<int>(std::ranges::max_element(axes, {}, &Axis::coarseness) - axes.begin());
  const double at = axes[coarsest].origin;

  const bool coarse = !exact_ && count > few_boxes && axes[coarsest].coarseness > tolerated_coarseness;
  if (coarse && stack_.empty()) {
    stack_.resize(count);
    std::iota(stack_.begin(), stack_.end(), 0U);
  }
  const std::size_t top = stack_.size();
  std::size_t upper = top;
  if (coarse) {
    for (std::size_t i = begin; i < end; ++i) {
      if (boxes_[stack_[i]].min[coarsest] < at) stack_.push_back(stack_[i]);
    }
    upper = stack_.size();
    for (std::size_t i = begin; i < end; ++i) {
      if (boxes_[stack_[i]].max[coarsest] >= at) stack_.push_back(stack_[i]);
    }
  }
  const std::size_t all = stack_.size();
  const std::size_t most = count / 8 * 7;
  if (all == top || upper - top > most || all - upper > most) {
    stack_.resize(top);
    search_floats(places(begin, end), region, axes, pairs);
    return;
  }
  Region half = region;
  half.end[coarsest] = at;
  search(top, upper, half, pairs);
  half = region;
  half.begin[coarsest] = at;
  search(upper, all, half, pairs);
  stack_.resize(top);
}

template <int D>
typename DoubleFinder<D>::Axis DoubleFinder<D>::sample(const Places& places, const Region& region, int axis) {
  minima_.clear();
  extents_.clear();
  const std::size_t samples = std::min(places.size, most_samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const Box<D, double>& box = boxes_[places[(2 * i + 1) * places.size / (2 * samples)]];
    const double min = std::clamp(box.min[axis], region.begin[axis], region.end[axis]);
    if (std::isfinite(min)) minima_.push_back(min);
    const double extent = box.max[axis] > box.min[axis] ? box.max[axis] - box.min[axis] : 0;
    extents_.push_back(std::min(extent, std::numeric_limits<double>::max()));
  }
  const auto median = [](std::vector<double>& values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  const double origin = median(minima_);
  Axis found{.origin = origin, .extent = median(extents_), .low = origin, .high = origin, .coarseness = 0};
  for (const double min : minima_) {
    found.low = std::min(found.low, min);
    found.high = std::max(found.high, min);
  }
  return found;
}

template <int D>
void DoubleFinder<D>::measure(const Places& places, const Region& region, std::array<Axis, D>& axes) {
  const double buckets = static_cast<double>(places.size) / boxes_per_bucket;
  const double per_side = std::floor(std::clamp(std::pow(buckets, 1.0 / D), 1.0, most_buckets_per_side<D>));
  const auto last = static_cast<double>(per_side - 1);
  std::array<double, D> per_unit;
  bucket_count_ = 1;
  for (int axis = 0; axis < D; ++axis) {
    per_unit[axis] = per_side / (axes[axis].high - axes[axis].low);
    bucket_count_ *= static_cast<std::size_t>(per_side);
  }
  parallel_.start(this->workers(), places.size);
  bucket_of_.resize(std::max(bucket_of_.size(), places.size));
  bucket_ends_.assign(parallel_.range_count() * 2 * bucket_count_, 0);
  bounds_.resize(parallel_.range_count());
  const auto is_exact = [&](double value, int axis) {
    return axes[axis].origin + rounded(value, axes[axis].origin) == value;
  };
  parallel_.for_numbered_ranges(places.size, [&](std::size_t number, Range range, std::size_t) {
    std::uint32_t* const counts = &bucket_ends_[number * 2 * bucket_count_];
    bool exact = true;
    std::array<double, D> low;
    std::array<double, D> high;
    low.fill(infinity);
    high.fill(-infinity);
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Box<D, double>& box = boxes_[places[i]];
      std::uint32_t bucket = places[i] < this->left_count() ? 0 : 1;
      for (int axis = 0; axis < D; ++axis) {
        low[axis] = std::min(low[axis], box.min[axis] > -infinity ? box.min[axis] : infinity);
        high[axis] = std::max(high[axis], box.max[axis] < infinity ? box.max[axis] : -infinity);
        exact = exact && is_exact(box.min[axis], axis) && is_exact(box.max[axis], axis);
        // Neither lets a NaN through, which infinite boxes and minima that are all equal make.
        const double at = std::min(last, std::max(0.0, (box.min[axis] - axes[axis].low) * per_unit[axis]));
        bucket = bucket * static_cast<std::uint32_t>(per_side) + static_cast<std::uint32_t>(at);
      }
      bucket_of_[i] = static_cast<std::uint16_t>(bucket);
      ++counts[bucket];
    }
    bounds_[number] = {low, high, exact};
  });
  exact_ = std::ranges::all_of(bounds_, &Bounds::exact);
  for (int axis = 0; axis < D; ++axis) {
    const double origin = axes[axis].origin;
    double low = infinity;
    double high = -infinity;
    for (const Bounds& bounds : bounds_) {
      low = std::min(low, bounds.low[axis]);
      high = std::max(high, bounds.high[axis]);
    }
    const double least = std::clamp(low, region.begin[axis], region.end[axis]);
    const double greatest = std::clamp(high, region.begin[axis], region.end[axis]);
    const double farthest = std::max(origin - least, greatest - origin);
    axes[axis].coarseness = farthest > 0 ? farthest * rounding / axes[axis].extent : 0;
  }
}

template <int D>
void DoubleFinder<D>::search_floats(const Places& places, const Region& region,
                                    const std::array<Axis, D>& axes, PairSink& pairs) {
  const std::size_t left = gather(places, axes);
  std::array<double, D> origin;
  for (int axis = 0; axis < D; ++axis) origin[axis] = axes[axis].origin;
  ExactSink<D> exact({boxes_, ids_, floats_, left, exact_}, region.begin, origin, pairs);
  const std::span<const Box<D>> floats = floats_;
  if (this->left_count() == 0)
    finder_->find(floats, exact);
  else
    finder_->find_between(floats, left, exact);
  if (const auto& found = finder_->statistics()) {
    statistics_.tests += found->tests;
    statistics_.references += found->references;
  } else {
    counted_ = false;
  }
}

template <int D>
std::size_t DoubleFinder<D>::gather(const Places& places, const std::array<Axis, D>& axes) {
  // Pairs are of boxes near each other, and each is looked up again: where the boxes are more than a cache
  // holds, that would be a miss for each pair if they lay as they came.
  const std::size_t buckets = 2 * bucket_count_;
  std::uint32_t total = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    for (std::size_t at = bucket; at < bucket_ends_.size(); at += buckets)
      total += std::exchange(bucket_ends_[at], total);
  }
  const std::size_t left = bucket_ends_[bucket_count_];
  ids_.resize(places.size);
  floats_.resize(places.size);
  parallel_.for_numbered_ranges(places.size, [&](std::size_t number, Range range, std::size_t) {
    std::uint32_t* const next = &bucket_ends_[number * buckets];
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const std::uint32_t to = next[bucket_of_[i]]++;
      ids_[to] = places[i];
      const Box<D, double>& box = boxes_[places[i]];
      for (int axis = 0; axis < D; ++axis) {
        floats_[to].min[axis] = rounded(box.min[axis], axes[axis].origin);
        floats_[to].max[axis] = rounded(box.max[axis], axes[axis].origin);
      }
    }
  });
  return left;
}

template <int D>
Outline<D, double> DoubleFinder<D>::lay_out(std::span<const Box<D, double>> boxes) {
  std::array<double, D> origin{};
  for (int axis = 0; axis < D; ++axis) {
    for (const Box<D, double>& box : boxes) {
      if (!std::isfinite(box.min[axis])) continue;
      origin[axis] = box.min[axis];
      break;
    }
  }
  std::vector<Box<D>> floats(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      floats[i].min[axis] = static_cast<float>(boxes[i].min[axis] - origin[axis]);
      floats[i].max[axis] = static_cast<float>(boxes[i].max[axis] - origin[axis]);
    }
  }
  const Outline<D> rounded = outline(*finder_, floats);
  Outline<D, double> outline{rounded.kind, rounded.caption, rounded.swept_axis, {}};
  for (const std::vector<Box<D>>& level : rounded.levels) {
    std::vector<Box<D, double>>& parts = outline.levels.emplace_back(level.size());
    for (std::size_t i = 0; i < level.size(); ++i) {
      for (int axis = 0; axis < D; ++axis) {
        parts[i].min[axis] = origin[axis] + level[i].min[axis];
        parts[i].max[axis] = origin[axis] + level[i].max[axis];
      }
    }
  }
  return outline;
}

template class DoubleFinder<2>;
template class DoubleFinder<3>;

}  // namespace broadside::core

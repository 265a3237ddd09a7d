// Pairs of boxes of doubles, by a finder of floats and a last test in double.
#include "doubles/double_finder.hpp"

#include <algorithm>
#include <atomic>
#include <utility>

#include "doubles/exact_sink.hpp"

namespace broadside::core {
namespace {

/// Up to this many boxes have few pairs, false ones included.
constexpr std::size_t few_boxes = 256;

/// Boxes are sorted in memory by squares, in 3D cubes, that hold this many of them on average: a few cache
/// lines of floats.
constexpr std::size_t boxes_per_bucket = 64;

/// Limits the buckets to as many as a bucket_of_ can number.
template <int D>
constexpr std::size_t most_buckets_per_side = D == 2 ? 181 : 31;

/// The buckets along each axis: the greatest number whose power is not above what the boxes fill. In
/// integers, since the order of the pairs depends on it.
template <int D>
std::size_t buckets_per_side(std::size_t boxes) {
  const auto fits = [boxes](std::size_t side) {
    std::size_t buckets = 1;
    for (int axis = 0; axis < D; ++axis) buckets *= side;
    return buckets * boxes_per_bucket <= boxes;
  };
  std::size_t side = 1;
  while (side < most_buckets_per_side<D> && fits(side + 1)) ++side;
  return side;
}

}  // namespace

template <int D>
DoubleFinder<D>::DoubleFinder(std::unique_ptr<PairFinder<D>> finder) : finder_(std::move(finder)) {
  this->set_workers(finder_->workers());
}

template <int D>
void DoubleFinder<D>::find_valid(std::span<const Box<D, double>> boxes, PairSink& pairs) {
  const Fit fit = fit_linear<D>(boxes);
  const bool exact = measure(boxes, fit);
  std::size_t left = 0;
  if (!exact && boxes.size() > few_boxes && makes_false_pairs<D>(fit, boxes, this->left_count())) {
    const std::array<QuantileRounding, D> quantiles = fit_quantiles<D>(boxes);
    left = gather(
        boxes, [&](int axis) -> const auto& { return quantiles[axis]; });
  } else {
    left = gather(
        boxes, [&](int axis) -> const auto& { return fit[axis].rounding; });
  }
  ExactSink<D> in_double({boxes, ids_, floats_, left, exact}, pairs);
  const std::span<const Box<D>> floats = floats_;
  if (this->left_count() == 0)
    finder_->find(floats, in_double);
  else
    finder_->find_between(floats, left, in_double);
  if (const auto& found = finder_->statistics()) this->count(*found);
}

template <int D>
bool DoubleFinder<D>::measure(std::span<const Box<D, double>> boxes, const Fit& fit) {
  const std::size_t per_side = buckets_per_side<D>(boxes.size());
  const auto last = static_cast<double>(per_side - 1);
  std::array<double, D> per_unit;
  bucket_count_ = 1;
  for (int axis = 0; axis < D; ++axis) {
    per_unit[axis] = static_cast<double>(per_side) / (fit[axis].high - fit[axis].low);
    bucket_count_ *= per_side;
  }
  parallel_.start(this->workers(), boxes.size());
  bucket_of_.resize(std::max(bucket_of_.size(), boxes.size()));
  bucket_ends_.assign(parallel_.range_count() * 2 * bucket_count_, 0);
  std::atomic<bool> all_exact = true;
  const auto is_exact = [&](double value, int axis) {
    const LinearRounding& rounding = fit[axis].rounding;
    return rounding.back(rounding(value)) == value;
  };
  parallel_.for_numbered_ranges(boxes.size(), [&](std::size_t number, Range range, std::size_t) {
    std::uint32_t* const counts = &bucket_ends_[number * 2 * bucket_count_];
    bool exact = true;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const Box<D, double>& box = boxes[i];
      std::uint32_t bucket = i < this->left_count() ? 0 : 1;
      for (int axis = 0; axis < D; ++axis) {
        exact = exact && is_exact(box.min[axis], axis) && is_exact(box.max[axis], axis);
        // Neither std::min nor std::max passes on a NaN, which infinite boxes or equal minima lead to.
        const double at = std::min(last, std::max(0.0, (box.min[axis] - fit[axis].low) * per_unit[axis]));
        bucket = bucket * static_cast<std::uint32_t>(per_side) + static_cast<std::uint32_t>(at);
      }
      bucket_of_[i] = static_cast<std::uint16_t>(bucket);
      ++counts[bucket];
    }
    if (!exact) all_exact.store(false, std::memory_order_relaxed);
  });
  return all_exact;
}

template <int D>
template <typename RoundingOf>
std::size_t DoubleFinder<D>::gather(std::span<const Box<D, double>> boxes, RoundingOf rounding_of) {
  // Pairs are of boxes near each other, and each is looked up again: where the boxes are more than a cache
  // holds, each pair would be a cache miss if they stayed in the caller's order.
  const std::size_t buckets = 2 * bucket_count_;
  std::uint32_t total = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    for (std::size_t at = bucket; at < bucket_ends_.size(); at += buckets)
      total += std::exchange(bucket_ends_[at], total);
  }
  const std::size_t left = bucket_ends_[bucket_count_];
  ids_.resize(boxes.size());
  floats_.resize(boxes.size());
  parallel_.for_numbered_ranges(boxes.size(), [&](std::size_t number, Range range, std::size_t) {
    std::uint32_t* const next = &bucket_ends_[number * buckets];
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const std::uint32_t to = next[bucket_of_[i]]++;
      ids_[to] = static_cast<std::uint32_t>(i);
      floats_[to] = rounded(boxes[i], rounding_of);
    }
  });
  return left;
}

template <int D>
Outline<D, double> DoubleFinder<D>::lay_out(std::span<const Box<D, double>> boxes) {
  const Fit fit = fit_linear<D>(boxes);
  std::vector<Box<D>> floats;
  floats.reserve(boxes.size());
  for (const Box<D, double>& box : boxes)
    floats.push_back(rounded(
        box, [&](int axis) -> const auto& { return fit[axis].rounding; }));
  const Outline<D> laid_out = outline(*finder_, floats);
  Outline<D, double> outline{laid_out.kind, laid_out.caption, laid_out.swept_axis, {}};
  for (const std::vector<Box<D>>& level : laid_out.levels) {
    std::vector<Box<D, double>>& parts = outline.levels.emplace_back(level.size());
    for (std::size_t i = 0; i < level.size(); ++i) {
      for (int axis = 0; axis < D; ++axis) {
        parts[i].min[axis] = fit[axis].rounding.back(level[i].min[axis]);
        parts[i].max[axis] = fit[axis].rounding.back(level[i].max[axis]);
      }
    }
  }
  return outline;
}

template class DoubleFinder<2>;
template class DoubleFinder<3>;

}  // namespace broadside::core

// Pairs of boxes of doubles, by a finder of floats and a last test in double.
#include "core/double_finder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace broadside::core {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<float>::max();

/// Half of a float's last place, relative to the number.
constexpr double rounding = 0x1p-24;

/// The coarsest rounding that is let be, in median extents: a few per cent more candidates than pairs.
constexpr double tolerated_coarseness = 1.0 / 16;

/// A region of so few boxes is not split: all its pairs together are few.
constexpr std::size_t few_boxes = 256;

constexpr std::size_t most_samples = 256;

/// Into how many squares, a side, the boxes are divided to bring neighbours together in memory.
constexpr double buckets_per_side = 64;
constexpr std::size_t bucket_count = 64 * 64;

/// `value` as a float about `origin`. Rises with the value, and is finite.
float rounded(double value, double origin) {
  return static_cast<float>(std::clamp(value - origin, -largest, largest));
}

}  // namespace

/// Keeps of the float finder's pairs those that overlap in double and belong to the region.
template <int D>
class DoubleFinder<D>::ExactSink final : public PairSink {
 public:
  /// `left_count` as in a PairFinder; pairs of the float finder are then places among left and among right
  /// boxes.
  ExactSink(const DoubleFinder& owner, std::size_t left_count, const Region& region, PairSink& target)
      : owner_(&owner), left_count_(left_count), region_(region), target_(&target) {}

 private:
  void consume(std::span<const Pair> pairs) override {
    while (!pairs.empty()) {
      const std::size_t count = std::min(pairs.size(), max_room);
      Pair* const out = target_->room(count);
      std::size_t written = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t a = index(pairs[i].first);
        const std::size_t b = left_count_ + index(pairs[i].second);
        out[written] = {std::min(owner_->ids_[a], owner_->ids_[b]),
                        std::max(owner_->ids_[a], owner_->ids_[b])};
        written += static_cast<std::size_t>(is_pair(owner_->exact_[a], owner_->exact_[b]));
      }
      target_->commit(written);
      pairs = pairs.subspan(count);
    }
  }

  bool is_pair(const Box<D, double>& a, const Box<D, double>& b) const {
    bool here = overlap(a, b);
    for (int axis = 0; axis < D; ++axis) {
      const double begin = std::max(a.min[axis], b.min[axis]);
      here &= begin >= region_.begin[axis];
      here &= begin < region_.end[axis] || region_.end[axis] == infinity;
    }
    return here;
  }

  const DoubleFinder* owner_;
  std::size_t left_count_;
  Region region_;
  PairSink* target_;
};

template <int D>
DoubleFinder<D>::DoubleFinder(std::unique_ptr<PairFinder<D>> finder) : finder_(std::move(finder)) {}

template <int D>
void DoubleFinder<D>::find_valid(std::span<const Box<D, double>> boxes, PairSink& pairs) {
  boxes_ = boxes;
  statistics_ = {};
  counted_ = true;
  stack_.resize(boxes.size());
  std::iota(stack_.begin(), stack_.end(), 0U);
  Region everywhere;
  everywhere.begin.fill(-infinity);
  everywhere.end.fill(infinity);
  search(0, boxes.size(), everywhere, pairs);
  if (counted_) this->count(statistics_);
}

template <int D>
void DoubleFinder<D>::search(std::size_t begin, std::size_t end, const Region& region, PairSink& pairs) {
  std::array<Axis, D> axes;
  for (int axis = 0; axis < D; ++axis) axes[axis] = survey(begin, end, region, axis);
  const auto coarsest =
      static_cast<int>(std::ranges::max_element(axes, {}, &Axis::coarseness) - axes.begin());
  const double at = axes[coarsest].middle;

  const std::size_t top = stack_.size();
  std::size_t upper = top;
  const std::size_t count = end - begin;
  if (count > few_boxes && axes[coarsest].coarseness > tolerated_coarseness) {
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
    search_floats({stack_.data() + begin, count}, axes, region, pairs);
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
typename DoubleFinder<D>::Axis DoubleFinder<D>::survey(std::size_t begin, std::size_t end,
                                                       const Region& region, int axis) {
  double low = infinity;
  double high = -infinity;
  const auto widen = [&](double coordinate) {
    const double within = std::clamp(coordinate, region.begin[axis], region.end[axis]);
    if (!std::isfinite(within)) return;
    low = std::min(low, within);
    high = std::max(high, within);
  };
  for (std::size_t i = begin; i < end; ++i) {
    widen(boxes_[stack_[i]].min[axis]);
    widen(boxes_[stack_[i]].max[axis]);
  }
  if (!(low < high)) return {low == high ? low : 0, low == high ? low : 0, 0, 0};

  minima_.clear();
  extents_.clear();
  const std::size_t count = end - begin;
  const std::size_t samples = std::min(count, most_samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const Box<D, double>& box = boxes_[stack_[begin + (2 * i + 1) * count / (2 * samples)]];
    minima_.push_back(box.min[axis]);
    extents_.push_back(box.max[axis] > box.min[axis] ? box.max[axis] - box.min[axis] : 0);
  }
  const auto median = [](std::vector<double>& values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  return {low, high, (high - low) * rounding / median(extents_), median(minima_)};
}

template <int D>
void DoubleFinder<D>::search_floats(std::span<const std::uint32_t> places, const std::array<Axis, D>& axes,
                                    const Region& region, PairSink& pairs) {
  const auto left =
      static_cast<std::size_t>(std::ranges::lower_bound(places, this->left_count()) - places.begin());
  ids_.clear();
  exact_.clear();
  gather(places.first(left), axes);
  gather(places.subspan(left), axes);
  floats_.resize(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      floats_[i].min[axis] = rounded(exact_[i].min[axis], axes[axis].low);
      floats_[i].max[axis] = rounded(exact_[i].max[axis], axes[axis].low);
    }
  }
  ExactSink exact(*this, left, region, pairs);
  const std::span<const Box<D>> floats = floats_;
  if (this->left_count() == 0)
    finder_->find(floats, exact);
  else
    finder_->find_between(floats.first(left), floats.subspan(left), exact);
  if (const auto& found = finder_->statistics()) {
    statistics_.tests += found->tests;
    statistics_.references += found->references;
  } else {
    counted_ = false;
  }
}

template <int D>
void DoubleFinder<D>::gather(std::span<const std::uint32_t> places, const std::array<Axis, D>& axes) {
  // Pairs are of boxes near each other, and each is looked up again in double: where the boxes are far more
  // than a cache holds, that would be a miss for each pair if they lay as they came.
  std::array<double, 2> per_unit;
  for (int axis = 0; axis < 2; ++axis)
    per_unit[axis] =
        axes[axis].high > axes[axis].low ? buckets_per_side / (axes[axis].high - axes[axis].low) : 0;
  const auto slot = [&](const Box<D, double>& box, int axis) {
    const double at = (box.min[axis] - axes[axis].low) * per_unit[axis];
    return static_cast<std::size_t>(std::min(buckets_per_side - 1, std::max(0.0, at)));
  };
  bucket_of_.resize(places.size());
  bucket_ends_.assign(bucket_count, 0);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Box<D, double>& box = boxes_[places[i]];
    const std::size_t bucket = slot(box, 1) * static_cast<std::size_t>(buckets_per_side) + slot(box, 0);
    bucket_of_[i] = static_cast<std::uint16_t>(bucket);
    ++bucket_ends_[bucket];
  }
  std::uint32_t total = static_cast<std::uint32_t>(ids_.size());
  for (std::uint32_t& end : bucket_ends_) total += std::exchange(end, total);
  ids_.resize(total);
  exact_.resize(total);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::uint32_t to = bucket_ends_[bucket_of_[i]]++;
    ids_[to] = BoxId{places[i]};
    exact_[to] = boxes_[places[i]];
  }
}

template class DoubleFinder<2>;
template class DoubleFinder<3>;

}  // namespace broadside::core

// Sweeps the cells of a grid, slab by slab.
//
// A cell's boxes are ordered by a counting sort into buckets of the swept axis: one pass counts, one
// scatters. Within a bucket they keep the order in which they came, which the kernels allow for (Run::slack).
// If the buckets are too uneven, the boxes are sorted instead.
#include "algorithms/grid/grid_sweep.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "algorithms/sweep_bounds.hpp"
#include "core/prefix_sum.hpp"
#include "core/sorted_boxes.hpp"
#include "kernels/sweep.hpp"

namespace broadside::algorithm {
namespace {

constexpr std::size_t min_buckets = 16;
constexpr std::size_t max_buckets = 1 << 13;

/// Boxes beyond the range are in the end buckets. Up to this many there are sorted by insertion.
constexpr std::size_t max_beyond = 32;

/// If a box shares its bucket with more boxes than this on average, it pays to sort all boxes.
constexpr std::size_t max_in_bucket = 48;

/// In a cell of more than this many boxes, counting those that reach the next cell costs less than room for
/// all.
constexpr std::size_t many_boxes = 1024;

/// The cost of a box in one more cell, in tests of two boxes.
constexpr std::uint64_t tests_per_reference = 32;

/// Passes pairs on and counts them.
class CountingSink final : public PairSink {
 public:
  explicit CountingSink(PairSink& target) : target_(&target) {}
  std::uint64_t count() const noexcept { return count_; }

 private:
  void consume(std::span<const Pair> pairs) override {
    count_ += pairs.size();
    target_->put(pairs);
  }

  PairSink* target_;
  std::uint64_t count_ = 0;
};

}  // namespace

template <int D>
Statistics GridSweep<D>::sweep(const GridLayout<D>& layout, const SweptRange& range,
                               const BoxesByCell<D>& cells, std::size_t slab, std::uint64_t max_tests,
                               PairSink& pairs) {
  axes_ = layout.axes();
  range_ = range;
  doubles_ = cells.doubles;
  checkpoint_ = cells.checkpoint;
  statistics_ = {};
  const std::size_t length = layout.row_length();
  columns_.resize(std::max(columns_.size(), length));
  for (Carried& column : columns_) column.size = 0;
  const std::size_t end = layout.slab_begin(slab + 1);
  swept_to_ = layout.slab_begin(slab) * length;
  CountingSink counted(pairs);
  for (std::size_t row = layout.slab_begin(slab); row < end; ++row) {
    // Boxes that reach into the next slab are there already.
    const float row_border = row + 1 < end ? layout.row_border(row) : std::numeric_limits<float>::quiet_NaN();
    along_.size = 0;
    for (std::size_t column = 0; column < length; ++column, ++swept_to_) {
      Lists lists;
      lists[0] =
          cells.boxes.subspan(cells.begin[swept_to_], cells.begin[swept_to_ + 1] - cells.begin[swept_to_]);
      lists[1] = columns_[column].list();
      if constexpr (D == 3) lists[2] = along_.list();
      // Pairs are counted only once there are many tests.
      const std::uint64_t work = statistics_.tests + tests_per_reference * statistics_.references;
      const bool is_counting = work > max_tests;
      if (is_counting && work > max_tests + max_tests / 4 + max_tests_per_pair * counted.count())
        return statistics_;
      if (!sweep_cell(lists, layout.column_border(column), row_border, max_tests,
                      is_counting ? static_cast<PairSink&>(counted) : pairs))
        return statistics_;
      if (is_counting) counted.flush();
      std::swap(columns_[column], next_up_);
      std::swap(along_, next_along_);
    }
  }
  return statistics_;
}

template <int D>
bool GridSweep<D>::sweep_cell(const Lists& lists, float column_border, float row_border,
                              std::uint64_t max_tests, PairSink& pairs) {
  std::size_t count = 0;
  for (const auto& list : lists) count += list.size();
  statistics_.references += count;
  next_up_.size = 0;
  next_along_.size = 0;
  if (count == 0) return true;
  if (checkpoint_ != nullptr) checkpoint_->count(count);  // with many cells, a box has many references
  // One more than may reach the border, since a box is written before it is known to go on.
  next_up_.reserve(max_reaching(lists, count, axes_[D - 1], row_border) + 1);
  if constexpr (D == 3) next_along_.reserve(max_reaching(lists, count, axes_[1], column_border) + 1);
  bucket_of_.resize(std::max(bucket_of_.size(), count));
  const Buckets buckets = cut(range_, count);
  starts_.assign(buckets.count(), 0);
  std::uint16_t* bucket_of = bucket_of_.data();
  for (std::size_t i = 0; i < lists.size(); ++i) {
    // A box from the row before is not carried along this row: each cell of that row passes it up.
    if (D == 3 && i != 1)
      count_and_pass_on<true>(lists[i], buckets, column_border, row_border, bucket_of);
    else
      count_and_pass_on<false>(lists[i], buckets, column_border, row_border, bucket_of);
    bucket_of += lists[i].size();
  }
  if (count < 2) return true;
  run_.reserve(count);
  const float slack = order(lists, count, buckets);
  run_.set_size(count);
  const kernels::Run<D> run = run_.view(doubles_, checkpoint_, slack);
  if (is_wasteful(run, max_tests)) return false;
  statistics_.tests += kernels::sweep(run, pairs);
  return true;
}

template <int D>
std::size_t GridSweep<D>::max_reaching(const Lists& lists, std::size_t count, int axis, float border) {
  if (count <= many_boxes) return count;
  std::size_t reaching = 0;
  for (const auto& list : lists)
    reaching += static_cast<std::size_t>(
        std::count_if(list.begin(), list.end(),
                      [axis, border](const CellEntry<D>& entry) { return entry.box.max[axis] >= border; }));
  return reaching;
}

template <int D>
typename GridSweep<D>::Buckets GridSweep<D>::cut(const SweptRange& range, std::size_t count) {
  const auto count_in_range = static_cast<float>(std::bit_ceil(std::clamp(count, min_buckets, max_buckets)));
  const float length = range.high - range.low;
  // Neither zero nor infinite: the product with an infinite or a zero distance would be NaN.
  const float per_unit = std::clamp(length > 0 ? count_in_range / length : 1,
                                    std::numeric_limits<float>::min(), std::numeric_limits<float>::max());
  // A bucket's width and what rounding may add to it.
  constexpr float rounding = 1e-6F;
  const float width = std::max(1 / per_unit, length / count_in_range);
  const float slack = std::min(width * 1.01F + rounding * std::max(std::abs(range.low), std::abs(range.high)),
                               std::numeric_limits<float>::max());
  return {{.low = range.low, .per_unit = per_unit, .last = count_in_range - 1}, slack};
}

template <int D>
template <bool Along>
void GridSweep<D>::count_and_pass_on(std::span<const CellEntry<D>> list, const Buckets& buckets,
                                     float column_border, float row_border, std::uint16_t* bucket_of) {
  const int swept = axes_[0];
  const int column_axis = axes_[1];
  const int row_axis = axes_[D - 1];
  CellEntry<D>* along = next_along_.memory.data() + next_along_.size;
  CellEntry<D>* up = next_up_.memory.data() + next_up_.size;
  std::uint32_t* const counts = starts_.data();
  for (const CellEntry<D>& entry : list) {
    const auto bucket = static_cast<std::uint16_t>(buckets.of(entry.box.min[swept]));
    *bucket_of++ = bucket;
    ++counts[bucket];
    // Always written, and kept only if it goes on: a branch would be unpredictable.
    *up = entry;
    up->dedup_mask |= 1U << row_axis;
    up += entry.box.max[row_axis] >= row_border ? 1 : 0;
    if constexpr (Along) {
      *along = entry;
      along->dedup_mask |= 1U << column_axis;
      along += entry.box.max[column_axis] >= column_border ? 1 : 0;
    }
  }
  next_along_.size = static_cast<std::size_t>(along - next_along_.memory.data());
  next_up_.size = static_cast<std::size_t>(up - next_up_.memory.data());
}

template <int D>
float GridSweep<D>::order(const Lists& lists, std::size_t count, const Buckets& buckets) {
  const std::size_t before = starts_.front();
  const std::size_t after = starts_.back();
  if (std::max(before, after) <= max_beyond && are_even(count)) {
    scatter(lists);
    run_.sort(0, before);
    run_.sort(count - after, count);
    return buckets.slack;
  }
  // Buckets over the cell's own range may be more even than over the range of all boxes.
  constexpr float infinity = std::numeric_limits<float>::infinity();
  SweptRange own{infinity, -infinity};
  for (const auto& list : lists) {
    for (const CellEntry<D>& entry : list) {
      own.low = std::min(own.low, entry.box.min[axes_[0]]);
      own.high = std::max(own.high, entry.box.min[axes_[0]]);
    }
  }
  if (std::isfinite(own.high - own.low)) {
    const Buckets narrower = cut(own, count);
    starts_.assign(narrower.count(), 0);
    std::uint16_t* bucket_of = bucket_of_.data();
    for (const auto& list : lists) {
      for (const CellEntry<D>& entry : list) {
        *bucket_of = static_cast<std::uint16_t>(narrower.of(entry.box.min[axes_[0]]));
        ++starts_[*bucket_of++];
      }
    }
    // If all boxes begin at one coordinate, sorting gains nothing.
    if (own.low == own.high || are_even(count)) {
      scatter(lists);
      return narrower.slack;
    }
  }
  sort(lists, count);
  return 0;
}

template <int D>
bool GridSweep<D>::are_even(std::size_t count) const {
  std::uint64_t squares = 0;
  for (const std::uint32_t in_bucket : starts_) squares += std::uint64_t{in_bucket} * in_bucket;
  return squares <= std::uint64_t{max_in_bucket} * count;
}

template <int D>
void GridSweep<D>::scatter(const Lists& lists) {
  core::prefix_sum(std::span<std::uint32_t>(starts_), starts_.size());
  const kernels::RunArrays<D> run = run_.arrays();
  const std::array<int, D> axes = axes_;
  std::uint32_t* const starts = starts_.data();
  const std::uint16_t* bucket_of = bucket_of_.data();
  for (const auto& list : lists) {
    for (const CellEntry<D>& entry : list) {
      const std::size_t place = starts[*bucket_of++]++;
      for (int axis = 0; axis < D; ++axis) {
        run.min[axis][place] = entry.box.min[axes[axis]];
        run.max[axis][place] = entry.box.max[axes[axis]];
      }
      run.id[place] = entry.id;
      run.dedup_mask[place] = entry.dedup_mask;
    }
  }
}

template <int D>
void GridSweep<D>::sort(const Lists& lists, std::size_t count) {
  const std::span<core::KeyedPlace> places = radix_.places(count);
  std::uint32_t next = 0;
  for (const auto& list : lists) {
    for (const CellEntry<D>& entry : list) {
      places[next] = {core::sort_key(entry.box.min[axes_[0]]), next};
      ++next;
    }
  }
  const auto filed_at = [&lists](std::size_t place) -> const CellEntry<D>& {
    std::size_t list = 0;
    while (place >= lists[list].size()) place -= lists[list++].size();
    return lists[list][place];
  };
  run_.clear();
  for (const core::KeyedPlace& place : radix_.sort()) {
    const CellEntry<D>& entry = filed_at(place.place);
    run_.append(core::turned(entry.box, axes_), entry.id, entry.dedup_mask);
  }
}

template class GridSweep<2>;
template class GridSweep<3>;

}  // namespace broadside::algorithm

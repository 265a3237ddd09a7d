// Finds the pairs of as many boxes as fit in a core's cache.
#include "algorithms/grid/tile_search.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "algorithms/sweep_bounds.hpp"

namespace broadside::algorithm {
namespace {

constexpr std::size_t spans_of_a_row = 32;

/// The maximum number of rows of a box beside that of its minimum, on average.
constexpr std::size_t max_further_rows = 3;

}  // namespace

template <int D>
std::optional<std::uint64_t> TileSearch<D>::sort(std::span<const Box<D>> boxes, const TileCells<D>& cells,
                                                 std::size_t left_count, double max_unevenness) {
  const std::size_t rows = cells.rows();
  const std::size_t buckets = cells.buckets.count();
  bucket_ends_.assign(rows * buckets, 0);
  core::renew(keys_, boxes.size());
  further_.clear();
  if (rows == 1) {
    count<false>(boxes, cells);
  } else {
    count<true>(boxes, cells);
    if (!count_further(boxes, cells)) return std::nullopt;
  }
  references_ = boxes.size() + further_.size();
  if (max_unevenness < std::numeric_limits<double>::infinity() && unevenness(buckets) > max_unevenness)
    return std::nullopt;
  const std::size_t places = place_rows(rows, buckets);
  run_.reserve(places);
  core::renew(candidate_ends_, std::max(candidate_ends_.size(), places + kernels::read_ahead));
  const bool has_masks = !further_.empty() || left_count > 0;
  if (has_masks)
    scatter<true>(boxes, cells, left_count);
  else
    scatter<false>(boxes, cells, left_count);
  run_.set_size(places);
  rows_ = {.run = run_.view(nullptr),
           .rows = rows,
           .bucket_of = cells.buckets,
           .bucket_ends = bucket_ends_.data(),
           .has_masks = has_masks};
  end_rows();
  return kernels::find_candidate_ends(rows_, candidate_ends_.data());
}

template <int D>
bool TileSearch<D>::finds_few_pairs() {
  // They are those of an earlier search.
  if (!rows_.has_masks) std::fill_n(run_.arrays().dedup_mask, places(), 0U);
  constexpr std::size_t max_tests_of_one = 256;
  return finds_few(rows_.run, max_tests_of_one, [this](std::size_t place) { return candidate_ends_[place]; });
}

template <int D>
std::uint64_t TileSearch<D>::sweep(std::size_t begin, std::size_t end, const Box<D, double>* doubles,
                                   Checkpoint* checkpoint, PairSink& pairs) const {
  kernels::BucketRows<D> rows = rows_;
  rows.run.doubles = doubles;
  rows.run.checkpoint = checkpoint;
  return kernels::sweep(rows, candidate_ends_.data(), begin, end, pairs);
}

/// Sets keys_, counts the boxes of each bucket in the row of their minimum, and lists those that reach other
/// rows.
template <int D>
template <bool HasRows>
void TileSearch<D>::count(std::span<const Box<D>> boxes, const TileCells<D>& cells) {
  const TileCells<D> of = cells;  // a copy, which no store below may change
  const std::uint32_t buckets = of.buckets.count();
  std::uint32_t* const counts = bucket_ends_.data();
  std::uint16_t* const keys = keys_.data();
  if constexpr (HasRows) core::renew(reaching_, boxes.size() + 1);
  std::uint32_t* reaching = reaching_.data();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    std::uint32_t key = of.buckets(boxes[i].min[of.axes[0]]);
    if constexpr (HasRows) {
      std::array<std::uint32_t, D - 1> first;
      bool reaches = false;
      for (int axis = 0; axis + 1 < D; ++axis) {
        first[axis] = of.row_axes[axis](boxes[i].min[of.axes[axis + 1]]);
        reaches |= first[axis] != of.row_axes[axis](boxes[i].max[of.axes[axis + 1]]);
      }
      key += of.row(first) * buckets;
      // Always written, and kept only if it reaches further: a branch would be unpredictable.
      *reaching = static_cast<std::uint32_t>(i);
      reaching += reaches ? 1 : 0;
    }
    keys[i] = static_cast<std::uint16_t>(key);
    ++counts[key];
  }
  if constexpr (HasRows) reaching_.resize(static_cast<std::size_t>(reaching - reaching_.data()));
}

/// Lists and counts the further rows of the boxes in reaching_. False as soon as they are too many.
template <int D>
bool TileSearch<D>::count_further(std::span<const Box<D>> boxes, const TileCells<D>& cells) {
  const std::uint32_t buckets = cells.buckets.count();
  for (const std::uint32_t i : reaching_) {
    if (further_.size() > max_further_rows * boxes.size()) return false;
    const Box<D> box = boxes[i];
    std::array<std::uint32_t, D - 1> first;
    std::array<std::uint32_t, D - 1> last;
    for (int axis = 0; axis + 1 < D; ++axis) {
      first[axis] = cells.row_axes[axis](box.min[cells.axes[axis + 1]]);
      last[axis] = cells.row_axes[axis](box.max[cells.axes[axis + 1]]);
    }
    const std::uint32_t bucket = cells.buckets(box.min[cells.axes[0]]);
    const auto add = [&](const std::array<std::uint32_t, D - 1>& at) {
      std::uint32_t dedup_mask = 0;
      for (int axis = 0; axis + 1 < D; ++axis) dedup_mask |= (at[axis] > first[axis] ? 1U : 0U) << axis;
      if (dedup_mask == 0) return;
      const std::uint32_t key = cells.row(at) * buckets + bucket;
      further_.push_back({i, static_cast<std::uint16_t>(key), static_cast<std::uint16_t>(dedup_mask)});
      ++bucket_ends_[key];
    };
    for (std::uint32_t at = first[0]; at <= last[0]; ++at) {
      if constexpr (D == 2) {
        add({at});
      } else {
        for (std::uint32_t above = first[1]; above <= last[1]; ++above) add({at, above});
      }
    }
  }
  return true;
}

/// How unevenly the boxes are spread over spans of several buckets: the mean of the squared numbers of boxes
/// over the squared mean. A lattice has empty buckets, but no empty spans.
template <int D>
double TileSearch<D>::unevenness(std::size_t buckets) const {
  const std::size_t length = std::max(buckets / spans_of_a_row, TileCells<D>::min_buckets);
  double squares = 0;
  double spans = 0;
  for (std::size_t begin = 0; begin < bucket_ends_.size(); begin += length) {
    std::uint32_t sum = 0;
    for (const std::uint32_t count : std::span(bucket_ends_).subspan(begin, length)) sum += count;
    squares += static_cast<double>(sum) * sum;
    ++spans;
  }
  const auto boxes = static_cast<double>(references_);
  return squares * spans / (boxes * boxes);
}

/// Replaces the counts by the places where each bucket begins. Returns the number of places.
template <int D>
std::size_t TileSearch<D>::place_rows(std::size_t rows, std::size_t buckets) {
  std::uint32_t place = 0;
  std::uint32_t* count = bucket_ends_.data();
  for (std::size_t row = 0; row < rows; ++row) {
    for (std::size_t bucket = 0; bucket < buckets; ++bucket, ++count) place += std::exchange(*count, place);
    place += kernels::read_ahead;
  }
  return place;
}

template <int D>
template <bool HasMasks>
void TileSearch<D>::scatter(std::span<const Box<D>> boxes, const TileCells<D>& cells,
                            std::size_t left_count) {
  const kernels::RunArrays<D> run = run_.arrays();
  const std::array<int, D> axes = cells.axes;
  std::uint32_t* const next = bucket_ends_.data();
  const auto put = [&](std::size_t key, std::uint32_t i, std::uint32_t dedup_mask) {
    const std::size_t place = next[key]++;
    const Box<D>& box = boxes[i];
    for (int axis = 0; axis < D; ++axis) {
      run.min[axis][place] = box.min[axes[axis]];
      run.max[axis][place] = box.max[axes[axis]];
    }
    run.id[place] = BoxId{i};
    if constexpr (HasMasks) run.dedup_mask[place] = dedup_mask | kernels::side_bit(BoxId{i}, left_count);
  };
  const std::uint16_t* const keys = keys_.data();
  for (std::uint32_t i = 0; i < boxes.size(); ++i) put(keys[i], i, 0);
  for (const FurtherRow& row : further_) put(row.key, row.box, row.dedup_mask);
}

/// Makes the places after each row overlap nothing.
template <int D>
void TileSearch<D>::end_rows() {
  const kernels::RunArrays<D> run = run_.arrays();
  const std::size_t buckets = rows_.bucket_of.count();
  for (std::size_t row = 0; row < rows_.rows; ++row) {
    const std::size_t end = bucket_ends_[(row + 1) * buckets - 1];
    for (std::size_t place = end; place < end + kernels::read_ahead; ++place) {
      run.min[0][place] = run.max[0][place] = std::numeric_limits<float>::quiet_NaN();
      candidate_ends_[place] = static_cast<std::uint32_t>(place);
    }
  }
}

template class TileSearch<2>;
template class TileSearch<3>;

}  // namespace broadside::algorithm

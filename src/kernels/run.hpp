// A run: contiguous boxes held as a structure of arrays, which is what the kernels work on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/pair.hpp"

#include "core/large_array.hpp"

namespace broadside::kernels {

/// Kernels may read this many elements beyond a run's last one. Their min[0] and max[0] must be NaN.
inline constexpr std::size_t read_ahead = 16;

/// `size` boxes as arrays. Axis 0 of a run is the swept axis, whichever axis of the caller's boxes that is.
template <int D>
struct Run {
  std::array<const float*, D> min;
  std::array<const float*, D> max;
  const BoxId* id;

  /// Two boxes that share a bit are not reported as a pair. Bit b is set if the box starts before the run's
  /// cell on axis b: two such boxes share an earlier cell, which reports their pair. The topmost bits are
  /// those of side_bit().
  const std::uint32_t* dedup_mask;

  std::size_t size;

  /// How far a box may begin before an earlier one of the run, at most: 0 if the run is sorted by min[0], a
  /// bucket's width if it is only sorted by buckets.
  float slack = 0;

  /// When a run is swept or compared with itself: how many of its first boxes are compared, each with all
  /// boxes after it. A multiple of read_ahead, or at least `size`.
  std::size_t rows = std::numeric_limits<std::size_t>::max();

  /// If the boxes were rounded from boxes of doubles: those boxes, by id. Pairs must then overlap in double.
  /// Else null.
  const Box<D, double>* doubles = nullptr;

  /// Counts the compared pairs, and may end the search by an exception. May be null.
  Checkpoint* checkpoint = nullptr;
};

/// The run from box `begin` on, with the boxes before `end` as rows. Both are multiples of read_ahead, unless
/// `end` is the run's end. Consecutive parts have the pairs of the whole run, in the same order.
template <int D>
Run<D> rows_of(Run<D> run, std::size_t begin, std::size_t end, Checkpoint* checkpoint) {
  for (int axis = 0; axis < D; ++axis) {
    run.min[axis] += begin;
    run.max[axis] += begin;
  }
  run.id += begin;
  run.dedup_mask += begin;
  run.size -= begin;
  run.rows = end - begin;
  run.checkpoint = checkpoint;
  return run;
}

/// Reports the tests since the last report to a checkpoint, if there is one. `told` counts reported tests.
inline void tell(Checkpoint* checkpoint, std::uint64_t tests, std::uint64_t& told) {
  if (checkpoint == nullptr) [[likely]]
    return;
  checkpoint->count(tests - std::exchange(told, tests));
}

/// The bit of `dedup_mask` for a box in a search between two sets, where the first `left_count` boxes are the
/// left set. Boxes of one set share their bit, so they are not paired. 0 if `left_count` is 0.
constexpr std::uint32_t side_bit(BoxId id, std::size_t left_count) noexcept {
  if (left_count == 0) return 0;
  return index(id) < left_count ? 1U << 30 : 1U << 31;
}

/// The arrays to write the boxes of a run to.
template <int D>
struct RunArrays {
  std::array<float*, D> min;
  std::array<float*, D> max;
  BoxId* id;
  std::uint32_t* dedup_mask;
};

/// The memory of a run. Keeps its allocations for reuse.
template <int D>
class RunBuffer {
 public:
  void clear() noexcept { size_ = 0; }

  std::size_t size() const noexcept { return size_; }

  /// Makes room for `count` boxes, so that append() need not.
  void reserve(std::size_t count) {
    // `dedup_mask_` grows last: if it has room, all arrays have, even after an allocation failed in between.
    if (count + read_ahead <= dedup_mask_.size()) return;
    // Initialized, since kernels read ahead.
    for (int axis = 0; axis < D; ++axis) {
      min_[axis].resize(count + read_ahead, 0);
      max_[axis].resize(count + read_ahead, 0);
    }
    id_.resize(count + read_ahead, BoxId{0});
    dedup_mask_.resize(count + read_ahead, 0);
  }

  /// Adds a box whose axes are already in the run's order. reserve() must have made the room.
  void append(const Box<D>& box, BoxId id, std::uint32_t dedup_mask = 0) {
    for (int axis = 0; axis < D; ++axis) {
      min_[axis][size_] = box.min[axis];
      max_[axis][size_] = box.max[axis];
    }
    id_[size_] = id;
    dedup_mask_[size_] = dedup_mask;
    ++size_;
  }

  /// The arrays, to write boxes to in any order, between reserve() and set_size().
  RunArrays<D> arrays() {
    RunArrays<D> arrays;
    for (int axis = 0; axis < D; ++axis) {
      arrays.min[axis] = min_[axis].data();
      arrays.max[axis] = max_[axis].data();
    }
    arrays.id = id_.data();
    arrays.dedup_mask = dedup_mask_.data();
    return arrays;
  }

  void set_size(std::size_t size) noexcept { size_ = size; }

  /// Sorts a few boxes, at the places [begin, end), by min[0]. The sort is stable.
  void sort(std::size_t begin, std::size_t end) {
    for (std::size_t i = begin + 1; i < end; ++i) {
      for (std::size_t j = i; j > begin && min_[0][j] < min_[0][j - 1]; --j) swap(j, j - 1);
    }
  }

  /// The run, valid until the buffer is changed.
  Run<D> view(const Box<D, double>* doubles, Checkpoint* checkpoint = nullptr, float slack = 0) {
    reserve(size_);
    for (std::size_t i = 0; i < read_ahead; ++i)
      min_[0][size_ + i] = max_[0][size_ + i] = std::numeric_limits<float>::quiet_NaN();
    Run<D> run{};
    for (int axis = 0; axis < D; ++axis) {
      run.min[axis] = min_[axis].data();
      run.max[axis] = max_[axis].data();
    }
    run.id = id_.data();
    run.dedup_mask = dedup_mask_.data();
    run.size = size_;
    run.slack = slack;
    run.doubles = doubles;
    run.checkpoint = checkpoint;
    return run;
  }

 private:
  void swap(std::size_t a, std::size_t b) {
    for (int axis = 0; axis < D; ++axis) {
      std::swap(min_[axis][a], min_[axis][b]);
      std::swap(max_[axis][a], max_[axis][b]);
    }
    std::swap(id_[a], id_[b]);
    std::swap(dedup_mask_[a], dedup_mask_[b]);
  }

  std::array<core::LargeArray<float>, D> min_;
  std::array<core::LargeArray<float>, D> max_;
  core::LargeArray<BoxId> id_;
  core::LargeArray<std::uint32_t> dedup_mask_;
  std::size_t size_ = 0;
};

}  // namespace broadside::kernels

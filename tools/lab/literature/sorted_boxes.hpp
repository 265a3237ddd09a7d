// Boxes sorted by their minima on one axis, as a structure of arrays, and the sweep over them.
//
// The sweep is that of Terdiman's "Box pruning revisited", parts 11 to 15: the sweep axis is stored apart
// from the others, as integers in the floats' order; a sentinel replaces the test for the end; one box is
// tested against eight others at once (part 15, with Giesen's kernel for AVX).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/pair.hpp"

#include "lab/literature/radix_sort.hpp"

namespace broadside::lab::literature {

/// Boxes in ascending order of their minima on the sweep axis.
template <int D>
class SortedBoxes {
 public:
  static constexpr std::size_t other_axes = D - 1;

  /// How many entries a sweep may read beyond the last box.
  static constexpr std::size_t read_ahead = 8;

  /// Resizes to `count` boxes; each must then be set().
  void resize(std::size_t count) {
    size_ = count;
    begin_.resize(count + read_ahead);
    std::fill(begin_.begin() + static_cast<std::ptrdiff_t>(count), begin_.end(), beyond_floats);
    end_.resize(count);
    ids_.resize(count);
    for (std::size_t i = 0; i < other_axes; ++i) {
      low_[i].resize(count + read_ahead);
      high_[i].resize(count + read_ahead);
    }
  }

  /// Stores a box at `place`. Minima on `sweep_axis` must ascend with places.
  void set(std::size_t place, const Box<D>& box, BoxId id, int sweep_axis) {
    begin_[place] = ordered(box.min[sweep_axis]);
    end_[place] = ordered(box.max[sweep_axis]);
    ids_[place] = id;
    for (std::size_t i = 0; i < other_axes; ++i) {
      const int axis = (sweep_axis + 1 + static_cast<int>(i)) % D;
      low_[i][place] = box.min[axis];
      high_[i][place] = box.max[axis];
    }
  }

  std::size_t size() const noexcept { return size_; }
  const std::int32_t* begin() const noexcept { return begin_.data(); }
  const std::int32_t* end() const noexcept { return end_.data(); }
  const float* low(std::size_t i) const noexcept { return low_[i].data(); }
  const float* high(std::size_t i) const noexcept { return high_[i].data(); }
  const BoxId* ids() const noexcept { return ids_.data(); }

 private:
  std::size_t size_ = 0;
  std::vector<std::int32_t> begin_;  // on the sweep axis, with sentinels after the last
  std::vector<std::int32_t> end_;
  std::array<std::vector<float>, other_axes> low_;
  std::array<std::vector<float>, other_axes> high_;
  std::vector<BoxId> ids_;
};

/// Writes each overlapping pair of `boxes` once. `checkpoint` counts the tests.
template <int D>
void sweep(const SortedBoxes<D>& boxes, Checkpoint& checkpoint, PairSink& pairs);

/// Writes each overlapping pair of a box of `left` and a box of `right` once. Both must have the same sweep
/// axis.
template <int D>
void sweep(const SortedBoxes<D>& left, const SortedBoxes<D>& right, Checkpoint& checkpoint, PairSink& pairs);

}  // namespace broadside::lab::literature

// A run: contiguous boxes held as a structure of arrays, which is what the kernels work on.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::kernels {

/// `size` boxes seen as arrays. Axis 0 of a run is the axis that is swept; which axis of the caller's boxes
/// that is, is the caller's affair.
template <int D>
struct Run {
  std::array<const float*, D> min;
  std::array<const float*, D> max;
  const BoxId* id;

  /// Two boxes with a bit of `apart` in common are not reported. Bit b is set if the box starts before the
  /// run's cell on the cell's axis b: two that both do share an earlier cell, and their pair is reported
  /// there. The topmost bits are those of side_bit().
  const std::uint32_t* apart;

  std::size_t size;
};

/// What to set of `apart` for a box of a search between two sets, of which the first `left_count` boxes are
/// the left one: boxes of one set have it in common. Nothing if `left_count` is 0.
constexpr std::uint32_t side_bit(BoxId id, std::size_t left_count) noexcept {
  if (left_count == 0) return 0;
  return index(id) < left_count ? 1U << 30 : 1U << 31;
}

/// The memory of a run that grows box by box; it keeps what it has allocated.
template <int D>
class RunBuffer {
 public:
  void clear() noexcept { size_ = 0; }

  std::size_t size() const noexcept { return size_; }

  /// Makes room for `count` boxes, so that append() need not.
  void reserve(std::size_t count) {
    if (count <= id_.size()) return;
    for (int axis = 0; axis < D; ++axis) {
      min_[axis].resize(count);
      max_[axis].resize(count);
    }
    id_.resize(count);
    apart_.resize(count);
  }

  /// Adds a box whose axes are already in the run's order. reserve() must have made the room.
  void append(const Box<D>& box, BoxId id, std::uint32_t apart = 0) {
    for (int axis = 0; axis < D; ++axis) {
      min_[axis][size_] = box.min[axis];
      max_[axis][size_] = box.max[axis];
    }
    id_[size_] = id;
    apart_[size_] = apart;
    ++size_;
  }

  Run<D> view() const noexcept {
    Run<D> run{};
    for (int axis = 0; axis < D; ++axis) {
      run.min[axis] = min_[axis].data();
      run.max[axis] = max_[axis].data();
    }
    run.id = id_.data();
    run.apart = apart_.data();
    run.size = size_;
    return run;
  }

 private:
  std::array<std::vector<float>, D> min_;
  std::array<std::vector<float>, D> max_;
  std::vector<BoxId> id_;
  std::vector<std::uint32_t> apart_;
  std::size_t size_ = 0;
};

}  // namespace broadside::kernels

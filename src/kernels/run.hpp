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

  /// Bit b of a box's `before` is set if the box starts before the run's cell on the cell's axis b. Two boxes
  /// of which both start before it on the same axis share an earlier cell, and it is there that their pair is
  /// reported.
  const std::uint32_t* before;

  std::size_t size;
};

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
    before_.resize(count);
  }

  /// Adds a box whose axes are already in the run's order. reserve() must have made the room.
  void append(const Box<D>& box, BoxId id, std::uint32_t before = 0) {
    for (int axis = 0; axis < D; ++axis) {
      min_[axis][size_] = box.min[axis];
      max_[axis][size_] = box.max[axis];
    }
    id_[size_] = id;
    before_[size_] = before;
    ++size_;
  }

  Run<D> view() const noexcept {
    Run<D> run{};
    for (int axis = 0; axis < D; ++axis) {
      run.min[axis] = min_[axis].data();
      run.max[axis] = max_[axis].data();
    }
    run.id = id_.data();
    run.before = before_.data();
    run.size = size_;
    return run;
  }

 private:
  std::array<std::vector<float>, D> min_;
  std::array<std::vector<float>, D> max_;
  std::vector<BoxId> id_;
  std::vector<std::uint32_t> before_;
  std::size_t size_ = 0;
};

}  // namespace broadside::kernels

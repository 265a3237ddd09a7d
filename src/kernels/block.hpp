// Block: sixteen boxes (AABBs) as a structure of arrays for SIMD, and operations on a whole block.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "broadside/box.hpp"

#include "core/moved_box.hpp"

namespace broadside::kernels {

using core::MovedBox;
using core::nan_box;
using core::no_slot;

/// How many boxes a block has room for: all of them are compared at once.
inline constexpr std::size_t block_size = 16;

/// Sixteen boxes, one per lane. A lane without a box holds nan_box().
template <int D>
struct alignas(64) Block {
  std::array<std::array<float, block_size>, D> min;
  std::array<std::array<float, block_size>, D> max;
  std::array<std::uint32_t, block_size> id;  ///< the numbers that the owner gives its boxes

  void set(std::size_t lane, const Box<D>& box) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis][lane] = box.min[axis];
      max[axis][lane] = box.max[axis];
    }
  }

  Box<D> box(std::size_t lane) const {
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = min[axis][lane];
      box.max[axis] = max[axis][lane];
    }
    return box;
  }

  /// Sets every lane to nan_box() with id 0.
  void clear() {
    for (std::size_t lane = 0; lane < block_size; ++lane) set(lane, nan_box<D>());
    id.fill(0);
  }
};

}  // namespace broadside::kernels

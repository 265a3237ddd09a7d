// Boxes in the order in which a sweep meets them.
#pragma once

#include <array>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/large_array.hpp"
#include "core/parallel.hpp"
#include "core/radix_sort.hpp"

namespace broadside::core {

/// A box, its axes in a sweep's order (axis 0 is swept along), and its place in the caller's array.
template <int D>
struct SortedBox {
  Box<D> box;
  BoxId id;
};

/// Sorts boxes by where they begin on the swept axis; keeps its memory from one sort to the next.
template <int D>
class SortedBoxes {
 public:
  /// The boxes with axis a being `axes[a]` of the caller's, ascending by min[0], ties in the caller's order.
  /// Valid until the next call.
  std::span<const SortedBox<D>> sort(std::span<const Box<D>> boxes, const std::array<int, D>& axes,
                                     Parallel& parallel);
  std::span<const SortedBox<D>> sort(std::span<const Box<D>> boxes, const std::array<int, D>& axes) {
    Parallel alone;
    return sort(boxes, axes, alone);
  }

 private:
  RadixSort radix_;
  LargeArray<SortedBox<D>> sorted_;
};

}  // namespace broadside::core

// SortedBoxes: boxes in the order of a sweep.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <type_traits>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/large_array.hpp"
#include "core/parallel.hpp"
#include "core/radix_sort.hpp"

namespace broadside::core {

/// The box with its axes permuted: axis a of the result is axis `axes[a]` of `box`.
template <int D>
Box<D> turned(const Box<D>& box, const std::type_identity_t<std::array<int, D>>& axes) {
  Box<D> turned;
  for (int axis = 0; axis < D; ++axis) {
    turned.min[axis] = box.min[axes[axis]];
    turned.max[axis] = box.max[axes[axis]];
  }
  return turned;
}

/// A box with its axes in a sweep's order (axis 0 is the swept axis), and its place in the caller's array.
template <int D>
struct SortedBox {
  Box<D> box;
  BoxId id;
};

/// A sorted box in a node of a tree. Bit a of `dedup_mask` is set if the box begins before the node's region
/// on axis a; the other bits are as in kernels::Run.
struct SortedReference {
  std::uint32_t place;  ///< among the sorted boxes
  std::uint32_t dedup_mask;
};

/// Sorts boxes by their minimum on the swept axis. Keeps its memory for the next sort.
template <int D>
class SortedBoxes {
 public:
  /// The boxes with permuted axes, ascending by min[0], ties in the caller's order. Valid until the next
  /// call.
  std::span<const SortedBox<D>> sort(std::span<const Box<D>> boxes, const std::array<int, D>& axes,
                                     Parallel& parallel) {
    const std::span<KeyedPlace> places = radix_.places(boxes.size());
    const int swept = axes[0];
    parallel.for_ranges(boxes.size(), [&](Range range, std::size_t) {
      for (std::size_t i = range.begin; i < range.end; ++i)
        places[i] = {sort_key(boxes[i].min[swept]), static_cast<std::uint32_t>(i)};
    });
    const std::span<const KeyedPlace> order = radix_.sort(parallel);
    renew(sorted_, boxes.size());
    parallel.for_ranges(boxes.size(), [&](Range range, std::size_t) {
      SortedBox<D>* out = sorted_.data() + range.begin;
      for (const KeyedPlace& place : order.subspan(range.begin, range.size()))
        *out++ = {turned(boxes[place.place], axes), BoxId{place.place}};
    });
    return sorted_;
  }
  std::span<const SortedBox<D>> sort(std::span<const Box<D>> boxes, const std::array<int, D>& axes) {
    Parallel alone;
    return sort(boxes, axes, alone);
  }

 private:
  RadixSort radix_;
  LargeArray<SortedBox<D>> sorted_;
};

}  // namespace broadside::core

// The floor: what a search cannot do without, timed beside the searches. A sort, a gather and the pairs
// written.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::lab {

/// Below this many boxes there is no floor: a comparison of a few hundred boxes is done before they are
/// sorted.
inline constexpr std::size_t min_boxes_of_floor = 1'000;

/// One way to find pairs is to sort the boxes along an axis, to bring them into that order, to sweep, and to
/// write the pairs. This does all of it but the sweep: three counting passes of 11 bits over a 64-bit key for
/// each box (its place and, above it, what orders as its least x does), one gather of the boxes in sorted
/// order into a structure of arrays, and as many pairs as a search gives, written in sequence. So its time is
/// what the machine takes for the boxes and the pairs where finding out which overlap costs nothing.
///
/// Keeps its memory from one call to the next, as finders do. One thread.
template <int D>
class Floor {
 public:
  /// Does the work for `boxes`, writing over all of `pairs`. What is written there are no overlapping pairs.
  void run(std::span<const Box<D>> boxes, std::span<Pair> pairs);

  /// The places of the boxes in the order of the last run: ascending by min[0], ties in the caller's order.
  std::vector<std::uint32_t> order() const;

  /// The bounds of the boxes in that order: min of each axis, then max of each.
  const std::array<std::vector<float>, 2 * D>& bounds() const noexcept { return bounds_; }

 private:
  void sort(std::span<const Box<D>> boxes);

  std::vector<std::uint64_t> keys_;
  std::vector<std::uint64_t> other_;
  std::array<std::vector<float>, 2 * D> bounds_;
};

}  // namespace broadside::lab

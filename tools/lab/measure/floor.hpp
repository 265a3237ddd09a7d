// The lower bound of a search's time ("floor" in results): a sort, a gather and writing the pairs, timed
// beside the searches.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::lab {

/// Below this many boxes there is no lower bound: searching a few hundred boxes takes less time than sorting
/// them.
inline constexpr std::size_t min_boxes_of_floor = 1'000;

/// One way to find pairs is to sort the boxes along an axis, bring them into that order, sweep, and write the
/// pairs. This does all of that but the sweep: three counting passes of 11 bits over a 64-bit key for each
/// box (its index and, above it, an integer in the order of its minimum x), one gather of the boxes in sorted
/// order into a structure of arrays, and as many sequentially written pairs as a search gives. So its time is
/// that of a search that decides for free which boxes overlap.
///
/// Keeps its memory from one call to the next, as finders do. Single-threaded.
template <int D>
class Floor {
 public:
  /// Does the work for `boxes`, overwriting all of `pairs`. The written pairs are not overlapping pairs.
  void run(std::span<const Box<D>> boxes, std::span<Pair> pairs);

  /// The indices of the boxes in the order of the last run: ascending by min[0], ties in the caller's order.
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

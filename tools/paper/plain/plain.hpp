// The library's two fastest searches written plainly, so that each optimisation can be left out separately.
// For the paper's ablation: finite boxes only, and no protection against worst cases. Compiled without the
// compiler's own SIMD. None of them is part of the library, and results name no instruction set for them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::plain {

/// All algorithms below, in this order.
std::vector<Algorithm> algorithms();

/// The algorithm of `grid`: cells on all axes but one, and a sweep along that axis in each. Its tunables
/// leave optimisations out; it has no SIMD.
Algorithm plain_grid();

/// The algorithm of `bvh`: boxes packed sixteen to a leaf, and the tree joined with itself. Likewise.
Algorithm plain_bvh();

/// The library's algorithm `search`, restricted to the instruction set `simd`: in the same rounds as others
/// without the restriction.
Algorithm held_back();

/// A tunable with the values "yes", the default, and "no".
Tunable switch_tunable(std::string name, std::string summary);

/// Statistics of the boxes along each axis.
template <int D>
struct Shape {
  std::array<float, D> extent{};  ///< on average
  std::array<float, D> low{};
  std::array<float, D> high{};

  /// The axis on which boxes are shortest, relative to the space that they are in.
  int best_axis() const;
};

/// Of all boxes, or of 256 spread over the array.
template <int D>
Shape<D> shape_of(std::span<const Box<D>> boxes, bool sampled);

/// Writes make(i) for each i of [begin, end) that is a hit to `to`, which has room for one more; returns the
/// number of hits. With `branch_free`, writes every value, and advances only after a hit.
template <typename Value, typename IsHit, typename Make>
std::size_t write_hits(bool branch_free, std::size_t begin, std::size_t end, Value* to, const IsHit& is_hit,
                       const Make& make) {
  std::size_t count = 0;
  if (branch_free) {
    for (std::size_t i = begin; i < end; ++i) {
      to[count] = make(i);
      count += is_hit(i) ? 1 : 0;
    }
    return count;
  }
  for (std::size_t i = begin; i < end; ++i) {
    if (is_hit(i)) to[count++] = make(i);
  }
  return count;
}

/// Whether the boxes at two places of `bounds` overlap; the bounds have min(place, axis) and max(place,
/// axis).
template <int D, typename Bounds, typename Others>
bool overlap_at(bool branch_free, const Bounds& bounds, std::size_t i, const Others& others, std::size_t j) {
  bool hit = true;
  for (int axis = 0; axis < D; ++axis) {
    if (!branch_free && !hit) return false;
    hit &= bounds.min(i, axis) <= others.max(j, axis);
    hit &= others.min(j, axis) <= bounds.max(i, axis);
  }
  return hit;
}

inline Pair ordered_pair(BoxId a, BoxId b) { return {std::min(a, b), std::max(a, b)}; }

}  // namespace broadside::plain

// The library's two fastest searches written plainly, so that each thing that makes them fast can be left out
// alone. For the paper's ablation: finite boxes only, and no care for the worst case. Compiled without the
// compiler's own SIMD. None of them is one of the library's, and results name no instruction set for them.
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

/// All that follow, in this order.
std::vector<Algorithm> algorithms();

/// The algorithm of `grid`: cells on all axes but one, and a sweep along that one in each. Its tunables leave
/// things out; SIMD it has none.
Algorithm plain_grid();

/// The algorithm of `bvh`: boxes packed sixteen to a leaf, and the tree joined with itself. Likewise.
Algorithm plain_bvh();

/// The library's algorithm `search`, held to the instruction set `simd`: in the same rounds as others that
/// are not.
Algorithm held_back();

/// A tunable whose values are "yes", which is the standard, and "no".
Tunable switch_tunable(std::string name, std::string summary);

/// What boxes look like along each axis.
template <int D>
struct Shape {
  std::array<float, D> extent{};  ///< on average
  std::array<float, D> low{};
  std::array<float, D> high{};

  /// The axis on which boxes are shortest, compared with the space that they are in.
  int best_axis() const;
};

/// Of all boxes, or of 256 spread over the array.
template <int D>
Shape<D> shape_of(std::span<const Box<D>> boxes, bool sampled);

/// Writes make(i) for each i of [begin, end) that is a hit to `to`, which has room for one more; returns how
/// many. Where `branch_free`, in any case, and keeps it if it is a hit.
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

/// Whether what stands at two places of `bounds` overlaps; these have min(place, axis) and max(place, axis).
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

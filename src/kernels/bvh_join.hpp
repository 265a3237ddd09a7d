// PackedBvh: a packed BVH, level by level in arrays, and its join with itself.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "broadside/executor.hpp"
#include "broadside/pair.hpp"

#include "kernels/bvh.hpp"

namespace broadside::kernels {

/// No tree over 2^32 boxes has more levels.
inline constexpr std::size_t max_levels = 9;

/// One level: the boxes (level 0), or bounds around every sixteen elements of the level below. Arrays hold a
/// multiple of `fan_out` elements. Elements beyond `size`, and places of level 0 without a box, are NaN.
template <int D>
struct TreeLevel {
  std::array<float*, D> min;
  std::array<float*, D> max;
  std::size_t size;
};

/// Boxes in an order in which neighbours in the array are neighbours in space, and bounds over them. The
/// topmost level has at most `fan_out` elements.
template <int D>
struct PackedBvh {
  std::array<TreeLevel<D>, max_levels> levels;
  std::size_t level_count;
  const BoxId* id;  ///< of the boxes on level 0

  /// In a search between two sets, how many places of level 0 hold the left set: a multiple of `fan_out`.
  /// Else 0.
  std::size_t left_size;

  /// Leaves before this one are full. A later one may hold fewer than `fan_out` boxes, in its first places.
  std::size_t first_with_gap = 0;

  /// As in a Run.
  const Box<D, double>* doubles = nullptr;
};

/// A half-open range of elements of a level. The elements of level 1 are the leaves.
struct NodeRange {
  std::size_t begin;
  std::size_t end;
};

/// Sets the bounds of `nodes` on level `parent` > 0 from the level below. There, places beyond the level's
/// size or without a box must be absent boxes (not yet NaN). Several threads may do so at once.
template <int D>
void set_bounds(const PackedBvh<D>& tree, std::size_t parent, NodeRange nodes);

/// How many numbers of scratch memory a join of the tree takes.
template <int D>
std::size_t join_scratch(const PackedBvh<D>& tree) {
  std::size_t size = 0;
  for (std::size_t level = 1; level < tree.level_count; ++level)
    size += tree.levels[level].size + 2 * fan_out;
  return size;
}

/// The work a join may do before it gives up: a number of tests, and some more for each pair it has found.
/// A comparison of bounds counts as a test, also for the checkpoint.
struct JoinLimit {
  std::uint64_t tests = std::numeric_limits<std::uint64_t>::max();
  std::uint64_t tests_per_pair = 0;
  Checkpoint* checkpoint = nullptr;  ///< as in a Run
};

/// The work that a join did.
struct JoinWork {
  std::uint64_t tests;    ///< pairs of boxes compared
  std::uint64_t unused;   ///< how many more tests the limit allowed
  std::size_t next_leaf;  ///< leaves before it are joined; the end of the range unless the join gave up
};

/// Joins each of these leaves with itself and all later leaves, even beyond the range. Reports the pairs of
/// overlapping boxes, or only pairs between the two sets, leaf by leaf. `scratch` has room for join_scratch()
/// numbers. Several threads may join leaves of one tree at once.
template <int D>
JoinWork join(const PackedBvh<D>& tree, NodeRange leaves, const JoinLimit& limit, std::uint32_t* scratch,
              PairSink& pairs);

}  // namespace broadside::kernels

// A tree of boxes that stays from frame to frame: movers looked up in it and moved, bounds brought up to
// date, and the leaf chosen that suits a box.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::kernels {

/// How many boxes a leaf has room for, and children a node.
inline constexpr std::size_t kept_width = 16;

/// More levels than such a tree ever has.
inline constexpr std::size_t most_kept_levels = 10;

/// The id in a place without a box.
inline constexpr std::uint32_t no_box = 0xffffffffU;

/// Sixteen boxes or bounds. Where there is none stands the absent box.
template <int D>
struct alignas(64) KeptBounds {
  float min[D][kept_width];
  float max[D][kept_width];
};

/// The child `16 n + c` of level l is lane c of node n on level l + 1; level 0 are the leaves, whose lanes
/// are boxes. The topmost level is one node.
template <int D>
struct KeptTree {
  std::array<KeptBounds<D>*, most_kept_levels> nodes;
  std::size_t top;                                    ///< the topmost level, at least 1
  std::uint32_t* ids;                                 ///< of the boxes, by place: 16 a leaf
  std::array<std::uint32_t*, most_kept_levels> room;  ///< by element of a level: places without a box below
  std::array<std::uint32_t*, 2> lists;                ///< scratch: as many elements as leaves, and 32 more
};

/// A box that changed.
template <int D>
struct KeptStep {
  Box<D> before;  ///< NaN if it was absent
  Box<D> now;     ///< NaN if it is absent
  Box<D> stored;  ///< what is to stand in its place from now on
  std::uint32_t id;
  std::uint32_t place;
  bool every;   ///< whether pairs are asked for that overlap before and now
  bool is_far;  ///< whether before and now lie so far apart that each is looked up by itself
  bool writes;  ///< whether `stored` differs from what stands there
};

/// What follow() did.
struct Followed {
  std::uint64_t tests = 0;  ///< boxes compared, where a leaf counts as full
  std::size_t left = 0;     ///< steps whose new box is not within the bounds that its leaf had
};

/// Does the steps one after the other: writes the pairs of the box and those it begins to overlap or ceases
/// to, if these stay as they stand there; writes `stored` to its place; and widens all bounds around it. The
/// numbers of the steps that left their leaves go to `left`, which has room for all. Where `every` is set,
/// pairs that overlap before or now go to `begun`.
template <int D>
Followed follow(const KeptTree<D>& tree, std::span<const KeptStep<D>> steps, std::uint32_t* left,
                PairSink& begun, PairSink& ended);

/// Sets the bounds on level `level` > 0 of those elements of the level below.
template <int D>
void refit(const KeptTree<D>& tree, std::size_t level, std::span<const std::uint32_t> children);

/// The leaf with room that would have to grow the least for a box, level by level. There must be room.
template <int D>
std::uint32_t choose_leaf(const KeptTree<D>& tree, const Box<D>& box);

}  // namespace broadside::kernels

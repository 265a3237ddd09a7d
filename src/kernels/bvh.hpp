// The node of a dynamic bounding volume hierarchy (BVH, an AABB tree), the views of a BVH that kernels take,
// tests of one node, and follow(), which moves boxes in a BVH.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/pair.hpp"

#include "kernels/block.hpp"

namespace broadside::kernels {

/// How many children a node has at most: bounds, or boxes in a leaf, all compared at once. The same on every
/// instruction set, since it fixes the order of the pairs.
inline constexpr std::size_t fan_out = block_size;

/// No path through such a tree is longer.
inline constexpr std::size_t longest_path = 32;

/// Set in the number of a leaf: a node with boxes as children.
inline constexpr std::uint32_t leaf_bit = 0x80000000U;

/// The part of a node that a search does not read. The node itself is a block. A leaf holds boxes and their
/// ids; any other node holds the bounds of its children and, as ids, their numbers with their leaf_bit.
struct BvhNodeInfo {
  std::uint32_t parent;  ///< slot in the parent: parent's number * fan_out + lane; no_slot for the root
  std::uint8_t count;    ///< children, in the first lanes
  bool is_leaf;
};

/// A tree to search: `root` is a node's number with its leaf_bit.
template <int D>
struct BvhView {
  const Block<D>* nodes;
  std::uint32_t root;
};

/// A tree to move boxes in.
template <int D>
struct WritableBvh {
  Block<D>* nodes;
  const BvhNodeInfo* info;
  std::uint32_t root;
  std::array<std::uint32_t*, 2> lists;  ///< scratch: each with room for all nodes and two more blocks
  Checkpoint* checkpoint = nullptr;     ///< counts the pairs that follow() compares; may be null
};

/// The bounds of a node's children; the absent box if there are none.
template <int D>
Box<D> bounds_of(const Block<D>& node);

/// Which of the first `count` > 0 children grows least, in the sum of its extents, if it must contain `box`.
/// Of several, the smallest one, then the first one.
template <int D>
std::size_t best_child(const Block<D>& node, std::size_t count, const Box<D>& box);

/// The repairs that a move calls for in the tree, as bits.
inline constexpr std::uint8_t may_shrink = 1;  ///< the old box was at the border of its leaf's bounds
inline constexpr std::uint8_t left_leaf = 2;   ///< the new box is not within the bounds that its leaf had

/// Moves boxes one after the other. For each box it writes the pairs that begin and that end, with all other
/// boxes where the tree has them at that time. Then it writes the new box to its slot, enlarges the bounds
/// around it, and writes to `calls_for` what the move calls for. If its filter changed, all pairs that
/// overlap before or now go to `begun`. A box that is absent now leaves its lane without a box. Returns how
/// many pairs of boxes were compared, each leaf counted as full.
template <int D>
std::uint64_t follow(const WritableBvh<D>& tree, std::span<const MovedBox<D>> moved, std::uint8_t* calls_for,
                     PairSink& begun, PairSink& ended);

}  // namespace broadside::kernels

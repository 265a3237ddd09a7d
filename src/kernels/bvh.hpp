// The node of a dynamic bounding volume hierarchy (an AABB tree), the views of one that kernels take, what
// one node tells, and boxes that move in one.
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

/// How many children a node has at most: bounds (or boxes, in a leaf) that are compared at once. The same on
/// every instruction set, since it fixes the order of the pairs.
inline constexpr std::size_t fan_out = block_size;

/// A path through such a tree is never longer.
inline constexpr std::size_t longest_path = 32;

/// Set in the number of a node that is a leaf, whose children are boxes.
inline constexpr std::uint32_t leaf_bit = 0x80000000U;

/// The part of a node that a search does not read. The node itself is a block: the bounds of its children, or
/// boxes in a leaf, and as ids the children's numbers with their leaf_bit, or the boxes' ids.
struct BvhNodeInfo {
  std::uint32_t parent;  ///< slot in the parent: the node above * fan_out + lane; no_slot for the root
  std::uint8_t count;    ///< children, in the first lanes
  bool is_leaf;
};

/// A tree to search: `root` is a node's number with its leaf_bit.
template <int D>
struct BvhView {
  const Block<D>* nodes;
  std::uint32_t root;
};

/// A tree whose bounds change.
template <int D>
struct WritableBvh {
  Block<D>* nodes;
  const BvhNodeInfo* info;
  std::uint32_t root;
  std::array<std::uint32_t*, 2> lists;  ///< scratch: each with room for all nodes and two more blocks
  Checkpoint* checkpoint = nullptr;     ///< counts the pairs that follow() compares; or null
};

/// The bounds of a node's children; the absent box if there are none.
template <int D>
Box<D> bounds_of(const Block<D>& node);

/// Which of the first `count` > 0 children grows least, in the sum of its extents, if it is to hold `box`;
/// of several, the smallest, then the first one.
template <int D>
std::size_t best_child(const Block<D>& node, std::size_t count, const Box<D>& box);

/// The repairs that a move calls for in the tree, as bits.
inline constexpr std::uint8_t may_shrink = 1;  ///< the old box was at the border of its leaf's bounds
inline constexpr std::uint8_t left_leaf = 2;   ///< the new box is not within the bounds that its leaf had

/// Moves boxes one after the other: writes the pairs of each box that begin and those that end, with all
/// others where the tree has them at its turn, then writes the new box to its slot, enlarges the bounds
/// around it, and writes to `calls_for` what the move calls for. Where the filter changed, all pairs that
/// overlap before or now go to `begun`. A box that is absent now leaves its lane without a box. Returns how
/// many pairs of boxes were compared, each leaf counted as full.
template <int D>
std::uint64_t follow(const WritableBvh<D>& tree, std::span<const MovedBox<D>> moved, std::uint8_t* calls_for,
                     PairSink& begun, PairSink& ended);

}  // namespace broadside::kernels

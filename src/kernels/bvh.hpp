// The node of a dynamic bounding volume hierarchy (an AABB tree), the views of one that kernels take, and
// what one node tells.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"

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

}  // namespace broadside::kernels

// QuadtreeNodes: the quadtree that stays from frame to frame. Nodes hold boxes, split and merge.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/grow.hpp"
#include "kernels/block_pool.hpp"

namespace broadside::algorithm {

/// Sentinel: "no child" or "no parent".
inline constexpr std::uint32_t no_node = 0xffffffffU;

/// A region and how it is split. The root's region is all of space, so no world is declared.
template <int D>
struct QuadtreeNode {
  std::array<float, D> low;    ///< no box in the node ends before this
  std::array<float, D> high;   ///< no box in the node begins here or later
  std::array<float, D> split;  ///< NaN on an axis that is not split
  std::array<float, D> large;  ///< a box this large on every axis stays here if it touches all children
  std::uint32_t parent = no_node;
  std::uint32_t children = no_node;  ///< the first of 2^D; no_node for a leaf
  std::uint32_t block = kernels::no_slot;
  std::uint32_t count = 0;     ///< boxes in the node itself
  std::uint32_t split_at = 0;  ///< an unsplittable leaf is tried again above this count
  std::uint32_t depth = 0;

  bool is_leaf() const { return children == no_node; }

  /// The children that a box touches, as bits.
  std::uint32_t touched(const Box<D>& box) const {
    constexpr std::array<std::uint32_t, 3> lower = {0x55, 0x33, 0x0f};
    constexpr std::array<std::uint32_t, 3> upper = {0xaa, 0xcc, 0xf0};
    std::uint32_t mask = (1U << (1U << D)) - 1;
    for (int axis = 0; axis < D; ++axis) {
      mask &= (!(box.min[axis] >= split[axis]) ? lower[axis] : 0U) |
              (box.max[axis] >= split[axis] ? upper[axis] : 0U);
    }
    return mask;
  }

  /// Whether a box that touches the children in `mask` stays in the node: it is large and touches them all.
  bool keeps(const Box<D>& box, std::uint32_t mask) const {
    bool all = true;
    for (int axis = 0; axis < D; ++axis) {
      if (!(split[axis] == split[axis])) continue;
      all &= box.max[axis] - box.min[axis] >= large[axis];
    }
    return all && mask == whole;
  }

  /// Whether a box lies within the node's region.
  bool contains(const Box<D>& box) const {
    bool inside = true;
    for (int axis = 0; axis < D; ++axis) inside &= box.min[axis] >= low[axis] && box.max[axis] < high[axis];
    return inside;
  }

  std::uint32_t whole = 0;  ///< the children that may hold boxes: on an unsplit axis, the lower ones
};

/// The first node that holds a box, in the order of a descent. A search for the box starts here.
struct QuadtreeHome {
  std::uint32_t node = no_node;
  std::uint32_t slot : 31 = 0;
  std::uint32_t several : 1 = 0;  ///< whether it may be in other nodes too, or is not in a leaf
};

/// The tree. A box is inserted into every leaf that it touches, as in the paper, unless it is so large that
/// it would be in many: see QuadtreeNode::keeps().
template <int D>
class QuadtreeNodes {
 public:
  static constexpr std::uint32_t root = 0;
  static constexpr std::uint32_t child_count = 1U << D;

  explicit QuadtreeNodes(std::uint32_t capacity) : capacity_(capacity) {}

  /// Builds the tree anew from all present boxes.
  void build(std::span<const Box<D>> boxes);

  /// Makes room for ids below `boxes`.
  void resize(std::size_t boxes) { homes_.resize(boxes); }

  const QuadtreeNode<D>& operator[](std::uint32_t node) const { return nodes_[node]; }
  QuadtreeHome& home(std::uint32_t id) { return homes_[id]; }

  /// A box's slot in a node, or no_slot.
  std::uint32_t find(std::uint32_t node, BoxId id) const;

  std::uint32_t insert(std::uint32_t node, const Box<D>& box, BoxId id);
  void erase(std::uint32_t node, std::uint32_t slot);
  kernels::BlockPool<D>& pool() { return pool_; }

  /// Splits leaves that have become too full since the last call, and merges nodes that have emptied.
  void tidy(std::span<const Box<D>> boxes);

  /// The number of boxes kept in inner nodes. While it is 0, searches can skip these nodes.
  std::size_t kept() const noexcept { return kept_; }
  std::size_t references() const noexcept { return references_; }
  std::size_t node_count() const noexcept { return nodes_.size() - child_count * free_.size(); }

  /// Whether the tree has become too deep, or its boxes are in too many nodes. Splitting respects
  /// max_references, but boxes that grow may exceed it.
  bool needs_rebuild() const noexcept { return is_too_deep_ || references_ > max_references * homes_.size(); }

  std::size_t bytes() const noexcept {
    return pool_.bytes() + core::bytes_of(nodes_, free_, homes_, grown_, shrunk_, ids_, masks_);
  }

 private:
  static constexpr std::size_t samples = 31;
  static constexpr std::uint32_t max_depth = 64;
  /// The maximum number of references per box that splitting may cause. Among the generated scenes, thin
  /// boxes in 3D have the most, 5. Long lines reach the maximum; a tree of bounds follows them faster.
  static constexpr std::size_t max_references = 6;

  using Sizes = std::array<std::size_t, child_count>;

  void fill(std::uint32_t node, std::size_t begin, std::span<const Box<D>> boxes);
  bool choose_split(QuadtreeNode<D>& node, std::span<const std::uint32_t> ids,
                    std::span<const Box<D>> boxes) const;
  bool partition(const QuadtreeNode<D>& node, std::size_t begin, std::span<const Box<D>> boxes, Sizes& sizes);
  void put(std::uint32_t node, std::uint32_t id, const Box<D>& box);
  std::uint32_t put_in_chain(std::uint32_t node, const Box<D>& box, BoxId id);
  std::uint32_t add_children(std::uint32_t parent);
  void drain(std::uint32_t node);

  void split(std::uint32_t node, std::span<const Box<D>> boxes) {
    ids_.clear();
    drain(node);
    std::sort(ids_.begin(), ids_.end());  // so that the result does not depend on the node's history
    fill(node, 0, boxes);
  }

  bool merge(std::uint32_t node, std::span<const Box<D>> boxes);

  std::uint32_t capacity_;
  std::vector<QuadtreeNode<D>> nodes_;
  std::vector<std::uint32_t> free_;  // the first child of each free group of siblings
  kernels::BlockPool<D> pool_;  // a node's boxes: a chain, in which a box keeps its slot until it is erased
  std::vector<QuadtreeHome> homes_;
  std::size_t references_ = 0;
  std::size_t kept_ = 0;
  bool is_too_deep_ = false;

  std::vector<std::uint32_t> grown_;   // leaves that may be too full
  std::vector<std::uint32_t> shrunk_;  // inner nodes whose children may have emptied
  std::vector<std::uint32_t> ids_;     // a stack of boxes still to be inserted, the current node's on top
  std::vector<std::uint8_t> masks_;    // for the boxes on top: the children that each touches, or 0
};

}  // namespace broadside::algorithm

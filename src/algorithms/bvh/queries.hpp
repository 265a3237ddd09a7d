// A tree of boxes to be searched, sixteen children to a node, that boxes can be put into and taken from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "algorithms/bvh/arrange.hpp"
#include "algorithms/bvh/tree.hpp"
#include "kernels/query_tree.hpp"

namespace broadside::own {

/// Packed by BoxTreePacker, and kept as an R-tree is: a box that leaves its leaf is put where bounds grow
/// least, full nodes are split, empty ones vanish. All leaves are equally deep.
template <int D>
class DynamicBoxTree {
 public:
  /// Starts over with these boxes, of which some may be absent; ids are places in the array.
  void build(std::span<const Box<D>> boxes);

  /// Moves a box, adds one, or takes it out by an absent one. Cost: a path from the root, a few times.
  void set(BoxId id, const Box<D>& box);

  /// Whether so many boxes were put in since it was built that to build it again pays.
  bool is_worn() const noexcept { return insertions_ > size_ / 2 + 1024; }

  /// How many boxes there are.
  std::size_t size() const noexcept { return size_; }

  /// For searches; only if there is a box.
  kernels::QueryTree<D> view() const noexcept { return {nodes_.data(), root_}; }

  /// How many children the node has: the places before that one.
  std::size_t child_count(std::uint32_t node) const noexcept {
    return info_[node & ~kernels::leaf_bit].count;
  }

  std::size_t bytes() const noexcept;

 private:
  static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

  struct NodeInfo {
    std::uint32_t up;  // the node above * node_width + place in it; none for the root
    std::uint8_t count;
    bool is_leaf;
  };

  using Child = NumberedBox<D>;  // a box or a node

  void add_leaves();
  void add_level();
  std::uint32_t new_node(bool is_leaf);
  std::uint32_t numbered(std::uint32_t node) const noexcept {
    return info_[node].is_leaf ? node | kernels::leaf_bit : node;
  }
  Box<D> box_at(std::uint32_t place) const noexcept;
  void write(std::uint32_t place, const Box<D>& box) noexcept;
  void write_child(std::uint32_t node, std::size_t at, const Child& child) noexcept;
  void clear_from(std::uint32_t node, std::size_t count) noexcept;
  void insert(const Child& child);
  void add_child(std::uint32_t node, const Child& child);
  void split(std::uint32_t node, const Child& added);
  void remove_at(std::uint32_t place);
  void refit(std::uint32_t node);

  BoxTreePacker<D> packer_;
  // While it is built: the boxes and their ids, and what the next level's nodes hold.
  std::vector<Box<D>> packed_;
  std::vector<std::uint32_t> names_;
  std::vector<Child> children_;
  std::vector<kernels::QueryNode<D>> nodes_;
  std::vector<NodeInfo> info_;
  std::vector<std::uint32_t> free_;    // nodes
  std::vector<std::uint32_t> places_;  // by id: node * node_width + place in it; none
  std::uint32_t root_ = none;
  std::size_t size_ = 0;
  std::size_t insertions_ = 0;  // since it was built
};

}  // namespace broadside::own

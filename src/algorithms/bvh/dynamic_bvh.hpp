// DynamicBvh: the dynamic bounding volume hierarchy of BvhFollower and BoxIndex. Sixteen children per node.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "algorithms/bvh/box_order.hpp"
#include "algorithms/bvh/bvh_packer.hpp"
#include "core/grow.hpp"
#include "core/large_array.hpp"
#include "kernels/bvh.hpp"

namespace broadside::algorithm {

/// Packed by BvhPacker, and maintained as an R-tree: set() inserts a box that leaves its leaf where bounds
/// grow least, full nodes are split, empty ones vanish. All leaves are equally deep.
template <int D>
class DynamicBvh {
 public:
  /// Starts over with these boxes. Some may be absent; ids are places in the array.
  void build(std::span<const Box<D>> boxes, const Workers& workers = {});

  /// Moves or inserts a box, or removes it if `box` is absent. Cost: a few walks along a path from the root.
  void set(BoxId id, const Box<D>& box);

  /// The parts of set(), for a caller that moves many boxes between them.
  void insert(BoxId id, const Box<D>& box);

  void remove(BoxId id) {
    const std::uint32_t at = std::exchange(slots_[index(id)], kernels::no_slot);
    --size_;
    remove_at(at);
  }

  /// Makes the bounds around a box exact again, after follow() enlarged them.
  void refit(BoxId id) { refit_above(slot(id) / kernels::fan_out); }

  /// Moves a box that is there, but not the bounds around it: refit_all() must follow.
  void overwrite(BoxId id, const Box<D>& box) noexcept {
    ++boxes_taken_;
    write(slot(id), box);
  }

  /// Makes all bounds exact. Returns the expected number of nodes that a search for a random point visits,
  /// over that number after build().
  double refit_all();

  /// Removes a box and inserts it where bounds grow least.
  void reinsert(BoxId id) {
    const Box<D> box = box_at(slot(id));
    remove(id);
    insert(id, box);
  }

  /// Where the box is: node * fan_out + lane, or no_slot. Insertions and removals change it.
  std::uint32_t slot(BoxId id) const noexcept {
    return index(id) < slots_.size() ? slots_[index(id)] : kernels::no_slot;
  }

  /// Whether a rebuild pays after the insertions since the last build. A build also reads absent boxes.
  bool needs_rebuild() const noexcept { return insertions_ > size_ / 2 + slots_.size() / 64 + 1024; }

  /// The ids of all boxes, leaf by leaf: after build() in the packer's order, in which neighbours in space
  /// follow one another.
  std::vector<std::uint32_t> ids_by_leaf() const;

  /// The number of boxes, and of nodes.
  std::size_t size() const noexcept { return size_; }
  std::size_t nodes() const noexcept { return nodes_.size() - free_.size(); }

  /// The box in a slot.
  Box<D> box_at(std::uint32_t slot) const noexcept {
    return nodes_[slot / kernels::fan_out].box(slot % kernels::fan_out);
  }

  /// Nodes have numbers below this one; a free node is a leaf or not, without children.
  std::size_t node_numbers() const noexcept { return nodes_.size(); }
  bool is_leaf(std::uint32_t node) const noexcept { return info_[node].is_leaf; }
  const kernels::Block<D>& root() const noexcept { return nodes_[root_ & ~kernels::leaf_bit]; }

  /// The tree for searches. There must be a box.
  kernels::BvhView<D> view() const noexcept { return {nodes_.data(), root_}; }

  /// The tree for kernels::follow(). Valid until the next insertion.
  kernels::WritableBvh<D> writable() {
    for (std::vector<std::uint32_t>& list : lists_) {
      if (list.size() < nodes_.size() + 2 * kernels::fan_out)
        list.resize(nodes_.capacity() + 2 * kernels::fan_out);
    }
    return {nodes_.data(), info_.data(), root_, {lists_[0].data(), lists_[1].data()}};
  }

  /// The number of a node's children, which are in its first lanes.
  std::size_t child_count(std::uint32_t node) const noexcept {
    return info_[node & ~kernels::leaf_bit].count;
  }

  std::size_t bytes() const noexcept {
    return packer_.bytes() +
           core::bytes_of(packed_, ids_, children_, nodes_, info_, free_, slots_, lists_, levels_);
  }

  /// How many boxes build(), set() and overwrite() have taken so far. Tests measure this instead of time.
  std::uint64_t boxes_taken() const noexcept { return boxes_taken_; }

 private:
  using Child = NumberedBox<D>;  // a box or a node

  void add_leaves();
  void add_level();
  std::uint32_t new_node(bool is_leaf);
  std::uint32_t numbered(std::uint32_t node) const noexcept {
    return info_[node].is_leaf ? node | kernels::leaf_bit : node;
  }
  void write(std::uint32_t slot, const Box<D>& box) noexcept {
    nodes_[slot / kernels::fan_out].set(slot % kernels::fan_out, box);
  }
  void write_child(std::uint32_t node, std::size_t lane, const Child& child) noexcept;

  /// Empties the lanes from `count` on.
  void clear_from(std::uint32_t node, std::size_t count) noexcept {
    for (std::size_t lane = count; lane < kernels::fan_out; ++lane) {
      nodes_[node].set(lane, kernels::nan_box<D>());
      nodes_[node].id[lane] = 0;
    }
  }

  void add_child(std::uint32_t node, const Child& child) {
    if (info_[node].count == kernels::fan_out) return split(node, child);
    write_child(node, info_[node].count++, child);
  }

  void split(std::uint32_t node, const Child& added);
  void remove_at(std::uint32_t slot);
  void refit_above(std::uint32_t node);
  Box<D> refit_below(std::uint32_t number, std::size_t depth);

  /// Of the inner nodes of a level: the expected numbers of children that contain a random point, added up.
  struct Level {
    double children = 0;
    std::size_t nodes = 0;
  };
  double visits() const noexcept;

  BvhPacker<D> packer_;
  core::Parallel parallel_;
  // For building: the boxes, their ids, and the children of the next level's nodes.
  core::LargeArray<Box<D>> packed_;
  core::LargeArray<std::uint32_t> ids_;
  std::vector<Child> children_;

  core::LargeArray<kernels::Block<D>> nodes_;
  std::vector<kernels::BvhNodeInfo> info_;
  std::vector<std::uint32_t> free_;        // nodes
  core::LargeArray<std::uint32_t> slots_;  // by id
  std::vector<Level> levels_;              // the root's first, as of the last build() or refit_all()
  double built_visits_ = 1;
  std::uint32_t root_ = kernels::no_slot;
  std::size_t size_ = 0;
  std::size_t insertions_ = 0;  // since the last build
  std::uint64_t boxes_taken_ = 0;
  std::array<std::vector<std::uint32_t>, 2> lists_;
};

}  // namespace broadside::algorithm

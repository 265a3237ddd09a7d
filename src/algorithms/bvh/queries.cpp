// A tree of boxes to be searched, sixteen children to a node, that boxes can be put into and taken from.
//
// Kept in shape as A. Guttman's "R-trees: a dynamic index structure for spatial searching" (SIGMOD 1984) is,
// measured by sums of extents as in N. Beckmann et al., "The R*-tree" (SIGMOD 1990), so that boxes without
// area or with infinite extents are compared as well.
#include "algorithms/bvh/queries.hpp"

#include <algorithm>

#include "interface/encloses.hpp"

namespace broadside::own {

using kernels::leaf_bit;
using kernels::node_width;

namespace {

/// Whether bounds that `box` was in may be smaller without it.
template <int D>
bool touches_border(const Box<D>& bounds, const Box<D>& box) {
  bool touches = false;
  for (int axis = 0; axis < D; ++axis)
    touches |= bounds.min[axis] == box.min[axis] || bounds.max[axis] == box.max[axis];
  return touches;
}

template <int D>
Box<D> united(const Box<D>& a, const Box<D>& b) {
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = std::min(a.min[axis], b.min[axis]);
    box.max[axis] = std::max(a.max[axis], b.max[axis]);
  }
  return box;
}

}  // namespace

template <int D>
void DynamicBoxTree<D>::build(std::span<const Box<D>> boxes) {
  nodes_.clear();
  info_.clear();
  free_.clear();
  places_.assign(boxes.size(), none);
  root_ = none;
  insertions_ = 0;
  packed_.clear();
  names_.clear();
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!is_present(boxes[i])) continue;
    packed_.push_back(boxes[i]);
    names_.push_back(static_cast<std::uint32_t>(i));
  }
  size_ = packed_.size();
  if (size_ == 0) return;
  // With room for what splits add until the tree is worn.
  const std::size_t leaves = size_ / node_width;
  nodes_.reserve(leaves + leaves / 3 + 16);
  info_.reserve(nodes_.capacity());
  add_leaves();
  arrange<D>(children_);
  while (children_.size() > 1) add_level();
  root_ = children_.front().number;
}

/// Puts the boxes into leaves as they are packed.
template <int D>
void DynamicBoxTree<D>::add_leaves() {
  packer_.pack(packed_);
  const kernels::TreeLevel<D>& packed = packer_.tree().levels[0];
  children_.clear();
  for (std::size_t begin = 0; begin < packed.size; begin += node_width) {
    const std::uint32_t leaf = new_node(true);
    std::size_t count = 0;
    for (std::size_t at = begin; at < std::min(begin + node_width, packed.size); ++at) {
      if (!(packed.min[0][at] <= packed.max[0][at])) continue;  // no box
      const std::size_t i = index(packer_.tree().id[at]);
      write_child(leaf, count++, {packed_[i], names_[i]});
    }
    info_[leaf].count = static_cast<std::uint8_t>(count);
    children_.push_back({kernels::bounds_of(nodes_[leaf]), numbered(leaf)});
  }
}

/// Puts each sixteen of children_ into a node; these are then the children.
template <int D>
void DynamicBoxTree<D>::add_level() {
  std::size_t to = 0;
  for (std::size_t begin = 0; begin < children_.size(); begin += node_width) {
    const std::uint32_t node = new_node(false);
    const std::size_t count = std::min(node_width, children_.size() - begin);
    for (std::size_t i = 0; i < count; ++i) write_child(node, i, children_[begin + i]);
    info_[node].count = static_cast<std::uint8_t>(count);
    children_[to++] = {kernels::bounds_of(nodes_[node]), numbered(node)};
  }
  children_.resize(to);
}

template <int D>
void DynamicBoxTree<D>::set(BoxId id, const Box<D>& box) {
  if (index(id) >= places_.size()) places_.resize(index(id) + 1, none);
  const std::uint32_t place = places_[index(id)];
  const bool is_there = is_present(box);
  if (place == none) {
    if (is_there) insert({box, index(id)});
    return;
  }
  const std::uint32_t node = place / node_width;
  const std::uint32_t up = info_[node].up;
  if (is_there && up == none) return write(place, box);
  if (is_there) {
    const Box<D> bounds = box_at(up);
    if (core::encloses(bounds, box)) {
      const bool may_shrink = touches_border(bounds, box_at(place));
      write(place, box);
      if (may_shrink) refit(node);
      return;
    }
  }
  places_[index(id)] = none;
  --size_;
  remove_at(place);
  if (is_there) insert({box, index(id)});
}

template <int D>
void DynamicBoxTree<D>::insert(const Child& child) {
  ++size_;
  ++insertions_;
  if (root_ == none) root_ = new_node(true) | leaf_bit;
  std::uint32_t number = root_;
  while ((number & leaf_bit) == 0) {
    const std::size_t best = kernels::best_child(nodes_[number], info_[number].count, child.box);
    const auto place = static_cast<std::uint32_t>(number * node_width + best);
    write(place, united(box_at(place), child.box));
    number = nodes_[number].child[best];
  }
  add_child(number & ~leaf_bit, child);
}

template <int D>
void DynamicBoxTree<D>::add_child(std::uint32_t node, const Child& child) {
  if (info_[node].count == node_width) return split(node, child);
  write_child(node, info_[node].count++, child);
}

/// Adds a child to a full node: those that lie on one side of the axis along which they differ most remain,
/// the others go into a new node beside it.
template <int D>
void DynamicBoxTree<D>::split(std::uint32_t node, const Child& added) {
  std::array<Child, node_width + 1> children;
  for (std::uint32_t i = 0; i < node_width; ++i)
    children[i] = {box_at(node * node_width + i), nodes_[node].child[i]};
  children.back() = added;
  std::ranges::sort(children, BeforeAlong<D>{widest_axis<D>(children)});

  const std::uint32_t other = new_node(info_[node].is_leaf);
  constexpr std::size_t half = node_width / 2;
  for (std::size_t i = 0; i < children.size(); ++i) {
    if (i < half)
      write_child(node, i, children[i]);
    else
      write_child(other, i - half, children[i]);
  }
  info_[node].count = half;
  info_[other].count = static_cast<std::uint8_t>(children.size() - half);
  clear_from(node, half);

  if (info_[node].up == none) {
    const std::uint32_t root = new_node(false);
    write_child(root, 0, {kernels::bounds_of(nodes_[node]), numbered(node)});
    info_[root].count = 1;
    root_ = root;
  } else {
    write(info_[node].up, kernels::bounds_of(nodes_[node]));
  }
  add_child(info_[node].up / node_width, {kernels::bounds_of(nodes_[other]), numbered(other)});
}

/// Takes a child out, and nodes that become empty.
template <int D>
void DynamicBoxTree<D>::remove_at(std::uint32_t place) {
  const std::uint32_t node = place / node_width;
  const std::size_t last = --info_[node].count;
  if (place % node_width != last) {
    const auto from = static_cast<std::uint32_t>(node * node_width + last);
    write_child(node, place % node_width, {box_at(from), nodes_[node].child[last]});
  }
  clear_from(node, last);
  if (last == 0) {
    free_.push_back(node);
    if (info_[node].up == none)
      root_ = none;
    else
      remove_at(info_[node].up);
    return;
  }
  if (last == 1 && info_[node].up == none && !info_[node].is_leaf) {
    root_ = nodes_[node].child[0];
    info_[root_ & ~leaf_bit].up = none;
    free_.push_back(node);
    return;
  }
  refit(node);
}

/// Sets the bounds of a node whose children changed, and of those above it.
template <int D>
void DynamicBoxTree<D>::refit(std::uint32_t node) {
  for (std::uint32_t up = info_[node].up; up != none; up = info_[up / node_width].up) {
    const Box<D> bounds = kernels::bounds_of(nodes_[node]);
    if (bounds == box_at(up)) return;
    write(up, bounds);
    node = up / node_width;
  }
}

template <int D>
std::uint32_t DynamicBoxTree<D>::new_node(bool is_leaf) {
  std::uint32_t node;
  if (free_.empty()) {
    node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    info_.emplace_back();
  } else {
    node = free_.back();
    free_.pop_back();
  }
  info_[node] = {none, 0, is_leaf};
  clear_from(node, 0);
  return node;
}

template <int D>
Box<D> DynamicBoxTree<D>::box_at(std::uint32_t place) const noexcept {
  const kernels::QueryNode<D>& node = nodes_[place / node_width];
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = node.min[axis][place % node_width];
    box.max[axis] = node.max[axis][place % node_width];
  }
  return box;
}

template <int D>
void DynamicBoxTree<D>::write(std::uint32_t place, const Box<D>& box) noexcept {
  kernels::QueryNode<D>& node = nodes_[place / node_width];
  for (int axis = 0; axis < D; ++axis) {
    node.min[axis][place % node_width] = box.min[axis];
    node.max[axis][place % node_width] = box.max[axis];
  }
}

/// Writes a child and tells it where it is.
template <int D>
void DynamicBoxTree<D>::write_child(std::uint32_t node, std::size_t at, const Child& child) noexcept {
  const auto place = static_cast<std::uint32_t>(node * node_width + at);
  write(place, child.box);
  nodes_[node].child[at] = child.number;
  if (info_[node].is_leaf)
    places_[child.number] = place;
  else
    info_[child.number & ~leaf_bit].up = place;
}

/// Empties the places from `count` on: NaN is what nothing meets.
template <int D>
void DynamicBoxTree<D>::clear_from(std::uint32_t node, std::size_t count) noexcept {
  constexpr float nothing = std::numeric_limits<float>::quiet_NaN();
  for (int axis = 0; axis < D; ++axis) {
    std::fill(nodes_[node].min[axis].begin() + count, nodes_[node].min[axis].end(), nothing);
    std::fill(nodes_[node].max[axis].begin() + count, nodes_[node].max[axis].end(), nothing);
  }
  std::fill(nodes_[node].child.begin() + count, nodes_[node].child.end(), 0);
}

template <int D>
std::size_t DynamicBoxTree<D>::bytes() const noexcept {
  const auto held = [](const auto& memory) { return memory.capacity() * sizeof(memory[0]); };
  return packer_.bytes() + held(packed_) + held(names_) + held(children_) + held(nodes_) + held(info_) +
         held(free_) + held(places_);
}

template class DynamicBoxTree<2>;
template class DynamicBoxTree<3>;

}  // namespace broadside::own

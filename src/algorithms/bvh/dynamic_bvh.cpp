// The dynamic bounding volume hierarchy of BvhFollower and BoxIndex.
//
// Maintained as an R-tree (A. Guttman, "R-trees: a dynamic index structure for spatial searching", SIGMOD
// 1984). Bounds are measured by the sum of their extents (N. Beckmann et al., "The R*-tree", SIGMOD 1990),
// not by a surface area heuristic (SAH), so that boxes without area or with infinite extents are compared as
// well.
#include "algorithms/bvh/dynamic_bvh.hpp"

#include <algorithm>

namespace broadside::algorithm {

using kernels::fan_out;
using kernels::leaf_bit;
using kernels::no_slot;

namespace {

/// Whether bounds that contain `box` may shrink without it.
template <int D>
bool touches_border(const Box<D>& bounds, const Box<D>& box) {
  bool touches = false;
  for (int axis = 0; axis < D; ++axis)
    touches |= bounds.min[axis] == box.min[axis] || bounds.max[axis] == box.max[axis];
  return touches;
}

/// The expected number of a node's children that contain a random point of the node's bounds. It is the same
/// at every scale and place.
template <int D>
double children_at_a_point(const kernels::Block<D>& node, std::size_t count, const Box<D>& bounds) {
  double sum = 0;
  for (std::size_t lane = 0; lane < count; ++lane) {
    const Box<D> child = node.box(lane);
    float share = 1;
    for (int axis = 0; axis < D; ++axis) {
      const float extent = child.max[axis] - child.min[axis];
      const float whole = bounds.max[axis] - bounds.min[axis];
      if (extent < whole) share *= extent / whole;  // equal extents may both be 0, or both infinite
    }
    sum += static_cast<double>(share);
  }
  return sum;
}

}  // namespace

template <int D>
void DynamicBvh<D>::build(std::span<const Box<D>> boxes, const Workers& workers) {
  parallel_.start(workers, boxes.size());
  boxes_taken_ += boxes.size();
  nodes_.clear();
  info_.clear();
  free_.clear();
  slots_.assign(boxes.size(), no_slot);
  root_ = no_slot;
  insertions_ = 0;
  levels_.clear();
  built_visits_ = 1;
  packed_.clear();
  packed_.reserve(boxes.size());
  ids_.clear();
  ids_.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Box<D> box = boxes[i];  // a copy, since another thread may change the caller's
    if (!is_present(box)) continue;
    packed_.push_back(box);
    ids_.push_back(static_cast<std::uint32_t>(i));
  }
  size_ = packed_.size();
  if (size_ == 0) return;
  // With room for the nodes that splits add until the next build.
  const std::size_t leaves = size_ / fan_out;
  nodes_.reserve(leaves + leaves / 3 + 16);
  info_.reserve(nodes_.capacity());
  add_leaves();
  arrange<D>(children_);
  while (children_.size() > 1) add_level();
  root_ = children_.front().number;
  std::reverse(levels_.begin(), levels_.end());
  built_visits_ = visits();
}

template <int D>
std::vector<std::uint32_t> DynamicBvh<D>::ids_by_leaf() const {
  std::vector<std::uint32_t> ids;
  ids.reserve(size_);
  for (std::size_t node = 0; node < nodes_.size(); ++node) {
    if (!info_[node].is_leaf) continue;
    const auto& children = nodes_[node].id;
    ids.insert(ids.end(), children.begin(), children.begin() + info_[node].count);
  }
  return ids;
}

/// Puts the boxes into leaves, in the packer's order.
template <int D>
void DynamicBvh<D>::add_leaves() {
  packer_.pack(packed_, parallel_);
  const kernels::TreeLevel<D>& packed = packer_.tree().levels[0];
  children_.clear();
  for (std::size_t begin = 0; begin < packed.size; begin += fan_out) {
    const std::uint32_t leaf = new_node(true);
    std::size_t count = 0;
    for (std::size_t at = begin; at < std::min(begin + fan_out, packed.size); ++at) {
      if (!(packed.min[0][at] <= packed.max[0][at])) continue;  // no box
      const std::size_t i = index(packer_.tree().id[at]);
      write_child(leaf, count++, {packed_[i], ids_[i]});
    }
    info_[leaf].count = static_cast<std::uint8_t>(count);
    children_.push_back({kernels::bounds_of(nodes_[leaf]), numbered(leaf)});
  }
}

/// Puts each sixteen of children_ into a node. The nodes are the new children_.
template <int D>
void DynamicBvh<D>::add_level() {
  std::size_t to = 0;
  Level level;
  for (std::size_t begin = 0; begin < children_.size(); begin += fan_out) {
    const std::uint32_t node = new_node(false);
    const std::size_t count = std::min(fan_out, children_.size() - begin);
    for (std::size_t i = 0; i < count; ++i) write_child(node, i, children_[begin + i]);
    info_[node].count = static_cast<std::uint8_t>(count);
    children_[to++] = {kernels::bounds_of(nodes_[node]), numbered(node)};
    level.children += children_at_a_point(nodes_[node], count, children_[to - 1].box);
    ++level.nodes;
  }
  levels_.push_back(level);
  children_.resize(to);
}

template <int D>
void DynamicBvh<D>::set(BoxId id, const Box<D>& box) {
  ++boxes_taken_;
  const std::uint32_t at = slot(id);
  const bool is_there = is_present(box);
  if (at == no_slot) {
    if (is_there) insert(id, box);
    return;
  }
  if (is_there) {
    const std::uint32_t node = at / fan_out;
    const std::uint32_t parent = info_[node].parent;
    if (parent == no_slot) return write(at, box);
    const Box<D> bounds = box_at(parent);
    if (contains(bounds, box)) {
      const bool may_shrink = touches_border(bounds, box_at(at));
      write(at, box);
      if (may_shrink) refit_above(node);
      return;
    }
  }
  remove(id);
  if (is_there) insert(id, box);
}

template <int D>
void DynamicBvh<D>::insert(BoxId id, const Box<D>& box) {
  if (index(id) >= slots_.size()) slots_.resize(index(id) + 1, no_slot);
  ++size_;
  ++insertions_;
  if (root_ == no_slot) root_ = new_node(true) | leaf_bit;
  std::uint32_t number = root_;
  while ((number & leaf_bit) == 0) {
    const std::size_t best = kernels::best_child(nodes_[number], info_[number].count, box);
    const auto into = static_cast<std::uint32_t>(number * fan_out + best);
    write(into, merged(box_at(into), box));
    number = nodes_[number].id[best];
  }
  add_child(number & ~leaf_bit, {box, index(id)});
}

/// Adds a child to a full node by splitting it: sorts the children along the axis on which their centres are
/// spread most widely, keeps the first half and moves the others to a new sibling.
template <int D>
void DynamicBvh<D>::split(std::uint32_t node, const Child& added) {
  std::array<Child, fan_out + 1> children;
  const auto first = static_cast<std::uint32_t>(node * fan_out);
  for (std::uint32_t i = 0; i < fan_out; ++i) children[i] = {box_at(first + i), nodes_[node].id[i]};
  children.back() = added;
  std::sort(children.begin(), children.end(), BeforeAlong<D>{widest_axis<D>(children)});

  const std::uint32_t other = new_node(info_[node].is_leaf);
  constexpr std::size_t half = fan_out / 2;
  for (std::size_t i = 0; i < children.size(); ++i) {
    if (i < half)
      write_child(node, i, children[i]);
    else
      write_child(other, i - half, children[i]);
  }
  info_[node].count = half;
  info_[other].count = static_cast<std::uint8_t>(children.size() - half);
  clear_from(node, half);

  if (info_[node].parent == no_slot) {
    const std::uint32_t root = new_node(false);
    write_child(root, 0, {kernels::bounds_of(nodes_[node]), numbered(node)});
    info_[root].count = 1;
    root_ = root;
  } else {
    write(info_[node].parent, kernels::bounds_of(nodes_[node]));
  }
  add_child(info_[node].parent / fan_out, {kernels::bounds_of(nodes_[other]), numbered(other)});
}

/// Removes a child, and nodes that become empty.
template <int D>
void DynamicBvh<D>::remove_at(std::uint32_t slot) {
  const std::uint32_t node = slot / fan_out;
  const std::size_t last = --info_[node].count;
  if (slot % fan_out != last) {
    const auto from = static_cast<std::uint32_t>(node * fan_out + last);
    write_child(node, slot % fan_out, {box_at(from), nodes_[node].id[last]});
  }
  clear_from(node, last);
  if (last == 0) {
    free_.push_back(node);
    if (info_[node].parent == no_slot)
      root_ = no_slot;
    else
      remove_at(info_[node].parent);
    return;
  }
  if (last == 1 && info_[node].parent == no_slot && !info_[node].is_leaf) {
    root_ = nodes_[node].id[0];
    info_[root_ & ~leaf_bit].parent = no_slot;
    free_.push_back(node);
    return;
  }
  refit_above(node);
}

/// Sets the bounds of a node whose children changed, and of its ancestors.
template <int D>
void DynamicBvh<D>::refit_above(std::uint32_t node) {
  for (std::uint32_t up = info_[node].parent; up != no_slot; up = info_[up / fan_out].parent) {
    const Box<D> bounds = kernels::bounds_of(nodes_[node]);
    if (bounds == box_at(up)) return;
    write(up, bounds);
    node = up / fan_out;
  }
}

template <int D>
double DynamicBvh<D>::refit_all() {
  std::fill(levels_.begin(), levels_.end(), Level{});
  if (root_ != no_slot) refit_below(root_, 0);
  return visits() / built_visits_;
}

/// Sets the bounds of the children of a node and of all nodes below. Returns the node's own bounds. `depth`:
/// 0 for the root.
template <int D>
Box<D> DynamicBvh<D>::refit_below(std::uint32_t number, std::size_t depth) {
  const std::uint32_t node = number & ~leaf_bit;
  if (node != number) return kernels::bounds_of(nodes_[node]);
  const std::size_t count = info_[node].count;
  for (std::size_t lane = 0; lane < count; ++lane)
    write(static_cast<std::uint32_t>(node * fan_out + lane), refit_below(nodes_[node].id[lane], depth + 1));
  const Box<D> bounds = kernels::bounds_of(nodes_[node]);
  if (levels_.size() <= depth) levels_.resize(depth + 1);
  levels_[depth].children += children_at_a_point(nodes_[node], count, bounds);
  ++levels_[depth].nodes;
  return bounds;
}

/// The expected number of nodes that a search for a random point visits.
template <int D>
double DynamicBvh<D>::visits() const noexcept {
  double all = 1;
  double of_level = 1;
  for (const Level& level : levels_) {
    if (level.nodes == 0) break;
    of_level *= level.children / static_cast<double>(level.nodes);
    all += of_level;
  }
  return all;
}

template <int D>
std::uint32_t DynamicBvh<D>::new_node(bool is_leaf) {
  std::uint32_t node;
  if (free_.empty()) {
    node = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    info_.emplace_back();
  } else {
    node = free_.back();
    free_.pop_back();
  }
  info_[node] = {no_slot, 0, is_leaf};
  clear_from(node, 0);
  return node;
}

/// Writes a child, and notes where it is.
template <int D>
void DynamicBvh<D>::write_child(std::uint32_t node, std::size_t lane, const Child& child) noexcept {
  const auto slot = static_cast<std::uint32_t>(node * fan_out + lane);
  write(slot, child.box);
  nodes_[node].id[lane] = child.number;
  if (info_[node].is_leaf)
    slots_[child.number] = slot;
  else
    info_[child.number & ~leaf_bit].parent = slot;
}

template class DynamicBvh<2>;
template class DynamicBvh<3>;

}  // namespace broadside::algorithm

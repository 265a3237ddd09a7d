// Builds, splits and merges the nodes. Section V of the paper; as in the searcher, nodes are split at
// medians, so clusters and outliers do not deepen the tree.
#include "algorithms/quadtree/quadtree_nodes.hpp"

#include <limits>

namespace broadside::algorithm {

using kernels::block_size;
using kernels::no_slot;

template <int D>
void QuadtreeNodes<D>::build(std::span<const Box<D>> boxes) {
  pool_.clear();
  nodes_.clear();
  free_.clear();
  grown_.clear();
  shrunk_.clear();
  references_ = kept_ = 0;
  is_too_deep_ = false;
  homes_.assign(boxes.size(), {});
  QuadtreeNode<D> whole{};
  whole.low.fill(-std::numeric_limits<float>::infinity());
  whole.high.fill(std::numeric_limits<float>::infinity());
  nodes_.push_back(whole);
  ids_.clear();
  for (std::uint32_t id = 0; id < boxes.size(); ++id) {
    if (is_present(boxes[id])) ids_.push_back(id);
  }
  fill(root, 0, boxes);
}

template <int D>
std::uint32_t QuadtreeNodes<D>::insert(std::uint32_t node, const Box<D>& box, BoxId id) {
  QuadtreeNode<D>& to = nodes_[node];
  ++to.count;
  ++references_;
  if (!to.is_leaf())
    ++kept_;
  else if (to.count > std::max(capacity_, to.split_at))
    grown_.push_back(node);
  return put_in_chain(node, box, id);
}

/// Puts a box into the first free slot of a node's chain.
template <int D>
std::uint32_t QuadtreeNodes<D>::put_in_chain(std::uint32_t node, const Box<D>& box, BoxId id) {
  std::uint32_t& first = nodes_[node].block;
  std::uint32_t block = first;
  while (block != no_slot && pool_.is_full(block)) block = pool_.head(block).next;
  if (block == no_slot) {
    pool_.add_block(first, node);
    block = first;
  }
  return pool_.insert(block, box, id);
}

template <int D>
std::uint32_t QuadtreeNodes<D>::find(std::uint32_t node, BoxId id) const {
  const kernels::BlocksView<D> view = pool_.view();
  for (std::uint32_t block = nodes_[node].block; block != no_slot; block = view.heads[block].next) {
    std::uint32_t found = 0;
    for (std::uint32_t lane = 0; lane < block_size; ++lane)
      found |= static_cast<std::uint32_t>(view.blocks[block].id[lane] == index(id)) << lane;
    found &= view.heads[block].used;
    if (found != 0) return pool_.slot(block, found);
  }
  return no_slot;
}

template <int D>
void QuadtreeNodes<D>::erase(std::uint32_t node, std::uint32_t slot) {
  QuadtreeNode<D>& from = nodes_[node];
  --from.count;
  --references_;
  pool_.erase(slot);
  if (pool_.head(slot / block_size).used == 0) pool_.remove_block(from.block, slot / block_size);
  if (!from.is_leaf())
    --kept_;
  else if (from.parent != no_node && from.count <= capacity_ / child_count)
    shrunk_.push_back(from.parent);
}

template <int D>
void QuadtreeNodes<D>::tidy(std::span<const Box<D>> boxes) {
  for (const std::uint32_t node : grown_) {
    if (nodes_[node].is_leaf() && nodes_[node].count > std::max(capacity_, nodes_[node].split_at))
      split(node, boxes);
  }
  grown_.clear();
  for (std::size_t i = 0; i < shrunk_.size(); ++i) {
    const std::uint32_t node = shrunk_[i];
    if (merge(node, boxes) && nodes_[node].parent != no_node) shrunk_.push_back(nodes_[node].parent);
  }
  shrunk_.clear();
}

/// Moves the boxes of ids_ from `begin` on into an empty leaf, and splits it if they are too many.
template <int D>
void QuadtreeNodes<D>::fill(std::uint32_t node, std::size_t begin, std::span<const Box<D>> boxes) {
  const std::size_t count = ids_.size() - begin;
  Sizes sizes;
  QuadtreeNode<D> split = nodes_[node];
  if (count <= capacity_ || !choose_split(split, std::span(ids_).subspan(begin), boxes) ||
      !partition(split, begin, boxes, sizes)) {
    nodes_[node].split_at = static_cast<std::uint32_t>(count > capacity_ ? count + count / 2 : 0);
    for (std::size_t i = begin; i < ids_.size(); ++i) put(node, ids_[i], boxes[ids_[i]]);
    ids_.resize(begin);
    return;
  }
  nodes_[node].split = split.split;
  nodes_[node].large = split.large;
  nodes_[node].whole = split.whole;
  const std::uint32_t children = add_children(node);
  nodes_[node].children = children;
  // The children's boxes go on top of the node's. The first child's come last, since it is filled first.
  std::array<std::size_t, child_count> next;
  std::size_t top = ids_.size();
  for (std::uint32_t child = child_count; child-- > 0; top += sizes[child]) next[child] = top;
  const std::array<std::size_t, child_count> firsts = next;
  ids_.resize(top);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t id = ids_[begin + i];
    if (masks_[i] == 0) put(node, id, boxes[id]);
    for (std::uint32_t mask = masks_[i], child = 0; mask != 0; mask >>= 1, ++child) {
      if ((mask & 1U) != 0) ids_[next[child]++] = id;
    }
  }
  for (std::uint32_t child = 0; child < child_count; ++child) fill(children + child, firsts[child], boxes);
  ids_.resize(begin);
}

/// Chooses where to split a node. False if no axis would separate its boxes, or at the maximum depth.
template <int D>
bool QuadtreeNodes<D>::choose_split(QuadtreeNode<D>& node, std::span<const std::uint32_t> ids,
                                    std::span<const Box<D>> boxes) const {
  bool splits = false;
  node.whole = (1U << child_count) - 1;
  std::array<float, samples> minima;
  for (int axis = 0; axis < D; ++axis) {
    const auto sample = [&](std::size_t i) -> const Box<D>& {
      return boxes[ids[(2 * i + 1) * ids.size() / (2 * samples)]];
    };
    // A split must lie in the node's region, or the children's regions would not.
    for (std::size_t i = 0; i < samples; ++i) minima[i] = std::max(sample(i).min[axis], node.low[axis]);
    std::sort(minima.begin(), minima.end());
    const float at = minima[samples / 2];
    std::size_t crossing = 0;
    for (std::size_t i = 0; i < samples; ++i)
      crossing += static_cast<std::size_t>(sample(i).min[axis] < at && sample(i).max[axis] >= at);
    node.split[axis] = std::numeric_limits<float>::quiet_NaN();
    node.large[axis] = 0;
    if (minima.front() == at || crossing > samples / 3) {
      constexpr std::array<std::uint32_t, 3> lower = {0x55, 0x33, 0x0f};
      node.whole &= lower[axis];
      continue;
    }
    node.split[axis] = at;
    node.large[axis] = minima[samples - 1 - samples / 4] - minima[samples / 4];
    splits = true;
  }
  return splits && node.depth < max_depth;
}

/// Sets masks_ to the children that each box of ids_ from `begin` on touches (0 if it stays), and `sizes` to
/// the boxes per child. False if splitting would not separate the boxes or would make too many references.
template <int D>
bool QuadtreeNodes<D>::partition(const QuadtreeNode<D>& node, std::size_t begin,
                                 std::span<const Box<D>> boxes, Sizes& sizes) {
  const std::size_t count = ids_.size() - begin;
  masks_.resize(std::max(masks_.size(), count));
  sizes.fill(0);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Box<D>& box = boxes[ids_[begin + i]];
    std::uint32_t mask = node.touched(box);
    if (node.keeps(box, mask)) mask = 0;
    masks_[i] = static_cast<std::uint8_t>(mask);
    kept += static_cast<std::size_t>(mask == 0);
    for (std::uint32_t child = 0; mask != 0; mask >>= 1, ++child) sizes[child] += mask & 1U;
  }
  std::size_t largest = 0;
  std::size_t sum = kept;
  for (const std::size_t size : sizes) {
    largest = std::max(largest, size);
    sum += size;
  }
  // homes_ also counts the boxes still to be inserted elsewhere; references_ counts only references so far.
  return kept <= count / 2 && largest <= count / 8 * 7 && sum <= 3 * count &&
         references_ + sum <= max_references * homes_.size();
}

/// Inserts a box into a node, which becomes its home if it has none yet.
template <int D>
void QuadtreeNodes<D>::put(std::uint32_t node, std::uint32_t id, const Box<D>& box) {
  QuadtreeNode<D>& to = nodes_[node];
  ++to.count;
  ++references_;
  if (!to.is_leaf()) ++kept_;
  const std::uint32_t slot = put_in_chain(node, box, BoxId(id));
  QuadtreeHome& home = homes_[id];
  if (home.node != no_node || !to.is_leaf()) home.several = 1;
  if (home.node != no_node) return;
  home.node = node;
  home.slot = slot & 0x7fffffffU;
}

template <int D>
std::uint32_t QuadtreeNodes<D>::add_children(std::uint32_t parent) {
  std::uint32_t first;
  if (free_.empty()) {
    first = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + child_count);
  } else {
    first = free_.back();
    free_.pop_back();
  }
  const QuadtreeNode<D>& above = nodes_[parent];
  for (std::uint32_t child = 0; child < child_count; ++child) {
    QuadtreeNode<D>& node = nodes_[first + child];
    node = {};
    node.low = above.low;
    node.high = above.high;
    node.parent = parent;
    node.depth = above.depth + 1;
    for (int axis = 0; axis < D; ++axis) {
      if (!(above.split[axis] == above.split[axis])) continue;
      ((child >> axis & 1U) != 0 ? node.low : node.high)[axis] = above.split[axis];
    }
  }
  is_too_deep_ |= above.depth + 1 >= max_depth;
  return first;
}

/// Moves a node's boxes to ids_. Boxes at home in the node have no home afterwards.
template <int D>
void QuadtreeNodes<D>::drain(std::uint32_t node) {
  QuadtreeNode<D>& from = nodes_[node];
  references_ -= from.count;
  if (!from.is_leaf()) kept_ -= from.count;
  from.count = 0;
  while (from.block != no_slot) {
    const std::uint32_t block = from.block;
    for (std::uint32_t used = pool_.head(block).used; used != 0; used &= used - 1) {
      const std::uint32_t id = index(pool_.id(pool_.slot(block, used)));
      if (homes_[id].node == node) homes_[id].node = no_node;
      ids_.push_back(id);
    }
    pool_.remove_block(from.block, block);
  }
}

/// Makes a node a leaf if its children are leaves and it and they hold few boxes. Returns whether it did.
template <int D>
bool QuadtreeNodes<D>::merge(std::uint32_t node, std::span<const Box<D>> boxes) {
  const std::uint32_t children = nodes_[node].children;
  if (children == no_node) return false;
  std::uint32_t count = nodes_[node].count;
  for (std::uint32_t child = children; child < children + child_count; ++child) {
    if (!nodes_[child].is_leaf()) return false;
    count += nodes_[child].count;
  }
  if (count > capacity_ / 2) return false;
  ids_.clear();
  for (std::uint32_t child = children; child < children + child_count; ++child) drain(child);
  drain(node);
  std::sort(ids_.begin(), ids_.end());
  ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
  free_.push_back(children);
  nodes_[node].children = no_node;
  nodes_[node].split_at = 0;
  for (const std::uint32_t id : ids_) put(node, id, boxes[id]);
  return true;
}

template class QuadtreeNodes<2>;
template class QuadtreeNodes<3>;

}  // namespace broadside::algorithm

// References carried from leaf to leaf: up to the parent that has both sides of a border, and down again.
// Section VI-D of the paper.
//
// The leaves that a box touches hang together by their sides. So whoever starts from one of them and goes
// across every side that the box reaches past meets them all. Where the box has moved but a little, only the
// sides that it did not reach past before can lead to a leaf in which it was not.
#include "algorithms/quadtree/siblings.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace broadside::own {

template <int D>
void QuadtreeSiblings<D>::start(const QuadtreeNodes<D>& tree) {
  if (++walk_ == 0) {
    std::ranges::fill(met_, 0U);
    walk_ = 1;
  }
  if (met_.size() < tree.node_end()) met_.resize(tree.node_end(), 0);
}

template <int D>
bool QuadtreeSiblings<D>::carry(const QuadtreeNodes<D>& tree, std::uint32_t home, const Box<D>& before,
                                const Box<D>& now) {
  references_.clear();
  for (const float least : now.min) {
    if (std::isinf(least) && least > 0) return false;  // no region reaches as far
  }
  start(tree);
  is_kept_ = false;
  const Mover mover{tree, before, now, !overlap(before, now)};
  for (std::uint32_t leaf = home; leaf != no_node && !is_kept_; leaf = next(mover, leaf)) {
    if (!tree[leaf].is_leaf()) return false;
    meet(leaf);
    references_.push_back({leaf, true, tree[leaf].touches(now)});
  }
  const std::size_t old = references_.size();
  for (std::size_t i = 0; i < old && !is_kept_; ++i) {
    if (!references_[i].is) leave(mover, references_[i].node);
  }
  for (std::size_t i = 0; i < references_.size() && !is_kept_; ++i) {
    if (references_[i].is) spread(mover, references_[i].node);
  }
  if (is_kept_) return false;
  // A descent meets the leaf of the least corner first.
  const Box<D> corner{now.min, now.min};
  const auto first = std::ranges::find_if(references_, [&](const Reference& reference) {
    return reference.is && tree[reference.node].contains(corner);
  });
  std::swap(references_.front(), *first);
  return true;
}

/// The leaf or keeping node that follows among those of the old box, in the order of a descent.
template <int D>
std::uint32_t QuadtreeSiblings<D>::next(const Mover& mover, std::uint32_t leaf) {
  std::uint32_t at = leaf;
  while (at != QuadtreeNodes<D>::root && !mover.tree[at].contains(mover.before)) {
    const std::uint32_t parent = mover.tree[at].parent;
    pass(mover, parent);
    const std::uint32_t after = at - mover.tree[parent].children + 1;
    const std::uint32_t rest = mover.tree[parent].touched(mover.before) >> after;
    at = parent;
    if (rest == 0) continue;
    at = mover.tree[parent].children + after + static_cast<std::uint32_t>(std::countr_zero(rest));
    while (!mover.tree[at].is_leaf()) {
      const QuadtreeNode<D>& node = mover.tree[at];
      const std::uint32_t touched = node.touched(mover.before);
      if (node.keeps(mover.before, touched)) return at;
      pass(mover, at);
      at = node.children + static_cast<std::uint32_t>(std::countr_zero(touched));
    }
    return at;
  }
  return no_node;
}

/// Carries the reference of a leaf that the box has left to where the new box is nearest.
template <int D>
void QuadtreeSiblings<D>::leave(const Mover& mover, std::uint32_t leaf) {
  Box<D> nearest;
  for (int axis = 0; axis < D; ++axis) {
    nearest.min[axis] =
        std::max(mover.now.min[axis], std::min(mover.now.max[axis], mover.tree[leaf].low[axis]));
    nearest.max[axis] = nearest.min[axis];
  }
  std::uint32_t at = leaf;
  while (at != QuadtreeNodes<D>::root && !mover.tree[at].contains(nearest)) at = mover.tree[at].parent;
  descend(mover, at, nearest);
}

/// Goes on from a leaf that the box is in.
template <int D>
void QuadtreeSiblings<D>::spread(const Mover& mover, std::uint32_t leaf) {
  const QuadtreeNode<D>& node = mover.tree[leaf];
  for (int axis = 0; axis < D; ++axis) {
    const float low = node.low[axis];
    const float high = node.high[axis];
    if (mover.now.max[axis] >= high && (mover.is_apart || mover.before.max[axis] < high))
      cross(mover, leaf, axis, high);
    if (mover.now.min[axis] < low && (mover.is_apart || mover.before.min[axis] >= low))
      cross(mover, leaf, axis, std::nextafter(low, -std::numeric_limits<float>::infinity()));
  }
}

/// Goes to the leaves of the new box that lie along a leaf's side, where an axis is `beyond` it.
template <int D>
void QuadtreeSiblings<D>::cross(const Mover& mover, std::uint32_t leaf, int axis, float beyond) {
  Box<D> side = mover.now;
  for (int other = 0; other < D; ++other) {
    side.min[other] = std::max(side.min[other], mover.tree[leaf].low[other]);
    side.max[other] = std::min(side.max[other], mover.tree[leaf].high[other]);
  }
  side.min[axis] = side.max[axis] = beyond;
  std::uint32_t at = leaf;
  while (at != QuadtreeNodes<D>::root &&
         !(beyond >= mover.tree[at].low[axis] && beyond < mover.tree[at].high[axis]))
    at = mover.tree[at].parent;
  descend(mover, at, side);
}

/// Adds the leaves that a probe touches and that have not been met.
template <int D>
void QuadtreeSiblings<D>::descend(const Mover& mover, std::uint32_t at, const Box<D>& probe) {
  const QuadtreeNode<D>& node = mover.tree[at];
  if (node.is_leaf()) {
    if (meet(at)) references_.push_back({at, false, true});
    return;
  }
  pass(mover, at);
  for (std::uint32_t rest = node.touched(probe); rest != 0; rest &= rest - 1)
    descend(mover, node.children + static_cast<std::uint32_t>(std::countr_zero(rest)), probe);
}

/// A node with several children that the new box touches is passed on the way from one of them to another:
/// so none that would keep the box goes unseen.
template <int D>
void QuadtreeSiblings<D>::pass(const Mover& mover, std::uint32_t node) {
  is_kept_ |= mover.tree[node].keeps(mover.now, mover.tree[node].touched(mover.now));
}

template class QuadtreeSiblings<2>;
template class QuadtreeSiblings<3>;

}  // namespace broadside::own

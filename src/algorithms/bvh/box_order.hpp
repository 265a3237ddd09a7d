// Orders boxes or nodes so that neighbours in space share a parent, in a tree of sixteen children to a node.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"

#include "core/sample.hpp"
#include "kernels/bvh.hpp"

namespace broadside::algorithm {

/// A box, or a node's bounds, and its number.
template <int D>
struct NumberedBox {
  Box<D> box;
  std::uint32_t number;
};

/// Twice the centre on an axis, clamped so that sums do not overflow. Never NaN, even for an invalid box.
template <int D>
float middle(const Box<D>& box, int axis) {
  const auto limited = [](float value) { return std::min(std::max(-0x1p120f, value), 0x1p120f); };
  return limited(box.min[axis]) + limited(box.max[axis]);
}

/// Orders boxes by their centres along an axis, then by number, so the order is the same everywhere.
template <int D>
struct BeforeAlong {
  int axis;

  bool operator()(const NumberedBox<D>& a, const NumberedBox<D>& b) const {
    const float first = middle(a.box, axis);
    const float second = middle(b.box, axis);
    return first != second ? first < second : a.number < b.number;
  }
};

/// The axis on which the centres are spread most widely. There is at least one box.
template <int D>
int widest_axis(std::span<const NumberedBox<D>> boxes) {
  int widest = 0;
  float greatest_spread = -1;
  for (int axis = 0; axis < D; ++axis) {
    float lowest = middle(boxes.front().box, axis);
    float highest = lowest;
    for (const NumberedBox<D>& one : boxes) {
      lowest = std::min(lowest, middle(one.box, axis));
      highest = std::max(highest, middle(one.box, axis));
    }
    if (!(highest - lowest > greatest_spread)) continue;
    widest = axis;
    greatest_spread = highest - lowest;
  }
  return widest;
}

/// Halves the leaves recursively, along the axis on which their centres are spread most widely. The first
/// half is a whole number of full subtrees.
template <int D>
void halve(std::span<NumberedBox<D>> leaves) {
  if (leaves.size() <= kernels::fan_out) return;
  std::size_t subtree = kernels::fan_out;
  while (subtree * kernels::fan_out < leaves.size()) subtree *= kernels::fan_out;
  const std::size_t half = (leaves.size() / subtree + 1) / 2 * subtree;
  const auto middle_at = static_cast<std::ptrdiff_t>(half);
  std::nth_element(leaves.begin(), leaves.begin() + middle_at, leaves.end(),
                   BeforeAlong<D>{widest_axis<D>(leaves)});
  halve(leaves.first(half));
  halve(leaves.subspan(half));
}

/// Orders packed leaves, at least one, so that each sixteen lie together, and each sixteen of these groups
/// do. In the packer's order, sixteen leaves are a long row. Leaves far larger than most come last, since
/// they would widen the bounds of the nodes they share. Cost: O(n log n).
template <int D>
void arrange(std::span<NumberedBox<D>> leaves) {
  const auto size_of = [](const NumberedBox<D>& leaf) {
    float size = 0;
    for (int axis = 0; axis < D; ++axis)
      size = std::max(size, std::min(leaf.box.max[axis] - leaf.box.min[axis], 0x1p120f));
    return size;
  };
  std::vector<float> sizes;
  for (const NumberedBox<D>& leaf : leaves) sizes.push_back(size_of(leaf));
  const float max_size = 4 * core::median(sizes);
  const auto large = std::stable_partition(
      leaves.begin(), leaves.end(), [&](const NumberedBox<D>& leaf) { return size_of(leaf) <= max_size; });
  const auto common = static_cast<std::size_t>(large - leaves.begin());
  halve(leaves.first(common));
  halve(leaves.subspan(common));
}

}  // namespace broadside::algorithm

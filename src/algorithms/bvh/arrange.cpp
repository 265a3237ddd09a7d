// Which leaves of a packed tree lie together under one node.
#include "algorithms/bvh/arrange.hpp"

#include <cstddef>
#include <vector>

#include "kernels/bvh.hpp"

namespace broadside::algorithm {
namespace {

using kernels::fan_out;

/// Halves by the middles along the axis on which these are spread widest, recursively. Halves are
/// whole numbers of full subtrees.
template <int D>
void halve(std::span<NumberedBox<D>> leaves) {
  if (leaves.size() <= fan_out) return;
  std::size_t subtree = fan_out;
  while (subtree * fan_out < leaves.size()) subtree *= fan_out;
  const std::size_t half = (leaves.size() / subtree + 1) / 2 * subtree;
  const auto middle_at = static_cast<std::ptrdiff_t>(half);
  std::ranges::nth_element(leaves, leaves.begin() + middle_at, BeforeAlong<D>{widest_axis<D>(leaves)});
  halve(leaves.first(half));
  halve(leaves.subspan(half));
}

}  // namespace

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
  const auto median = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, median);
  const float max_size = 4 * *median;
  const auto large = std::stable_partition(
      leaves.begin(), leaves.end(), [&](const NumberedBox<D>& leaf) { return size_of(leaf) <= max_size; });
  const auto common = static_cast<std::size_t>(large - leaves.begin());
  halve(leaves.first(common));
  halve(leaves.subspan(common));
}

template void arrange(std::span<NumberedBox<2>>);
template void arrange(std::span<NumberedBox<3>>);

}  // namespace broadside::algorithm

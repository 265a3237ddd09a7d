// Traversal of a tree of boxes by overlap with a box, and distances to a node's children: sixteen children at
// a time, written once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bvh_query.cpp"
#include "kernels/bvh_query.hpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bvh_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

template <int D>
bool overlapping(const BvhView<D>& tree, const Box<D>& box, FoundBoxes& found) {
  const BroadcastBox<D> query(box);
  const auto overlaps = [&](const Block<D>& node, std::size_t at)
                            HWY_ATTR { return query.overlaps(node, at); };
  return traverse(tree, overlaps, [&](const Block<D>& node) HWY_ATTR {
    std::size_t hits = found.count;
    for (std::size_t at = 0; at < fan_out; at += lanes)
      hits += append(node, at, query.overlaps(node, at), found.ids.data() + hits);
    found.count = hits;
    return hits < found.full || found.take();
  });
}

template <int D>
void distances_of(const Block<D>& node, const DistanceQuery<D>& query, std::array<float, fan_out>& result) {
  for (std::size_t at = 0; at < fan_out; at += lanes) {
    FloatVector sum = hn::Zero(Floats());
    for (int axis = 0; axis < D; ++axis) {
      const FloatVector min = load(node.min[axis], at);
      const FloatVector max = load(node.max[axis], at);
      const FloatVector low = all(query.point.min[axis]);
      const FloatVector high = all(query.point.max[axis]);
      // Selected so that no infinity is subtracted from itself.
      const FloatVector before = hn::IfThenElseZero(hn::Lt(high, min), hn::Sub(min, high));
      const FloatVector gap = hn::IfThenElse(hn::Lt(max, low), hn::Sub(low, max), before);
      const FloatVector weighted = hn::Mul(gap, all(query.weight[axis]));
      sum = hn::Add(sum, hn::Mul(weighted, weighted));
    }
    sum = hn::Sub(hn::Mul(hn::Min(sum, all(query.max)), all(query.share)), all(query.allowance));
    hn::StoreU(sum, Floats(), result.data() + at);
  }
}

}  // namespace

// What the dispatch below can name: no templates.
bool overlapping_2(const BvhView<2>& tree, const Box<2>& box, FoundBoxes& found) {
  return overlapping(tree, box, found);
}
bool overlapping_3(const BvhView<3>& tree, const Box<3>& box, FoundBoxes& found) {
  return overlapping(tree, box, found);
}
void distances_2(const Block<2>& node, const DistanceQuery<2>& query, std::array<float, fan_out>& result) {
  distances_of(node, query, result);
}
void distances_3(const Block<3>& node, const DistanceQuery<3>& query, std::array<float, fan_out>& result) {
  distances_of(node, query, result);
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(overlapping_2);
HWY_EXPORT(overlapping_3);
HWY_EXPORT(distances_2);
HWY_EXPORT(distances_3);

template <>
bool find_overlapping(const BvhView<2>& tree, const Box<2>& box, FoundBoxes& found) {
  return HWY_DYNAMIC_DISPATCH(overlapping_2)(tree, box, found);
}
template <>
bool find_overlapping(const BvhView<3>& tree, const Box<3>& box, FoundBoxes& found) {
  return HWY_DYNAMIC_DISPATCH(overlapping_3)(tree, box, found);
}
template <>
void distances(const Block<2>& node, const DistanceQuery<2>& query, std::array<float, fan_out>& result) {
  HWY_DYNAMIC_DISPATCH(distances_2)(node, query, result);
}
template <>
void distances(const Block<3>& node, const DistanceQuery<3>& query, std::array<float, fan_out>& result) {
  HWY_DYNAMIC_DISPATCH(distances_3)(node, query, result);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

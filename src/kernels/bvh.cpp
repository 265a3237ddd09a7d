// Tests of one BVH node, and the traversal of a BVH by overlap with a box: sixteen children at a time,
// written once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bvh.cpp"
#include "kernels/bvh.hpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bvh_lanes.hpp"
#include "kernels/bvh_query.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

template <int D>
Box<D> bounds(const Block<D>& node) {
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    FloatVector lower = all(infinity);
    FloatVector greatest_max = all(-infinity);
    for (std::size_t at = 0; at < fan_out; at += lanes) {
      const FloatVector min = load(node.min[axis], at);
      const FloatVector max = load(node.max[axis], at);
      const FloatMask is_there = hn::Le(min, max);
      lower = hn::Min(lower, hn::IfThenElse(is_there, min, all(infinity)));
      greatest_max = hn::Max(greatest_max, hn::IfThenElse(is_there, max, all(-infinity)));
    }
    box.min[axis] = hn::GetLane(hn::MinOfLanes(Floats(), lower));
    box.max[axis] = hn::GetLane(hn::MaxOfLanes(Floats(), greatest_max));
  }
  return box;
}

template <int D>
std::size_t best(const Block<D>& node, std::size_t count, const Box<D>& box) {
  // Coordinates are clamped to this limit, so that sums of sizes are finite.
  const FloatVector limit = all(0x1p120f);
  const FloatVector other_limit = all(-0x1p120f);
  const auto bounded = [&](FloatVector v) HWY_ATTR { return hn::Max(hn::Min(v, limit), other_limit); };
  HWY_ALIGN float growths[fan_out];
  HWY_ALIGN float sizes[fan_out];
  for (std::size_t at = 0; at < fan_out; at += lanes) {
    FloatVector growth = hn::Zero(Floats());
    FloatVector size = hn::Zero(Floats());
    for (int axis = 0; axis < D; ++axis) {
      const FloatVector min = bounded(load(node.min[axis], at));
      const FloatVector max = bounded(load(node.max[axis], at));
      const FloatVector low = bounded(all(box.min[axis]));
      const FloatVector high = bounded(all(box.max[axis]));
      growth = hn::Add(growth, hn::Sub(hn::Max(max, high), max));
      growth = hn::Add(growth, hn::Sub(min, hn::Min(min, low)));
      size = hn::Add(size, hn::Sub(max, min));
    }
    hn::Store(growth, Floats(), growths + at);
    hn::Store(size, Floats(), sizes + at);
  }
  std::size_t chosen = 0;
  for (std::size_t i = 1; i < count; ++i) {
    const bool is_better =
        growths[i] < growths[chosen] || (growths[i] == growths[chosen] && sizes[i] < sizes[chosen]);
    if (is_better) chosen = i;
  }
  return chosen;
}

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
std::uint32_t near(const Block<D>& node, const DistanceQuery<D>& query, float limit,
                   std::array<float, fan_out>& result) {
  std::uint32_t bits = 0;
  for (std::size_t at = 0; at < fan_out; at += lanes) {
    FloatVector sum = hn::Zero(Floats());
    for (int axis = 0; axis < D; ++axis) {
      const FloatVector min = load(node.min[axis], at);
      const FloatVector max = load(node.max[axis], at);
      const FloatVector low = all(query.box.min[axis]);
      const FloatVector high = all(query.box.max[axis]);
      // Selected so that the difference of equal infinities is never used.
      const FloatVector before = hn::IfThenElseZero(hn::Lt(high, min), hn::Sub(min, high));
      const FloatVector gap = hn::IfThenElse(hn::Lt(max, low), hn::Sub(low, max), before);
      const FloatVector weighted = hn::Mul(gap, all(query.weight[axis]));
      sum = hn::Add(sum, hn::Mul(weighted, weighted));
    }
    // Less than rounding to floats may have added: a share of a normal number, or a subnormal number.
    constexpr float share = 1 - 0x1p-18f;
    constexpr float max = std::numeric_limits<float>::max();
    constexpr float allowance = std::numeric_limits<float>::min();
    sum = hn::Sub(hn::Mul(hn::Min(sum, all(max)), all(share)), all(allowance));
    hn::StoreU(sum, Floats(), result.data() + at);
    bits |= bits_of(hn::Le(sum, all(limit))) << at;
  }
  return bits;
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& bounds_2 = bounds<2>;
constexpr auto& bounds_3 = bounds<3>;
constexpr auto& best_2 = best<2>;
constexpr auto& best_3 = best<3>;
constexpr auto& overlapping_2 = overlapping<2>;
constexpr auto& overlapping_3 = overlapping<3>;
constexpr auto& near_2 = near<2>;
constexpr auto& near_3 = near<3>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(bounds_2);
HWY_EXPORT(bounds_3);
HWY_EXPORT(best_2);
HWY_EXPORT(best_3);
HWY_EXPORT(overlapping_2);
HWY_EXPORT(overlapping_3);
HWY_EXPORT(near_2);
HWY_EXPORT(near_3);

template <>
Box<2> bounds_of(const Block<2>& node) {
  return HWY_DYNAMIC_DISPATCH(bounds_2)(node);
}
template <>
Box<3> bounds_of(const Block<3>& node) {
  return HWY_DYNAMIC_DISPATCH(bounds_3)(node);
}
template <>
std::size_t best_child(const Block<2>& node, std::size_t count, const Box<2>& box) {
  return HWY_DYNAMIC_DISPATCH(best_2)(node, count, box);
}
template <>
std::size_t best_child(const Block<3>& node, std::size_t count, const Box<3>& box) {
  return HWY_DYNAMIC_DISPATCH(best_3)(node, count, box);
}

template <>
bool find_overlapping(const BvhView<2>& tree, const Box<2>& box, FoundBoxes& found) {
  return HWY_DYNAMIC_DISPATCH(overlapping_2)(tree, box, found);
}
template <>
bool find_overlapping(const BvhView<3>& tree, const Box<3>& box, FoundBoxes& found) {
  return HWY_DYNAMIC_DISPATCH(overlapping_3)(tree, box, found);
}
template <>
std::uint32_t near_children(const Block<2>& node, const DistanceQuery<2>& query, float limit,
                            std::array<float, fan_out>& result) {
  return HWY_DYNAMIC_DISPATCH(near_2)(node, query, limit, result);
}
template <>
std::uint32_t near_children(const Block<3>& node, const DistanceQuery<3>& query, float limit,
                            std::array<float, fan_out>& result) {
  return HWY_DYNAMIC_DISPATCH(near_3)(node, query, limit, result);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

// Bounds and choices of one node of a tree of bounds, sixteen children at a time, written once for every
// instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bvh.cpp"
#include "kernels/bvh.hpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bvh_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

template <int D>
Box<D> bounds(const Block<D>& node) {
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    FloatVector least_min = all(infinity);
    FloatVector greatest_max = all(-infinity);
    for (std::size_t at = 0; at < fan_out; at += lanes) {
      const FloatVector min = load(node.min[axis], at);
      const FloatVector max = load(node.max[axis], at);
      const FloatMask is_there = hn::Le(min, max);
      least_min = hn::Min(least_min, hn::IfThenElse(is_there, min, all(infinity)));
      greatest_max = hn::Max(greatest_max, hn::IfThenElse(is_there, max, all(-infinity)));
    }
    box.min[axis] = hn::GetLane(hn::MinOfLanes(Floats(), least_min));
    box.max[axis] = hn::GetLane(hn::MaxOfLanes(Floats(), greatest_max));
  }
  return box;
}

template <int D>
std::size_t best(const Block<D>& node, std::size_t count, const Box<D>& box) {
  // Beyond it, sizes are not told apart; sums of them are finite.
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

}  // namespace

// What the dispatch below can name: no templates.
Box<2> bounds_2(const Block<2>& node) { return bounds(node); }
Box<3> bounds_3(const Block<3>& node) { return bounds(node); }
std::size_t best_2(const Block<2>& node, std::size_t count, const Box<2>& box) {
  return best(node, count, box);
}
std::size_t best_3(const Block<3>& node, std::size_t count, const Box<3>& box) {
  return best(node, count, box);
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(bounds_2);
HWY_EXPORT(bounds_3);
HWY_EXPORT(best_2);
HWY_EXPORT(best_3);

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

}  // namespace broadside::kernels
#endif  // HWY_ONCE

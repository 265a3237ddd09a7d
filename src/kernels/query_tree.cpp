// Queries to a tree of boxes, sixteen children at a time, written once for every instruction set: what
// overlaps a box, and what one node says of its children. Casts are in query_tree_casts.cpp.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/query_tree.cpp"
#include "kernels/query_tree.hpp"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/query_lanes.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

template <int D>
struct Overlap {
  HWY_INLINE explicit Overlap(const Box<D>& box) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis] = all(box.min[axis]);
      max[axis] = all(box.max[axis]);
    }
  }

  HWY_INLINE FloatMask operator()(const QueryNode<D>& node, std::size_t at) const {
    FloatMask hits = hn::Le(load(node.min[0], at), max[0]);
    hits = hn::And(hits, hn::Le(min[0], load(node.max[0], at)));
    for (int axis = 1; axis < D; ++axis) {
      hits = hn::And(hits, hn::Le(load(node.min[axis], at), max[axis]));
      hits = hn::And(hits, hn::Le(min[axis], load(node.max[axis], at)));
    }
    return hits;
  }

  FloatVector min[D];
  FloatVector max[D];
};

template <int D>
bool overlapping(const QueryTree<D>& tree, const Box<D>& box, FoundBoxes& found) {
  const Overlap<D> overlap(box);
  std::uint32_t waiting[(longest_path + 1) * node_width];
  std::size_t count = 1;
  waiting[0] = tree.root;
  while (count > 0) {
    const std::uint32_t number = waiting[--count];
    const QueryNode<D>& node = tree.nodes[number & ~leaf_bit];
    if ((number & leaf_bit) == 0) {
      for (std::size_t at = 0; at < node_width; at += lanes)
        count += append(node, at, overlap(node, at), waiting + count);
      continue;
    }
    std::size_t hits = found.count;
    for (std::size_t at = 0; at < node_width; at += lanes)
      hits += append(node, at, overlap(node, at), found.ids.data() + hits);
    found.count = hits;
    if (hits >= found.full && !found.take()) return false;
  }
  return true;
}

template <int D>
void distances_of(const QueryNode<D>& node, const DistanceQuery<D>& query,
                  std::array<float, node_width>& result) {
  for (std::size_t at = 0; at < node_width; at += lanes) {
    FloatVector sum = hn::Zero(Floats());
    for (int axis = 0; axis < D; ++axis) {
      const FloatVector min = load(node.min[axis], at);
      const FloatVector max = load(node.max[axis], at);
      const FloatVector low = all(query.point.min[axis]);
      const FloatVector high = all(query.point.max[axis]);
      // No infinity is subtracted from itself where it counts.
      const FloatVector before = hn::IfThenElseZero(hn::Lt(high, min), hn::Sub(min, high));
      const FloatVector gap = hn::IfThenElse(hn::Lt(max, low), hn::Sub(low, max), before);
      const FloatVector weighted = hn::Mul(gap, all(query.weight[axis]));
      sum = hn::Add(sum, hn::Mul(weighted, weighted));
    }
    sum = hn::Sub(hn::Mul(hn::Min(sum, all(query.most)), all(query.share)), all(query.allowance));
    hn::StoreU(sum, Floats(), result.data() + at);
  }
}

template <int D>
Box<D> bounds(const QueryNode<D>& node) {
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    FloatVector least_min = all(infinity);
    FloatVector greatest_max = all(-infinity);
    for (std::size_t at = 0; at < node_width; at += lanes) {
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
std::size_t best(const QueryNode<D>& node, std::size_t count, const Box<D>& box) {
  // Beyond it, sizes are not told apart; sums of them are finite.
  const FloatVector limit = all(0x1p120f);
  const FloatVector other_limit = all(-0x1p120f);
  const auto bounded = [&](FloatVector v) HWY_ATTR { return hn::Max(hn::Min(v, limit), other_limit); };
  HWY_ALIGN float growths[node_width];
  HWY_ALIGN float sizes[node_width];
  for (std::size_t at = 0; at < node_width; at += lanes) {
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
bool overlapping_2(const QueryTree<2>& tree, const Box<2>& box, FoundBoxes& found) {
  return overlapping(tree, box, found);
}
bool overlapping_3(const QueryTree<3>& tree, const Box<3>& box, FoundBoxes& found) {
  return overlapping(tree, box, found);
}
void distances_2(const QueryNode<2>& node, const DistanceQuery<2>& query,
                 std::array<float, node_width>& result) {
  distances_of(node, query, result);
}
void distances_3(const QueryNode<3>& node, const DistanceQuery<3>& query,
                 std::array<float, node_width>& result) {
  distances_of(node, query, result);
}
Box<2> bounds_2(const QueryNode<2>& node) { return bounds(node); }
Box<3> bounds_3(const QueryNode<3>& node) { return bounds(node); }
std::size_t best_2(const QueryNode<2>& node, std::size_t count, const Box<2>& box) {
  return best(node, count, box);
}
std::size_t best_3(const QueryNode<3>& node, std::size_t count, const Box<3>& box) {
  return best(node, count, box);
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(overlapping_2);
HWY_EXPORT(overlapping_3);
HWY_EXPORT(distances_2);
HWY_EXPORT(distances_3);
HWY_EXPORT(bounds_2);
HWY_EXPORT(bounds_3);
HWY_EXPORT(best_2);
HWY_EXPORT(best_3);

template <>
bool find_overlapping(const QueryTree<2>& tree, const Box<2>& box, FoundBoxes& found) {
  return HWY_DYNAMIC_DISPATCH(overlapping_2)(tree, box, found);
}
template <>
bool find_overlapping(const QueryTree<3>& tree, const Box<3>& box, FoundBoxes& found) {
  return HWY_DYNAMIC_DISPATCH(overlapping_3)(tree, box, found);
}
template <>
void distances(const QueryNode<2>& node, const DistanceQuery<2>& query,
               std::array<float, node_width>& result) {
  HWY_DYNAMIC_DISPATCH(distances_2)(node, query, result);
}
template <>
void distances(const QueryNode<3>& node, const DistanceQuery<3>& query,
               std::array<float, node_width>& result) {
  HWY_DYNAMIC_DISPATCH(distances_3)(node, query, result);
}
template <>
Box<2> bounds_of(const QueryNode<2>& node) {
  return HWY_DYNAMIC_DISPATCH(bounds_2)(node);
}
template <>
Box<3> bounds_of(const QueryNode<3>& node) {
  return HWY_DYNAMIC_DISPATCH(bounds_3)(node);
}
template <>
std::size_t best_child(const QueryNode<2>& node, std::size_t count, const Box<2>& box) {
  return HWY_DYNAMIC_DISPATCH(best_2)(node, count, box);
}
template <>
std::size_t best_child(const QueryNode<3>& node, std::size_t count, const Box<3>& box) {
  return HWY_DYNAMIC_DISPATCH(best_3)(node, count, box);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

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

/// A box to measure distances from, in every lane.
template <int D>
class DistanceFrom {
 public:
  HWY_INLINE explicit DistanceFrom(const DistanceQuery<D>& query) {
    for (int axis = 0; axis < D; ++axis) {
      low_[axis] = all(query.box.min[axis]);
      high_[axis] = all(query.box.max[axis]);
      weight_[axis] = all(query.weight[axis]);
    }
  }

  /// Which children from `at` on are within the squared distance `limit`. Sets `sum` to the distances.
  HWY_INLINE FloatMask within(const Block<D>& node, std::size_t at, float limit, FloatVector& sum) const {
    sum = hn::Zero(Floats());
    FloatMask is_there = hn::Le(load(node.min[0], at), load(node.max[0], at));
    for (int axis = 0; axis < D; ++axis) {
      const FloatVector gap = hn::Max(hn::Sub(load(node.min[axis], at), high_[axis]),
                                      hn::Sub(low_[axis], load(node.max[axis], at)));
      // The difference of equal infinities is NaN, and the other difference then not positive.
      const FloatVector weighted =
          hn::Mul(hn::IfThenElseZero(hn::Gt(gap, hn::Zero(Floats())), gap), weight_[axis]);
      sum = hn::MulAdd(weighted, weighted, sum);
    }
    return hn::And(is_there, hn::Le(sum, all(limit)));
  }

 private:
  FloatVector low_[D];
  FloatVector high_[D];
  FloatVector weight_[D];
};

template <int D>
void near(const BvhView<D>& tree, const DistanceQuery<D>& query, NearLeaves<D>& found) {
  const DistanceFrom<D> from(query);
  const auto take = [&](const Block<D>& leaf) HWY_ATTR {
    std::uint32_t bits = 0;
    FloatVector sum;
    for (std::size_t at = 0; at < fan_out; at += lanes)
      bits |= bits_of(from.within(leaf, at, found.limit, sum)) << at;
    if (bits != 0) found.take(leaf, bits);
  };
  const Block<D>* const first = found.first;
  if (first != nullptr) take(*first);
  alignas(64) std::uint32_t waiting[(longest_path + 2) * fan_out];
  alignas(64) float distances[(longest_path + 2) * fan_out];
  std::size_t count = 1;
  waiting[0] = tree.root;
  distances[0] = 0;
  while (count > 0) {
    if (!(distances[--count] <= found.limit)) continue;
    const std::uint32_t number = waiting[count];
    const Block<D>& node = tree.nodes[number & ~leaf_bit];
    if ((number & leaf_bit) != 0) {
      if (&node != first) take(node);
      continue;
    }
    const std::size_t begin = count;
    for (std::size_t at = 0; at < fan_out; at += lanes) {
      FloatVector sum;
      const FloatMask mask = from.within(node, at, found.limit, sum);
      count += append_entries(node, at, mask, sum, waiting + count, distances + count);
    }
    if (count == begin) continue;
    std::size_t nearest = begin;
    for (std::size_t i = begin + 1; i < count; ++i) {
      if (distances[i] < distances[nearest]) nearest = i;
    }
    std::swap(waiting[nearest], waiting[count - 1]);
    std::swap(distances[nearest], distances[count - 1]);
  }
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
void find_near(const BvhView<2>& tree, const DistanceQuery<2>& query, NearLeaves<2>& found) {
  HWY_DYNAMIC_DISPATCH(near_2)(tree, query, found);
}
template <>
void find_near(const BvhView<3>& tree, const DistanceQuery<3>& query, NearLeaves<3>& found) {
  HWY_DYNAMIC_DISPATCH(near_3)(tree, query, found);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

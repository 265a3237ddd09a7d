// Tests of one BVH node, and the traversal of a BVH by overlap with a box: sixteen children at a time,
// written once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bvh.cpp"
#include "kernels/bvh.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

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

  /// From the box in a lane of a node.
  HWY_INLINE DistanceFrom(const Block<D>& node, std::size_t lane, const std::array<float, D>& weight) {
    for (int axis = 0; axis < D; ++axis) {
      low_[axis] = all(node.min[axis][lane]);
      high_[axis] = all(node.max[axis][lane]);
      weight_[axis] = all(weight[axis]);
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

using Keys = hn::RebindToSigned<Floats>;

/// Copies `size` children, at most sixteen, in descending order of distance. The place of each is the number
/// of those farther away, since no processor could predict the branches of a sort. Reads sixteen distances.
HWY_INLINE void push_sorted(const std::uint32_t* children, float* distances, std::size_t size,
                            std::uint32_t* children_to, float* distances_to) {
  const Keys tag;
  // The place as the last bits tells equal distances apart.
  const auto last_bits = hn::Set(tag, static_cast<std::int32_t>(fan_out - 1));
  HWY_ALIGN std::int32_t keys[fan_out];
  for (std::size_t at = 0; at < fan_out; at += lanes) {
    const auto place = hn::Iota(tag, static_cast<std::int32_t>(at));
    const auto key =
        hn::Or(hn::AndNot(last_bits, hn::BitCast(tag, hn::Load(Floats(), distances + at))), place);
    const auto is_there = hn::Lt(place, hn::Set(tag, static_cast<std::int32_t>(size)));
    hn::Store(hn::IfThenElse(is_there, key, hn::Set(tag, -1)), tag, keys + at);
  }
  for (std::size_t i = 0; i < size; ++i) {
    const auto key = hn::Set(tag, keys[i]);
    std::size_t to = 0;
    for (std::size_t at = 0; at < fan_out; at += lanes)
      to += count_true(tag, hn::Gt(hn::Load(tag, keys + at), key));
    children_to[to] = children[i];
    distances_to[to] = distances[i];
  }
}

/// A depth-first traversal of what is near, of a node's children the nearest one first. limit() is the
/// greatest squared distance that counts; leaf(number) searches a leaf, and may lower it. Begins with the
/// leaf `first`, unless it is no_slot; comes to it again later.
template <int D, typename Limit, typename Leaf>
HWY_INLINE void traverse_near(const BvhView<D>& tree, const DistanceFrom<D>& from, std::uint32_t first,
                              const Limit& limit, const Leaf& leaf) {
  alignas(64) std::uint32_t waiting[(longest_path + 2) * fan_out];
  alignas(64) float distances[(longest_path + 2) * fan_out];
  waiting[0] = tree.root;
  waiting[1] = first | leaf_bit;
  distances[0] = distances[1] = 0;
  std::size_t count = first == no_slot ? 1 : 2;
  HWY_ALIGN std::uint32_t children[2 * fan_out];
  HWY_ALIGN float nearness[2 * fan_out] = {};
  while (count > 0) {
    if (!(distances[--count] <= limit())) continue;
    const std::uint32_t number = waiting[count];
    if ((number & leaf_bit) != 0) {
      leaf(number & ~leaf_bit);
      continue;
    }
    std::size_t size = 0;
    for (std::size_t at = 0; at < fan_out; at += lanes) {
      FloatVector sum;
      const FloatMask mask = from.within(tree.nodes[number], at, limit(), sum);
      size += append_entries(tree.nodes[number], at, mask, sum, children + size, nearness + size);
    }
    push_sorted(children, nearness, size, waiting + count, distances + count);
    count += size;
  }
}

template <int D>
void near(const BvhView<D>& tree, const DistanceQuery<D>& query, FoundBoxes& found) {
  const DistanceFrom<D> from(query);
  traverse_near(
      tree, from, no_slot, [&] { return found.t_max; },
      [&](std::uint32_t number) HWY_ATTR {
        for (std::size_t at = 0; at < fan_out; at += lanes) {
          FloatVector sum;
          const FloatMask near = from.within(tree.nodes[number], at, found.t_max, sum);
          const auto hits = hn::RebindMask(Numbers(), near);
          const auto slots = hn::Iota(Numbers(), static_cast<std::uint32_t>(number * fan_out + at));
          const auto sums = hn::BitCast(Numbers(), sum);
          hn::StoreU(compress(Numbers(), slots, hits), Numbers(), found.ids.data() + found.count);
          hn::StoreU(hn::BitCast(Floats(), compress(Numbers(), sums, hits)), Floats(),
                     found.t_enter.data() + found.count);
          found.count += count_true(Floats(), near);
        }
        if (found.count >= found.full) found.take();
      });
}

/// Up to this length, lists are gone through even for a box that is too far away to be in one: that costs
/// less than a branch that no processor could predict.
constexpr std::size_t max_always_gone_through = 4;

/// Lists of this length are kept in registers.
constexpr std::size_t kept_in_registers = 2;

constexpr std::size_t vectors = fan_out / lanes;

/// The lists of a group: `Size` in number if it is not 0, otherwise group.count.
template <int D, std::size_t Size>
class NearLists {
 public:
  HWY_INLINE explicit NearLists(NearGroup<D>& group) : group_(group) {
    for (std::size_t i = 0; i < Size; ++i) {
      for (std::size_t v = 0; v < vectors; ++v) kept_[i][v] = load(i, v);
    }
  }

  HWY_INLINE void store() {
    for (std::size_t i = 0; i < Size; ++i) {
      for (std::size_t v = 0; v < vectors; ++v) hn::Store(kept_[i][v], Keys(), place(i, v));
    }
  }

  /// Inserts a box with these keys into the lists of vector `v`. Returns whether it may be in any.
  HWY_INLINE unsigned insert(std::size_t v, hn::Vec<Keys> key) {
    const Keys tag;
    if constexpr (Size != 0) {
      const auto is_near = hn::Lt(key, kept_[Size - 1][v]);
      for (std::size_t i = 0; i < Size; ++i) {
        const auto other = kept_[i][v];
        kept_[i][v] = hn::Min(key, other);
        key = hn::Max(key, other);
      }
      return all_false(tag, is_near) ? 0 : 1;
    } else {
      const std::size_t count = group_.count;
      const unsigned inserts = all_false(tag, hn::Lt(key, load(count - 1, v))) ? 0 : 1;
      if ((inserts | (count <= max_always_gone_through ? 1U : 0U)) == 0) return 0;
      for (std::size_t i = 0; i < count; ++i) {
        const auto other = load(i, v);
        hn::Store(hn::Min(key, other), tag, place(i, v));
        key = hn::Max(key, other);
      }
      return inserts;
    }
  }

  /// The greatest key but for the last of each list.
  HWY_INLINE std::int32_t farthest() const {
    const Keys tag;
    auto farthest = hn::Zero(tag);
    for (std::size_t v = 0; v < vectors; ++v) {
      if constexpr (Size != 0)
        farthest = hn::Max(farthest, kept_[Size - 2][v]);
      else
        farthest = hn::Max(farthest, load(group_.count - 2, v));
    }
    return hn::GetLane(hn::MaxOfLanes(tag, farthest));
  }

 private:
  HWY_INLINE std::int32_t* place(std::size_t i, std::size_t v) const {
    return group_.keys[i].data() + v * lanes;
  }
  HWY_INLINE hn::Vec<Keys> load(std::size_t i, std::size_t v) const { return hn::Load(Keys(), place(i, v)); }

  NearGroup<D>& group_;
  hn::Vec<Keys> kept_[Size == 0 ? 1 : Size][vectors];
};

/// The queries of a group, to measure distances from boxes, or from points that are lower bounds.
template <int D, bool ArePoints>
class NearQueries {
 public:
  HWY_INLINE explicit NearQueries(const NearGroup<D>& group) : group_(group) {
    if constexpr (ArePoints) {
      for (int axis = 0; axis < D; ++axis) {
        for (std::size_t v = 0; v < vectors; ++v) {
          const FloatVector at = load(group.queries.min[axis], v * lanes);
          at_[axis][v] = hn::IfThenElseZero(hn::Eq(at, at), at);  // no NaN
        }
      }
    }
  }

  /// The squared distances, finite, from the box in a lane of a leaf to the queries of vector `v`.
  HWY_INLINE FloatVector distances(const Block<D>& leaf, std::size_t lane, std::size_t v) const {
    FloatVector sum;
    if constexpr (ArePoints) {
      sum = hn::Zero(Floats());
      for (int axis = 0; axis < D; ++axis) {
        const FloatVector gap = hn::Sub(all(leaf.min[axis][lane]), at_[axis][v]);
        sum = axis == 0 ? hn::Mul(gap, gap) : hn::MulAdd(gap, gap, sum);
      }
    } else {
      DistanceFrom<D>(leaf, lane, group_.weight).within(group_.queries, v * lanes, infinity, sum);
      // Finite, so that a list with room takes it.
      sum = hn::Min(sum, all(std::numeric_limits<float>::max()));
    }
    return sum;
  }

 private:
  const NearGroup<D>& group_;
  FloatVector at_[D][vectors];
};

template <int D, bool ArePoints, std::size_t Size>
HWY_INLINE void search_group(const BvhView<D>& tree, NearGroup<D>& group) {
  const Keys tag;
  float limit = group.limit;
  std::size_t tested = 0;
  std::uint32_t leaves = 0;
  const DistanceFrom<D> from_all({bounds(group.queries), group.weight});
  const NearQueries<D, ArePoints> queries(group);
  NearLists<D, Size> lists(group);
  traverse_near(
      tree, from_all, group.own_leaf, [&] { return limit; },
      [&](std::uint32_t number) HWY_ATTR {
        const bool is_own = number == group.own_leaf;
        if (is_own && tested > 0) return;
        const Block<D>& leaf = tree.nodes[number];
        std::uint32_t near = 0;
        FloatVector sum;
        for (std::size_t at = 0; at < fan_out; at += lanes)
          near |= bits_of(from_all.within(leaf, at, limit, sum)) << at;
        if (near == 0) return;
        if (tested > NearGroup<D>::max_tested || leaves == NearGroup<D>::max_leaves) {
          limit = -1;  // ends the traversal
          return;
        }
        tested += static_cast<std::size_t>(std::popcount(near));
        const std::uint32_t first = leaves * static_cast<std::uint32_t>(fan_out);
        unsigned is_near = 0;
        for (; near != 0; near &= near - 1) {
          const auto lane = static_cast<std::uint32_t>(std::countr_zero(near));
          for (std::size_t v = 0; v < vectors; ++v) {
            const auto bits = hn::BitCast(tag, queries.distances(leaf, lane, v));
            auto key = hn::Or(hn::And(bits, hn::Set(tag, ~NearGroup<D>::number_mask)),
                              hn::Set(tag, static_cast<std::int32_t>(first + lane)));
            if (is_own) {
              const auto places = hn::Iota(tag, static_cast<std::int32_t>(v * lanes));
              const auto is_itself = hn::Eq(places, hn::Set(tag, static_cast<std::int32_t>(lane)));
              key = hn::IfThenElse(is_itself, hn::Set(tag, NearGroup<D>::no_key), key);
            }
            is_near |= lists.insert(v, key);
          }
        }
        if (is_near == 0) return;
        group.leaves[leaves++] = number;
        const std::int32_t farthest = lists.farthest();
        if (farthest == NearGroup<D>::no_key) return;
        const auto rounded_up = hn::Set(tag, farthest | NearGroup<D>::number_mask);
        const float reach = std::sqrt(hn::GetLane(hn::BitCast(Floats(), rounded_up))) + group.error;
        limit = std::min(group.limit, reach * reach * (1 + 0x1p-17F) + 0x1p-125F);
      });
  lists.store();
  group.limit = limit;
  group.tested = tested;
}

template <int D>
void near_group(const BvhView<D>& tree, NearGroup<D>& group) {
  if (!group.are_points)
    search_group<D, false, 0>(tree, group);
  else if (group.count == kept_in_registers)
    search_group<D, true, kept_in_registers>(tree, group);
  else
    search_group<D, true, 0>(tree, group);
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
constexpr auto& near_group_2 = near_group<2>;
constexpr auto& near_group_3 = near_group<3>;

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
HWY_EXPORT(near_group_2);
HWY_EXPORT(near_group_3);

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
void find_near(const BvhView<2>& tree, const DistanceQuery<2>& query, FoundBoxes& found) {
  HWY_DYNAMIC_DISPATCH(near_2)(tree, query, found);
}
template <>
void find_near(const BvhView<3>& tree, const DistanceQuery<3>& query, FoundBoxes& found) {
  HWY_DYNAMIC_DISPATCH(near_3)(tree, query, found);
}
template <>
void find_near(const BvhView<2>& tree, NearGroup<2>& group) {
  HWY_DYNAMIC_DISPATCH(near_group_2)(tree, group);
}
template <>
void find_near(const BvhView<3>& tree, NearGroup<3>& group) {
  HWY_DYNAMIC_DISPATCH(near_group_3)(tree, group);
}

template <int D>
void NearGroup<D>::start(std::size_t size) {
  count = size;
  tested = 0;
  for (std::size_t lane = 0; lane < fan_out; ++lane)
    keys[0][lane] = queries.min[0][lane] <= queries.max[0][lane] ? no_key : 0;
  for (std::size_t i = 1; i < count; ++i) keys[i] = keys[0];
}
template void NearGroup<2>::start(std::size_t);
template void NearGroup<3>::start(std::size_t);

}  // namespace broadside::kernels
#endif  // HWY_ONCE

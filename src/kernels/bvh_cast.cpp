// Traversal of a tree of boxes by casts, sixteen children at a time, written once for every instruction set.
//
// Slabs after T. Kay and J. Kajiya, "Ray tracing complex scenes" (1986). Bounds are tested with
// multiplications by an inverse and a margin above what these can be wrong by, so that no box is lost that
// the definition, with divisions, lets be met.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bvh_cast.cpp"
#include <algorithm>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bvh_lanes.hpp"
#include "kernels/bvh_query.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

/// How far a product with the inverse may be from the quotient: a few roundings, also of subnormal numbers.
constexpr float margin = 1 + 0x1p-20f;
constexpr float least = 0x1p-126f;

/// Appends as append() does, and to `entries_to` the parameters at which these children are entered.
template <int D>
HWY_INLINE std::size_t append_entries(const Block<D>& node, std::size_t at, FloatMask mask,
                                      FloatVector entries, std::uint32_t* to, float* entries_to) {
  const auto hits = hn::RebindMask(Numbers(), mask);
  const auto bits = hn::BitCast(Numbers(), entries);
  hn::StoreU(hn::BitCast(Floats(), compress(Numbers(), bits, hits)), Floats(), entries_to);
  return append(node, at, mask, to);
}

/// A cast, in every lane.
template <int D>
struct Cast {
  HWY_INLINE explicit Cast(const CastQuery<D>& query) : cast_(query) {
    for (int axis = 0; axis < D; ++axis) {
      const bool is_back = query.course[axis] == Course::backward ||
                           (query.course[axis] == Course::unknown && query.direction[axis] < 0);
      // The leading side of the cast box meets the near side of the other one.
      near_side_[axis] = all(is_back ? query.box.min[axis] : query.box.max[axis]);
      far_side_[axis] = all(is_back ? query.box.max[axis] : query.box.min[axis]);
      inverse_[axis] = all(query.inverse[axis]);
      near_bounds_[axis] = is_back ? &Block<D>::max : &Block<D>::min;
      far_bounds_[axis] = is_back ? &Block<D>::min : &Block<D>::max;
    }
  }

  /// Which children from `at` on may be met up to the `t_max` that `limit` is made of.
  HWY_INLINE FloatMask may_meet(const Block<D>& node, std::size_t at, FloatVector limit,
                                FloatVector& enter) const {
    FloatVector leave = all(infinity);
    enter = hn::Zero(Floats());
    FloatMask hits = hn::Le(load(node.min[0], at), load(node.max[0], at));  // not NaN
    for (int axis = 0; axis < D; ++axis) {
      if (HWY_UNLIKELY(cast_.course[axis] >= Course::still)) {
        if (cast_.course[axis] == Course::still) hits = hn::And(hits, overlaps(node, axis, at));
        continue;
      }
      enter = hn::Max(enter, hn::Mul(hn::Sub(near_bound(node, axis, at), near_side_[axis]), inverse_[axis]));
      leave = hn::Min(leave, hn::Mul(hn::Sub(far_bound(node, axis, at), far_side_[axis]), inverse_[axis]));
    }
    leave = hn::MulAdd(leave, all(margin), all(least));
    return hn::And(hits, hn::Le(enter, hn::Min(leave, limit)));
  }

  /// Which children from `at` on are met up to `t_max`, by the definition.
  HWY_INLINE FloatMask meets(const Block<D>& node, std::size_t at, FloatVector t_max,
                             FloatVector& enter) const {
    FloatVector leave = t_max;
    enter = hn::Zero(Floats());
    FloatMask hits = hn::Le(load(node.min[0], at), load(node.max[0], at));
    for (int axis = 0; axis < D; ++axis) {
      if (HWY_UNLIKELY(cast_.course[axis] == Course::still)) {
        hits = hn::And(hits, overlaps(node, axis, at));
        continue;
      }
      const FloatVector direction = all(cast_.direction[axis]);
      enter = hn::Max(enter, hn::Div(hn::Sub(near_bound(node, axis, at), near_side_[axis]), direction));
      leave = hn::Min(leave, hn::Div(hn::Sub(far_bound(node, axis, at), far_side_[axis]), direction));
    }
    return hn::And(hits, hn::Le(enter, leave));
  }

  /// Appends the boxes of a leaf that are met (or may be, where the cast is not exact) to what was found.
  HWY_INLINE void leaf(const Block<D>& node, FoundBoxes& found, FloatVector limit) const {
    const FloatVector t_max = all(found.t_max);
    for (std::size_t at = 0; at < fan_out; at += lanes) {
      FloatVector enter;
      FloatMask hits = may_meet(node, at, limit, enter);
      if (cast_.exact) {
        if (all_false(Floats(), hits)) continue;
        hits = meets(node, at, t_max, enter);
      }
      // Makes -0.0 0.0.
      const FloatVector entries = hn::Add(enter, hn::Zero(Floats()));
      found.count += append_entries(node, at, hits, entries, found.ids.data() + found.count,
                                    found.t_enter.data() + found.count);
    }
  }

  /// The parameter up to which bounds count, if boxes count up to `t_max`.
  static HWY_INLINE FloatVector limit(float t_max) { return all(t_max * margin + least); }

 private:
  using Bounds = decltype(Block<D>::min);

  HWY_INLINE FloatVector near_bound(const Block<D>& node, int axis, std::size_t at) const {
    return load((node.*near_bounds_[axis])[axis], at);
  }
  HWY_INLINE FloatVector far_bound(const Block<D>& node, int axis, std::size_t at) const {
    return load((node.*far_bounds_[axis])[axis], at);
  }
  HWY_INLINE FloatMask overlaps(const Block<D>& node, int axis, std::size_t at) const {
    return hn::And(hn::Le(load(node.min[axis], at), near_side_[axis]),
                   hn::Le(far_side_[axis], load(node.max[axis], at)));
  }

  const CastQuery<D>& cast_;
  FloatVector near_side_[D];
  FloatVector far_side_[D];
  FloatVector inverse_[D];
  // The bounds of a node that a cast meets first and last: no branch on a direction.
  Bounds Block<D>::*near_bounds_[D];
  Bounds Block<D>::*far_bounds_[D];
};

template <int D>
bool met(const BvhView<D>& tree, const CastQuery<D>& query, FoundBoxes& found) {
  const Cast<D> cast(query);
  const FloatVector limit = Cast<D>::limit(found.t_max);
  const auto may_meet = [&](const Block<D>& node, std::size_t at) HWY_ATTR {
    FloatVector enter;
    return cast.may_meet(node, at, limit, enter);
  };
  return traverse(tree, may_meet, [&](const Block<D>& node) HWY_ATTR {
    cast.leaf(node, found, limit);
    return found.count < found.full || found.take();
  });
}

/// A node to visit, with the parameter at which it is entered in the high half: the bits of positive floats
/// sort as the floats do.
using Waiting = std::uint64_t;

HWY_INLINE float t_enter_of(Waiting waiting) {
  const auto bits = static_cast<std::uint32_t>(waiting >> 32);
  float value;
  hwy::CopyBytes<sizeof(value)>(&bits, &value);
  return value;
}

/// Sorts in descending order. Nearly always there are two or three, which are sorted without branches.
HWY_INLINE void sort_descending(Waiting* list, std::size_t count) {
  const auto order = [list](std::size_t i, std::size_t j) HWY_ATTR {
    const Waiting greater = std::max(list[i], list[j]);
    list[j] = std::min(list[i], list[j]);
    list[i] = greater;
  };
  if (count < 2) return;
  order(0, 1);
  if (count == 2) return;
  order(1, 2);
  order(0, 1);
  for (std::size_t i = 3; i < count; ++i) {
    const Waiting inserted = list[i];
    std::size_t to = i;
    for (; to > 0 && list[to - 1] < inserted; --to) list[to] = list[to - 1];
    list[to] = inserted;
  }
}

template <int D>
void first_met(const BvhView<D>& tree, const CastQuery<D>& query, FoundBoxes& found) {
  const Cast<D> cast(query);
  FloatVector limit = Cast<D>::limit(found.t_max);
  Waiting waiting[(longest_path + 1) * fan_out];
  std::uint32_t children[2 * fan_out];
  std::uint32_t entries[2 * fan_out];
  std::size_t count = 1;
  waiting[0] = tree.root;
  while (count > 0) {
    --count;
    if (!(t_enter_of(waiting[count]) <= hn::GetLane(limit))) continue;
    const auto number = static_cast<std::uint32_t>(waiting[count]);
    const Block<D>& node = tree.nodes[number & ~leaf_bit];
    if ((number & leaf_bit) != 0) {
      cast.leaf(node, found, limit);
      if (found.count == 0) continue;
      found.take();
      limit = Cast<D>::limit(found.t_max);
      continue;
    }
    std::size_t size = 0;
    for (std::size_t at = 0; at < fan_out; at += lanes) {
      FloatVector enter;
      const FloatMask mask = cast.may_meet(node, at, limit, enter);
      const auto hits = hn::RebindMask(Numbers(), mask);
      const auto bits = hn::BitCast(Numbers(), hn::Add(enter, hn::Zero(Floats())));  // no -0.0
      hn::StoreU(compress(Numbers(), bits, hits), Numbers(), entries + size);
      size += append(node, at, mask, children + size);
    }
    for (std::size_t i = 0; i < size; ++i) {
      waiting[count + i] = Waiting{entries[i]} << 32 | children[i];
      prefetch(tree.nodes[children[i] & ~leaf_bit]);
    }
    // The nearest one last, where it is taken from.
    sort_descending(waiting + count, size);
    count += size;
  }
}

}  // namespace

// What the dispatch below can name: no templates.
bool met_2(const BvhView<2>& tree, const CastQuery<2>& cast, FoundBoxes& found) {
  return met(tree, cast, found);
}
bool met_3(const BvhView<3>& tree, const CastQuery<3>& cast, FoundBoxes& found) {
  return met(tree, cast, found);
}
void first_met_2(const BvhView<2>& tree, const CastQuery<2>& cast, FoundBoxes& found) {
  first_met(tree, cast, found);
}
void first_met_3(const BvhView<3>& tree, const CastQuery<3>& cast, FoundBoxes& found) {
  first_met(tree, cast, found);
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(met_2);
HWY_EXPORT(met_3);
HWY_EXPORT(first_met_2);
HWY_EXPORT(first_met_3);

template <>
bool find_met(const BvhView<2>& tree, const CastQuery<2>& cast, FoundBoxes& found) {
  return HWY_DYNAMIC_DISPATCH(met_2)(tree, cast, found);
}
template <>
bool find_met(const BvhView<3>& tree, const CastQuery<3>& cast, FoundBoxes& found) {
  return HWY_DYNAMIC_DISPATCH(met_3)(tree, cast, found);
}
template <>
void find_first_met(const BvhView<2>& tree, const CastQuery<2>& cast, FoundBoxes& found) {
  HWY_DYNAMIC_DISPATCH(first_met_2)(tree, cast, found);
}
template <>
void find_first_met(const BvhView<3>& tree, const CastQuery<3>& cast, FoundBoxes& found) {
  HWY_DYNAMIC_DISPATCH(first_met_3)(tree, cast, found);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

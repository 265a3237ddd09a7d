// Traversal of a tree of boxes by casts, sixteen children at a time, written once for every instruction set.
//
// Slabs after T. Kay and J. Kajiya, "Ray tracing complex scenes" (1986). Bounds are tested by multiplying
// with an inverse, with a margin above the rounding error, so that no box is lost that the cast meets by the
// definition, which divides.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bvh_cast.cpp"
#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bvh_lanes.hpp"
#include "kernels/bvh_query.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

/// How far a product with the inverse may be from the quotient: a few roundings, also of subnormal numbers.
constexpr float margin = 1 + 0x1p-20f;
constexpr float min_normal = 0x1p-126f;

/// A cast, in every lane.
template <int D>
class Cast {
  using Bounds = decltype(Block<D>::min);

 public:
  HWY_INLINE explicit Cast(const CastQuery<D>& query) : cast_(query) {
    for (int axis = 0; axis < D; ++axis) {
      // Branchless, since no processor could predict a branch here.
      const auto is_back = static_cast<std::size_t>(query.course[axis] == Course::backward) |
                           (static_cast<std::size_t>(query.course[axis] == Course::unknown) &
                            std::size_t{query.direction[axis] < 0});
      const std::array<float, 2> sides = {query.box.max[axis], query.box.min[axis]};
      constexpr std::array<Bounds Block<D>::*, 2> bounds = {&Block<D>::min, &Block<D>::max};
      // The leading side of the cast box meets the near side of the other one.
      near_side_[axis] = all(sides[is_back]);
      far_side_[axis] = all(sides[1 - is_back]);
      inverse_[axis] = all(query.inverse[axis]);
      near_bounds_[axis] = bounds[is_back];
      far_bounds_[axis] = bounds[1 - is_back];
    }
  }

  /// Which children from `at` on may be met up to `t_max`, given as `limit`.
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
    leave = hn::MulAdd(leave, all(margin), all(min_normal));
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

  /// Appends to `found` the boxes from `at` on that are met. `hits` are the boxes that may be met; without
  /// an exact cast, all of them are appended.
  HWY_INLINE void add(const Block<D>& leaf, std::size_t at, FloatMask hits, FloatVector enter,
                      FoundBoxes& found) const {
    if (cast_.exact) {
      if (all_false(Floats(), hits)) return;
      hits = meets(leaf, at, all(found.t_max), enter);
    }
    // Turns -0.0 into 0.0.
    const FloatVector entries = hn::Add(enter, hn::Zero(Floats()));
    found.count += append_entries(leaf, at, hits, entries, found.ids.data() + found.count,
                                  found.t_enter.data() + found.count);
  }

  /// The parameter up to which bounds count, if boxes count up to `t_max`.
  static HWY_INLINE FloatVector limit(float t_max) { return all(t_max * margin + min_normal); }

 private:
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
  // The bounds of a node that a cast meets first and last, chosen in advance to avoid branches on directions.
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
    for (std::size_t at = 0; at < fan_out; at += lanes) {
      FloatVector enter;
      const FloatMask hits = cast.may_meet(node, at, limit, enter);
      cast.add(node, at, hits, enter, found);
    }
    return found.count < found.full || found.take();
  });
}

/// The key that stands for no parameter, and the bits of a key that hold the place.
constexpr std::uint32_t no_key = 0xFFFFFFFFU;
constexpr std::uint32_t place_bits = fan_out - 1;

/// Keys to find the least of sixteen parameters: the bits of a non-negative float sort as the float does. The
/// parameter's place replaces the last four bits, so a key stands for the parameter or a little less. The
/// sign of -0.0 is lost. no_key outside the mask.
HWY_INLINE NumberVector keys(FloatVector t_enter, FloatMask mask, std::size_t at) {
  const auto bits = hn::And(hn::BitCast(Numbers(), t_enter), hn::Set(Numbers(), 0x7FFFFFFFU & ~place_bits));
  const auto places = hn::Iota(Numbers(), static_cast<std::uint32_t>(at));
  return hn::IfThenElse(hn::RebindMask(Numbers(), mask), hn::Or(bits, places), hn::Set(Numbers(), no_key));
}

/// The nodes that a search for the first box has yet to visit. With more than sixteen the search goes depth
/// first, which bounds their number.
class WaitingNodes {
 public:
  /// Adds the children of `node` from `at` on that are in `mask`.
  template <int D>
  HWY_INLINE void add(const Block<D>& node, std::size_t at, FloatMask mask, FloatVector t_enter) {
    count_ += append_entries(node, at, mask, t_enter, nodes_ + count_, t_enter_ + count_);
  }

  /// Takes out the node that is entered first, or one of the last added if there are more than sixteen. Skips
  /// nodes that are entered beyond `limit`. Returns false if there is none.
  HWY_INLINE bool take(float limit, std::uint32_t& node) {
    while (HWY_UNLIKELY(count_ > fan_out)) {
      node = nodes_[--count_];
      if (t_enter_[count_] <= limit) return true;
    }
    NumberVector nearest = hn::Set(Numbers(), no_key);
    const auto count = hn::Set(Numbers(), static_cast<std::uint32_t>(count_));
    for (std::size_t at = 0; at < fan_out; at += lanes) {
      const auto is_there = hn::Lt(hn::Iota(Numbers(), static_cast<std::uint32_t>(at)), count);
      nearest = hn::Min(nearest, keys(load(t_enter_, at), hn::RebindMask(Floats(), is_there), at));
    }
    nearest = hn::MinOfLanes(Numbers(), nearest);
    // By the key without its place: another node with this key may be entered earlier. NaN if there is none.
    if (!(hn::GetLane(hn::BitCast(Floats(), hn::And(nearest, hn::Set(Numbers(), ~place_bits)))) <= limit))
      return false;
    const std::uint32_t place = hn::GetLane(nearest) & place_bits;
    node = nodes_[place];
    --count_;
    nodes_[place] = nodes_[count_];
    t_enter_[place] = t_enter_[count_];
    return true;
  }

  std::size_t count() const { return count_; }

  /// Prefetches the nodes that were added since there were `count`.
  template <int D>
  HWY_INLINE void prefetch_from(std::size_t count, const BvhView<D>& tree) const {
    for (; count < count_; ++count) prefetch(tree.nodes[nodes_[count] & ~leaf_bit]);
  }

 private:
  std::size_t count_ = 0;
  alignas(64) std::uint32_t nodes_[(longest_path + 2) * fan_out];
  alignas(64) float t_enter_[(longest_path + 2) * fan_out];
};

template <int D>
void first_met(const BvhView<D>& tree, const CastQuery<D>& query, FoundBoxes& found) {
  constexpr std::size_t vectors = fan_out / lanes;
  const Cast<D> cast(query);
  FloatVector limit = Cast<D>::limit(found.t_max);
  WaitingNodes waiting;
  for (std::uint32_t number = tree.root;;) {
    const Block<D>& node = tree.nodes[number & ~leaf_bit];
    FloatVector enter[vectors];
    FloatMask hits[vectors];
    FloatMask any = hits[0] = cast.may_meet(node, 0, limit, enter[0]);
    for (std::size_t i = 1; i < vectors; ++i) {
      hits[i] = cast.may_meet(node, i * lanes, limit, enter[i]);
      any = hn::Or(any, hits[i]);
    }
    if (!all_false(Floats(), any)) {
      if ((number & leaf_bit) == 0) {  // straight on to the nearest child
        NumberVector key[vectors];
        NumberVector nearest = hn::Set(Numbers(), no_key);
        for (std::size_t i = 0; i < vectors; ++i) {
          key[i] = keys(enter[i], hits[i], i * lanes);
          nearest = hn::Min(nearest, key[i]);
        }
        nearest = hn::MinOfLanes(Numbers(), nearest);
        number = node.id[hn::GetLane(nearest) & place_bits];
        const std::size_t waited = waiting.count();
        for (std::size_t i = 0; i < vectors; ++i) {
          const auto is_other = hn::RebindMask(Floats(), hn::Ne(key[i], nearest));
          waiting.add(node, i * lanes, hn::And(hits[i], is_other), enter[i]);
        }
        // Most of a tree is leaves, so the nodes above them are in a nearer cache.
        if ((number & leaf_bit) != 0) waiting.prefetch_from(waited, tree);
        continue;
      }
      for (std::size_t i = 0; i < vectors; ++i) cast.add(node, i * lanes, hits[i], enter[i], found);
      if (found.count > 0) {
        found.take();
        limit = Cast<D>::limit(found.t_max);
      }
    }
    if (!waiting.take(hn::GetLane(limit), number)) return;
  }
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& met_2 = met<2>;
constexpr auto& met_3 = met<3>;
constexpr auto& first_met_2 = first_met<2>;
constexpr auto& first_met_3 = first_met<3>;

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

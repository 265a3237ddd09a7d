// Looks up moved boxes in a BVH and moves them in it, written once for every instruction set.
//
// The children that a box's path touches are compressed to the end of the next level's list without a branch,
// which would be unpredictable.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bvh_follow.cpp"
#include <algorithm>
#include <utility>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/bvh.hpp"
#include "kernels/bvh_lanes.hpp"
#include "kernels/pair_writer.hpp"
#include "kernels/run.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

using Writer = PairWriter<Numbers>;
static_assert(fan_out == Writer::at_once);

/// How many boxes ahead a leaf is prefetched.
constexpr std::size_t ahead = 3;

template <int D>
class Follow {
 public:
  HWY_INLINE Follow(const WritableBvh<D>& tree, PairSink& begun, PairSink& ended)
      : tree_(tree), begun_(begun), ended_(ended) {}

  std::uint64_t run(std::span<const MovedBox<D>> moved, std::uint8_t* calls_for) {
    for (std::size_t i = 0; i < moved.size(); ++i) {
      if (i + ahead < moved.size()) prefetch(tree_.nodes[moved[i + ahead].slot / fan_out]);
      const MovedBox<D>& box = moved[i];
      if (overlap(box.before, box.now)) {
        compare_in_leaves(box, box.bounds);
      } else {
        compare_in_leaves(box, box.before);
        compare_in_leaves(box, box.now);
      }
      tree_.nodes[box.slot / fan_out].set(box.slot % fan_out, box.now);
      calls_for[i] = enlarge(box);
      tell(tree_.checkpoint, leaves_ * fan_out, told_);
    }
    return leaves_ * fan_out;
  }

 private:
  /// Level by level, so that a list never mixes leaves with other nodes: a branch on them would be
  /// unpredictable.
  HWY_INLINE void compare_in_leaves(const MovedBox<D>& box, const Box<D>& way) {
    const BroadcastBox<D> query(way);
    std::uint32_t* from = tree_.lists[0];
    std::uint32_t* to = tree_.lists[1];
    from[0] = tree_.root;
    std::size_t count = 1;
    while (count > 0 && (from[0] & leaf_bit) == 0) {
      std::size_t found = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Block<D>& node = tree_.nodes[from[i]];
        for (std::size_t at = 0; at < fan_out; at += lanes)
          found += append(node, at, query.overlaps(node, at), to + found);
      }
      std::swap(from, to);
      count = found;
    }
    for (std::size_t i = 0; i < count; ++i) prefetch(tree_.nodes[from[i] & ~leaf_bit]);
    for (std::size_t i = 0; i < count; ++i) compare(box, tree_.nodes[from[i] & ~leaf_bit]);
    leaves_ += count;
  }

  HWY_INLINE void compare(const MovedBox<D>& box, const Block<D>& leaf) {
    const Numbers numbers;
    const BroadcastBox<D> before(box.before);
    const BroadcastBox<D> now(box.now);
    const NumberVector id = hn::Set(numbers, index(box.id));
    for (std::size_t at = 0; at < fan_out; at += lanes) {
      const NumberVector ids = hn::Load(numbers, leaf.id.data() + at);
      const auto is_other = hn::Ne(ids, id);
      const auto did = hn::And(is_other, hn::RebindMask(numbers, before.overlaps(leaf, at)));
      const auto does = hn::And(is_other, hn::RebindMask(numbers, now.overlaps(leaf, at)));
      if (HWY_UNLIKELY(box.filter_changed)) {
        begun_.room();
        begun_.write_of(id, ids, hn::Or(did, does));
      } else if (!all_false(numbers, hn::Xor(did, does))) {
        begun_.room();
        begun_.write_of(id, ids, hn::AndNot(did, does));
        ended_.room();
        ended_.write_of(id, ids, hn::AndNot(does, did));
      }
    }
  }

  /// Enlarges the bounds around a box. Returns the repairs that its move calls for.
  HWY_INLINE std::uint8_t enlarge(const MovedBox<D>& moved) {
    const Box<D>& box = moved.now;
    std::uint8_t calls_for = 0;
    bool is_leaf = true;
    for (std::uint32_t slot = tree_.info[moved.slot / fan_out].parent; slot != no_slot;
         slot = tree_.info[slot / fan_out].parent) {
      Block<D>& node = tree_.nodes[slot / fan_out];
      const std::size_t lane = slot % fan_out;
      bool grows = false;
      bool is_at_border = false;
      for (int axis = 0; axis < D; ++axis) {
        float& min = node.min[axis][lane];
        float& max = node.max[axis][lane];
        is_at_border |= moved.before.min[axis] == min || moved.before.max[axis] == max;
        grows |= box.min[axis] < min || box.max[axis] > max;
        min = std::min(min, box.min[axis]);  // NaN changes nothing
        max = std::max(max, box.max[axis]);
      }
      if (is_leaf)
        calls_for = static_cast<std::uint8_t>((is_at_border ? may_shrink : 0) | (grows ? left_leaf : 0));
      is_leaf = false;
      if (!grows) break;
    }
    return calls_for;
  }

  const WritableBvh<D>& tree_;
  Writer begun_;
  Writer ended_;
  std::uint64_t leaves_ = 0;
  std::uint64_t told_ = 0;
};

template <int D>
std::uint64_t follow_moved(const WritableBvh<D>& tree, std::span<const MovedBox<D>> moved,
                           std::uint8_t* calls_for, PairSink& begun, PairSink& ended) {
  return Follow<D>(tree, begun, ended).run(moved, calls_for);
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& follow_2 = follow_moved<2>;
constexpr auto& follow_3 = follow_moved<3>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(follow_2);
HWY_EXPORT(follow_3);

template <>
std::uint64_t follow(const WritableBvh<2>& tree, std::span<const MovedBox<2>> moved, std::uint8_t* calls_for,
                     PairSink& begun, PairSink& ended) {
  return HWY_DYNAMIC_DISPATCH(follow_2)(tree, moved, calls_for, begun, ended);
}

template <>
std::uint64_t follow(const WritableBvh<3>& tree, std::span<const MovedBox<3>> moved, std::uint8_t* calls_for,
                     PairSink& begun, PairSink& ended) {
  return HWY_DYNAMIC_DISPATCH(follow_3)(tree, moved, calls_for, begun, ended);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

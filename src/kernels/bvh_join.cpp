// The join of a packed BVH with itself, written once for every instruction set.
//
// A node's children are compared with the children of all nodes that its bounds touch, sixteen at a time.
// The hits of one level are the candidates of the next. Each pair of nodes is compared once: the earlier node
// with the later one. In a leaf, sixteen boxes at once are compared with the bounds of another leaf. The
// boxes that touch these bounds are collected over all such leaves, then compared with the boxes in those
// leaves. Lists are written without branches: hits are compressed to the front, and the end of the list
// advances by their number.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/bvh_join.cpp"
#include "kernels/bvh_join.hpp"

#include <algorithm>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/broadcast_box.hpp"
#include "kernels/compress.hpp"
#include "kernels/observed_tests.hpp"
#include "kernels/pair_writer.hpp"
#include "kernels/run.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

using Hits = NumberMask;
static_assert(fan_out == PairWriter<Numbers>::at_once);

/// Which of the boxes or bounds from `at` on the query overlaps.
template <int D>
HWY_INLINE Hits touching(const BroadcastBox<D>& query, const TreeLevel<D>& level, std::size_t at) {
  return hn::RebindMask(Numbers(), query.overlaps(level, at));
}

/// The numbers from `begin` on, one per lane. Not by Iota(): Highway 1.0 stores its numbers one by one, and
/// loading them as a vector then waits for all of these stores, which made AVX2 slower than SSE4.
HWY_INLINE NumberVector numbers_from(std::size_t begin) {
  alignas(64) static constexpr std::uint32_t first[] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
  return hn::Add(hn::Set(Numbers(), static_cast<std::uint32_t>(begin)), hn::Load(Numbers(), first));
}

HWY_INLINE NumberVector all_lanes(std::size_t number) {
  return hn::Set(Numbers(), static_cast<std::uint32_t>(number));
}

template <int D, typename LastTest>
class BvhJoin {
 public:
  BvhJoin(const PackedBvh<D>& tree, NodeRange leaves, const JoinLimit& limit, LastTest last_test,
          PairSink& sink)
      : tree_(tree), leaves_(leaves), limit_(limit), pairs_(sink, last_test), next_leaf_(leaves.begin) {}

  JoinWork run(std::uint32_t* scratch) {
    const std::uint32_t root = 0;
    if (children_of(0, tree_.level_count - 1, &root, 1, scratch)) next_leaf_ = leaves_.end;
    const std::uint64_t allowed = limit_.tests + limit_.tests_per_pair * pairs_.written();
    return {tests_ - unused_, allowed - std::min(allowed, work()), next_leaf_};
  }

 private:
  std::uint64_t work() const { return tests_ + fan_out * bounds_; }

  /// Joins the subtree of `node`, with its children on `level`, with the subtrees of the nodes in `list`: all
  /// nodes that touch `node` and do not come before it. Returns false if it gave up.
  bool children_of(std::size_t node, std::size_t level, const std::uint32_t* list, std::size_t count,
                   std::uint32_t* touched) {
    if (level == 0) {
      leaf(node, list, count);
      next_leaf_ = node + 1;
      bounds_ += count;
      tell(limit_.checkpoint, work(), told_);
      return HWY_LIKELY(work() <= limit_.tests) ||
             work() - limit_.tests <= limit_.tests_per_pair * pairs_.written();
    }
    const TreeLevel<D>& children = tree_.levels[level];
    const std::size_t border = tree_.left_size >> (4 * level);
    // The children that have leaves in the range.
    const std::size_t to_leaves = 4 * (level - 1);
    const std::size_t begin_child = std::max(node * fan_out, leaves_.begin >> to_leaves);
    const std::size_t end_child = std::min((node + 1) * fan_out, ((leaves_.end - 1) >> to_leaves) + 1);
    for (std::size_t child = begin_child; child < end_child; ++child) {
      if (tree_.left_size != 0 && child << (4 * level) >= tree_.left_size) break;  // no box of the left set
      const BroadcastBox<D> query(children, child);
      const NumberVector first = all_lanes(std::max(child, border));
      std::size_t touched_count = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const std::size_t begin = std::size_t{list[i]} * fan_out;
        for (std::size_t at = begin; at < begin + fan_out; at += lanes) {
          const NumberVector numbers = numbers_from(at);
          const Hits hits = hn::AndNot(hn::Gt(first, numbers), touching(query, children, at));
          hn::StoreU(compress(Numbers(), numbers, hits), Numbers(), touched + touched_count);
          touched_count += count_true(Numbers(), hits);
        }
      }
      bounds_ += count;
      if (!children_of(child, level - 1, touched, touched_count, touched + touched_count)) return false;
    }
    return true;
  }

  /// Joins the boxes of a leaf with each other and with those of the leaves of `list`.
  HWY_INLINE void leaf(std::size_t node, const std::uint32_t* list, std::size_t count) {
    const TreeLevel<D>& boxes = tree_.levels[0];
    const std::size_t begin = node * fan_out;
    if (tree_.left_size == 0) {
      within(begin);
      // This leaf is the first one in the list, unless another thread made its boxes invalid while they were
      // read.
      const std::size_t own = count > 0 && *list == node ? 1 : 0;
      list += own;
      count -= own;
    }
    if (count == 0) return;
    const TreeLevel<D>& leaves = tree_.levels[1];
    std::size_t queried = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const BroadcastBox<D> bounds(leaves, list[i]);
      const std::size_t other = std::size_t{list[i]} * fan_out;
      const std::size_t before = queried;
      for (std::size_t at = 0; at < fan_out; at += lanes) {
        const Hits hits = touching(bounds, boxes, begin + at);
        hn::StoreU(compress(Numbers(), numbers_from(other + at), hits), Numbers(), queries_ + queried);
        queried += count_true(Numbers(), hits);
      }
      if (HWY_UNLIKELY(list[i] >= tree_.first_with_gap)) unused_ += (queried - before) * gap_of(list[i]);
      if (HWY_UNLIKELY(queried > max_queries)) {
        across(begin, queried);
        queried = 0;
      }
    }
    across(begin, queried);
  }

  /// Compares the boxes of the leaf that begins at `begin` with each other.
  HWY_INLINE void within(std::size_t begin) {
    for (std::size_t i = 0; i + 1 < fan_out; ++i) {
      const BroadcastBox<D> query(tree_.levels[0], begin + i);
      const NumberVector id = all_lanes(index(tree_.id[begin + i]));
      for (std::size_t at = (i + 1) / lanes * lanes; at < fan_out; at += lanes) {
        const Hits later = hn::Gt(numbers_from(at), all_lanes(i));
        pairs_.room();
        pairs_.write_of(id, ids_beside(query, begin + at),
                        hn::And(touching(query, tree_.levels[0], begin + at), later));
      }
    }
    if constexpr (is_observing) observe_within(begin);
    constexpr std::size_t all_pairs = fan_out * (fan_out - 1) / 2;
    tests_ += all_pairs;
    const std::size_t leaf = begin / fan_out;
    if (HWY_LIKELY(leaf < tree_.first_with_gap)) return;
    const std::size_t boxes = fan_out - gap_of(leaf);
    unused_ += all_pairs - boxes * (boxes - 1) / 2;
  }

  void observe_within(std::size_t begin) const {
    const std::size_t end = begin + fan_out - gap_of(begin / fan_out);
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t j = i + 1; j < end; ++j) observe_test(tree_.id[i], tree_.id[j]);
    }
  }

  void observe_across(std::size_t place, std::size_t leaf) const {
    const auto boxes = static_cast<std::uint32_t>(fan_out - gap_of(leaf));
    observe_tests(tree_.id[place], tree_.id + leaf * fan_out, (1U << boxes) - 1);
  }

  /// How many places at the end of a leaf hold no box.
  std::size_t gap_of(std::size_t leaf) const {
    const float* const mins = tree_.levels[0].min[0] + leaf * fan_out;
    std::size_t boxes = fan_out;
    while (boxes > 0 && !(mins[boxes - 1] == mins[boxes - 1])) --boxes;  // NaN
    return fan_out - boxes;
  }

  /// Runs the first `count` of queries_: compares boxes of the leaf that begins at `begin` with other leaves.
  HWY_INLINE void across(std::size_t begin, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t place = begin + queries_[i] % fan_out;
      const std::size_t other = queries_[i] / fan_out * fan_out;
      const BroadcastBox<D> query(tree_.levels[0], place);
      const NumberVector id = all_lanes(index(tree_.id[place]));
      for (std::size_t at = other; at < other + fan_out; at += lanes) {
        pairs_.room();
        pairs_.write_of(id, ids_beside(query, at), touching(query, tree_.levels[0], at));
      }
      if constexpr (is_observing) observe_across(place, other / fan_out);
    }
    tests_ += count * fan_out;
  }

  /// The ids from `at` on. Boxes that only touch the query are marked for the last test in double.
  HWY_INLINE NumberVector ids_beside(const BroadcastBox<D>& query, std::size_t at) const {
    const NumberVector ids = load_ids(Numbers(), tree_.id + at);
    if constexpr (!LastTest::marks_touching) return ids;
    return marked(Numbers(), ids,
                  hn::RebindMask(Numbers(), touch(query, LoadedBoxes<D>(tree_.levels[0], at))));
  }

  static constexpr std::size_t max_queries = 1024;

  const PackedBvh<D>& tree_;
  NodeRange leaves_;
  JoinLimit limit_;
  PairWriter<Numbers, LastTest> pairs_;
  std::uint64_t tests_ = 0;   // counts each leaf as full, because that is the work done
  std::uint64_t unused_ = 0;  // how many of tests_ had a place without a box
  std::uint64_t bounds_ = 0;  // how often sixteen bounds were compared
  std::uint64_t told_ = 0;    // the work that was reported to the checkpoint
  std::size_t next_leaf_;
  std::uint32_t queries_[max_queries + 2 * fan_out];  // other leaf's first place + place in own leaf
};

template <int D>
void bound_level(const PackedBvh<D>& tree, std::size_t parent, NodeRange nodes) {
  const Floats floats;
  const TreeLevel<D>& below = tree.levels[parent - 1];
  const TreeLevel<D>& level = tree.levels[parent];
  for (int axis = 0; axis < D; ++axis) {
    for (std::size_t node = nodes.begin; node < nodes.end; ++node) {
      const float* const mins = below.min[axis] + node * fan_out;
      const float* const maxs = below.max[axis] + node * fan_out;
      auto min = hn::LoadU(floats, mins);
      auto max = hn::LoadU(floats, maxs);
      for (std::size_t at = lanes; at < fan_out; at += lanes) {
        min = hn::Min(min, hn::LoadU(floats, mins + at));
        max = hn::Max(max, hn::LoadU(floats, maxs + at));
      }
      level.min[axis][node] = hn::GetLane(hn::MinOfLanes(floats, min));
      level.max[axis][node] = hn::GetLane(hn::MaxOfLanes(floats, max));
    }
  }
}

template <int D>
JoinWork join_leaves(const PackedBvh<D>& tree, NodeRange leaves, const JoinLimit& limit,
                     std::uint32_t* scratch, PairSink& pairs) {
  return with_last_test(tree.doubles, [&](auto last_test) HWY_ATTR {
    return BvhJoin(tree, leaves, limit, last_test, pairs).run(scratch);
  });
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& join_2 = join_leaves<2>;
constexpr auto& join_3 = join_leaves<3>;
constexpr auto& set_bounds_2 = bound_level<2>;
constexpr auto& set_bounds_3 = bound_level<3>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(join_2);
HWY_EXPORT(join_3);
HWY_EXPORT(set_bounds_2);
HWY_EXPORT(set_bounds_3);

template <>
JoinWork join(const PackedBvh<2>& tree, NodeRange leaves, const JoinLimit& limit, std::uint32_t* scratch,
              PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(join_2)(tree, leaves, limit, scratch, pairs);
}

template <>
JoinWork join(const PackedBvh<3>& tree, NodeRange leaves, const JoinLimit& limit, std::uint32_t* scratch,
              PairSink& pairs) {
  return HWY_DYNAMIC_DISPATCH(join_3)(tree, leaves, limit, scratch, pairs);
}

template <>
void set_bounds(const PackedBvh<2>& tree, std::size_t parent, NodeRange nodes) {
  HWY_DYNAMIC_DISPATCH(set_bounds_2)(tree, parent, nodes);
}

template <>
void set_bounds(const PackedBvh<3>& tree, std::size_t parent, NodeRange nodes) {
  HWY_DYNAMIC_DISPATCH(set_bounds_3)(tree, parent, nodes);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

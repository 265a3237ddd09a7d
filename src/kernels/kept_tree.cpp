// A tree that stays: movers looked up and moved, bounds, and the choice of a leaf; written once for every
// instruction set.
//
// A mover is looked up level by level: which children its way touches is compressed to the front of the next
// level's list, without a branch on what no predictor can know.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/kept_tree.cpp"
#include "kernels/kept_tree.hpp"

#include <algorithm>
#include <limits>

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/compress.hpp"
#include "kernels/pair_writer.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

using Floats = hn::CappedTag<float, kept_width>;
using Numbers = hn::Rebind<std::uint32_t, Floats>;
using FloatVector = hn::Vec<Floats>;
using NumberVector = hn::Vec<Numbers>;
using Hits = hn::Mask<Numbers>;
using Writer = PairWriter<Numbers>;
static_assert(kept_width == Writer::at_once);

constexpr std::size_t lanes = hn::MaxLanes(Floats());

/// So many steps ahead, a leaf is asked for.
constexpr std::size_t ahead = 3;

/// One box, in every lane.
template <int D>
struct Query {
  HWY_INLINE explicit Query(const Box<D>& box) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis] = hn::Set(Floats(), box.min[axis]);
      max[axis] = hn::Set(Floats(), box.max[axis]);
    }
  }

  /// Which of the boxes from lane `at` on it overlaps.
  HWY_INLINE Hits touching(const KeptBounds<D>& boxes, std::size_t at) const {
    const Floats floats;
    auto hits = hn::Le(hn::Load(floats, boxes.min[0] + at), max[0]);
    hits = hn::And(hits, hn::Le(min[0], hn::Load(floats, boxes.max[0] + at)));
    for (int axis = 1; axis < D; ++axis) {
      hits = hn::And(hits, hn::Le(hn::Load(floats, boxes.min[axis] + at), max[axis]));
      hits = hn::And(hits, hn::Le(min[axis], hn::Load(floats, boxes.max[axis] + at)));
    }
    return hn::RebindMask(Numbers(), hits);
  }

  FloatVector min[D];
  FloatVector max[D];
};

template <int D>
HWY_INLINE void prefetch(const KeptTree<D>& tree, std::size_t leaf) {
  const auto* const line = reinterpret_cast<const char*>(tree.nodes[0] + leaf);
  for (std::size_t at = 0; at < sizeof(KeptBounds<D>); at += 64) hwy::Prefetch(line + at);
  hwy::Prefetch(tree.ids + leaf * kept_width);
}

template <int D>
class Follow {
 public:
  HWY_INLINE Follow(const KeptTree<D>& tree, PairSink& begun, PairSink& ended)
      : tree_(tree), begun_(begun), ended_(ended) {}

  Followed run(std::span<const KeptStep<D>> steps, std::uint32_t* left) {
    Followed done;
    for (std::size_t i = 0; i < steps.size(); ++i) {
      if (i + ahead < steps.size()) {
        const std::size_t leaf = steps[i + ahead].place / kept_width;
        prefetch(tree_, leaf);
        hwy::Prefetch(tree_.nodes[1] + leaf / kept_width);
      }
      const KeptStep<D>& step = steps[i];
      if (step.is_far) {
        look(step, step.before);
        look(step, step.now);
      } else {
        look(step, both(step));
      }
      if (!step.writes) continue;
      write(step);
      left[done.left] = static_cast<std::uint32_t>(i);
      done.left += static_cast<std::size_t>(widen(step));
    }
    done.tests = leaves_ * kept_width;
    return done;
  }

 private:
  static HWY_INLINE Box<D> both(const KeptStep<D>& step) {
    Box<D> box;
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = std::min(step.before.min[axis], step.now.min[axis]);
      box.max[axis] = std::max(step.before.max[axis], step.now.max[axis]);
    }
    return box;
  }

  HWY_INLINE void look(const KeptStep<D>& step, const Box<D>& box) {
    const Numbers numbers;
    const Query<D> query(box);
    std::uint32_t* from = tree_.lists[0];
    std::uint32_t* to = tree_.lists[1];
    from[0] = 0;
    std::size_t count = 1;
    for (std::size_t level = tree_.top; level > 0; --level) {
      std::size_t found = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const KeptBounds<D>& node = tree_.nodes[level][from[i]];
        for (std::size_t at = 0; at < kept_width; at += lanes) {
          // Infinite boxes overlap the absent one, too.
          const auto filled =
              hn::Le(hn::Load(Floats(), node.min[0] + at), hn::Load(Floats(), node.max[0] + at));
          const Hits hits = hn::And(query.touching(node, at), hn::RebindMask(numbers, filled));
          const auto first = static_cast<std::uint32_t>(from[i] * kept_width + at);
          hn::StoreU(compress(numbers, hn::Iota(numbers, first), hits), numbers, to + found);
          found += hn::CountTrue(numbers, hits);
        }
      }
      std::swap(from, to);
      count = found;
    }
    for (std::size_t i = 0; i < count; ++i) prefetch(tree_, from[i]);
    for (std::size_t i = 0; i < count; ++i) compare(step, from[i]);
    leaves_ += count;
  }

  HWY_INLINE void compare(const KeptStep<D>& step, std::uint32_t leaf) {
    const Numbers numbers;
    const Query<D> before(step.before);
    const Query<D> now(step.now);
    const NumberVector id = hn::Set(numbers, step.id);
    const KeptBounds<D>& boxes = tree_.nodes[0][leaf];
    for (std::size_t at = 0; at < kept_width; at += lanes) {
      const NumberVector ids = hn::LoadU(numbers, tree_.ids + leaf * kept_width + at);
      const Hits is_other = hn::And(hn::Ne(ids, id), hn::Ne(ids, hn::Set(numbers, no_box)));
      const Hits did = hn::And(is_other, before.touching(boxes, at));
      const Hits does = hn::And(is_other, now.touching(boxes, at));
      if (HWY_UNLIKELY(step.every)) {
        begun_.room();
        begun_.write_of(id, ids, hn::Or(did, does));
      } else if (!hn::AllFalse(numbers, hn::Xor(did, does))) {
        begun_.room();
        begun_.write_of(id, ids, hn::AndNot(did, does));
        ended_.room();
        ended_.write_of(id, ids, hn::AndNot(does, did));
      }
    }
  }

  HWY_INLINE void write(const KeptStep<D>& step) {
    KeptBounds<D>& boxes = tree_.nodes[0][step.place / kept_width];
    for (int axis = 0; axis < D; ++axis) {
      boxes.min[axis][step.place % kept_width] = step.stored.min[axis];
      boxes.max[axis][step.place % kept_width] = step.stored.max[axis];
    }
  }

  /// Whether the leaf's own bounds had to be widened.
  HWY_INLINE bool widen(const KeptStep<D>& step) {
    std::size_t element = step.place / kept_width;
    for (std::size_t level = 1; level <= tree_.top; ++level) {
      KeptBounds<D>& node = tree_.nodes[level][element / kept_width];
      const std::size_t lane = element % kept_width;
      bool widens = false;
      for (int axis = 0; axis < D; ++axis) {
        widens |=
            step.stored.min[axis] < node.min[axis][lane] || step.stored.max[axis] > node.max[axis][lane];
        node.min[axis][lane] = std::min(node.min[axis][lane], step.stored.min[axis]);
        node.max[axis][lane] = std::max(node.max[axis][lane], step.stored.max[axis]);
      }
      if (!widens) return level > 1;
      element /= kept_width;
    }
    return true;
  }

  const KeptTree<D>& tree_;
  Writer begun_;
  Writer ended_;
  std::uint64_t leaves_ = 0;
};

template <int D>
void refit_level(const KeptTree<D>& tree, std::size_t level, std::span<const std::uint32_t> children) {
  const Floats floats;
  for (const std::uint32_t child : children) {
    const KeptBounds<D>& below = tree.nodes[level - 1][child];
    KeptBounds<D>& node = tree.nodes[level][child / kept_width];
    for (int axis = 0; axis < D; ++axis) {
      auto min = hn::Load(floats, below.min[axis]);
      auto max = hn::Load(floats, below.max[axis]);
      for (std::size_t at = lanes; at < kept_width; at += lanes) {
        min = hn::Min(min, hn::Load(floats, below.min[axis] + at));
        max = hn::Max(max, hn::Load(floats, below.max[axis] + at));
      }
      node.min[axis][child % kept_width] = hn::GetLane(hn::MinOfLanes(floats, min));
      node.max[axis][child % kept_width] = hn::GetLane(hn::MaxOfLanes(floats, max));
    }
  }
}

/// By how much each child of a node would have to grow for a box, and how large it is. A child without room
/// costs infinitely much; one without boxes as much as the box is large.
template <int D>
std::uint32_t choose(const KeptTree<D>& tree, const Box<D>& box) {
  const Floats floats;
  const Numbers numbers;
  const Query<D> query(box);
  const auto zero = hn::Zero(floats);
  const auto never = hn::Set(floats, std::numeric_limits<float>::infinity());
  auto alone = zero;
  for (int axis = 0; axis < D; ++axis) alone = hn::Add(alone, hn::Sub(query.max[axis], query.min[axis]));
  std::uint32_t element = 0;
  for (std::size_t level = tree.top; level > 0; --level) {
    const KeptBounds<D>& node = tree.nodes[level][element];
    alignas(64) float growths[kept_width];
    alignas(64) float sizes[kept_width];
    for (std::size_t at = 0; at < kept_width; at += lanes) {
      auto growth = zero;
      auto size = zero;
      for (int axis = 0; axis < D; ++axis) {
        const auto min = hn::Load(floats, node.min[axis] + at);
        const auto max = hn::Load(floats, node.max[axis] + at);
        growth = hn::Add(growth, hn::Max(zero, hn::Sub(min, query.min[axis])));
        growth = hn::Add(growth, hn::Max(zero, hn::Sub(query.max[axis], max)));
        size = hn::Add(size, hn::Sub(max, min));
      }
      const auto min = hn::Load(floats, node.min[0] + at);
      const auto max = hn::Load(floats, node.max[0] + at);
      growth = hn::IfThenElse(hn::Gt(min, max), alone, growth);
      growth =
          hn::IfThenElse(hn::Eq(growth, growth), growth, hn::Set(floats, std::numeric_limits<float>::max()));
      const auto room = hn::LoadU(numbers, tree.room[level - 1] + element * kept_width + at);
      const auto full = hn::RebindMask(floats, hn::Eq(room, hn::Zero(numbers)));
      hn::Store(hn::IfThenElse(full, never, growth), floats, growths + at);
      hn::Store(size, floats, sizes + at);
    }
    // Growth may be infinite where there is room, too.
    std::size_t best = kept_width;
    for (std::size_t lane = 0; lane < kept_width; ++lane) {
      if (tree.room[level - 1][element * kept_width + lane] == 0) continue;
      if (best == kept_width || growths[lane] < growths[best] ||
          (growths[lane] == growths[best] && sizes[lane] < sizes[best]))
        best = lane;
    }
    element = static_cast<std::uint32_t>(element * kept_width + best);
  }
  return element;
}

}  // namespace

// What the dispatch below can name: no templates.
Followed follow_2(const KeptTree<2>& tree, std::span<const KeptStep<2>> steps, std::uint32_t* left,
                  PairSink& begun, PairSink& ended) {
  return Follow<2>(tree, begun, ended).run(steps, left);
}
Followed follow_3(const KeptTree<3>& tree, std::span<const KeptStep<3>> steps, std::uint32_t* left,
                  PairSink& begun, PairSink& ended) {
  return Follow<3>(tree, begun, ended).run(steps, left);
}
void refit_2(const KeptTree<2>& tree, std::size_t level, std::span<const std::uint32_t> children) {
  refit_level(tree, level, children);
}
void refit_3(const KeptTree<3>& tree, std::size_t level, std::span<const std::uint32_t> children) {
  refit_level(tree, level, children);
}
std::uint32_t choose_leaf_2(const KeptTree<2>& tree, const Box<2>& box) { return choose(tree, box); }
std::uint32_t choose_leaf_3(const KeptTree<3>& tree, const Box<3>& box) { return choose(tree, box); }

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(follow_2);
HWY_EXPORT(follow_3);
HWY_EXPORT(refit_2);
HWY_EXPORT(refit_3);
HWY_EXPORT(choose_leaf_2);
HWY_EXPORT(choose_leaf_3);

template <>
Followed follow(const KeptTree<2>& tree, std::span<const KeptStep<2>> steps, std::uint32_t* left,
                PairSink& begun, PairSink& ended) {
  return HWY_DYNAMIC_DISPATCH(follow_2)(tree, steps, left, begun, ended);
}

template <>
Followed follow(const KeptTree<3>& tree, std::span<const KeptStep<3>> steps, std::uint32_t* left,
                PairSink& begun, PairSink& ended) {
  return HWY_DYNAMIC_DISPATCH(follow_3)(tree, steps, left, begun, ended);
}

template <>
void refit(const KeptTree<2>& tree, std::size_t level, std::span<const std::uint32_t> children) {
  HWY_DYNAMIC_DISPATCH(refit_2)(tree, level, children);
}

template <>
void refit(const KeptTree<3>& tree, std::size_t level, std::span<const std::uint32_t> children) {
  HWY_DYNAMIC_DISPATCH(refit_3)(tree, level, children);
}

template <>
std::uint32_t choose_leaf(const KeptTree<2>& tree, const Box<2>& box) {
  return HWY_DYNAMIC_DISPATCH(choose_leaf_2)(tree, box);
}

template <>
std::uint32_t choose_leaf(const KeptTree<3>& tree, const Box<3>& box) {
  return HWY_DYNAMIC_DISPATCH(choose_leaf_3)(tree, box);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

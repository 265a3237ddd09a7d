// The streamed segment tree.
//
// A pair is found in the region that holds the greater of its two minima on each axis. A region is cut in two
// at a median, on one axis; a box goes to each side that it touches. A box that covers its region on the cut
// axis and begins before it overlaps there every box that begins in the region: it is joined with these on
// the other axes alone, and not cut any further. So a long box is in few regions, where a plain tree of cells
// would hold it in all that it touches. Where one axis is left to tell boxes apart, a sweep along it tests
// pairs that overlap, and no others.
#include "algorithms/segment_join.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "core/sample.hpp"
#include "kernels/sweep.hpp"

namespace broadside::own {
namespace {

/// A sweep of so few boxes costs about what a further cut would.
constexpr std::size_t leaf_size = 384;

/// Of two lists, if one is as short as this, each of its boxes is swept against the other.
constexpr std::size_t short_list = 64;

constexpr std::size_t samples = 32;

/// From here on, samples have not halved the boxes: exact medians do.
constexpr int depth_of_medians = 48;

/// From so many boxes on a radix sort is the faster one.
constexpr std::size_t many_to_sort = 1024;

}  // namespace

template <int D>
Statistics SegmentJoin<D>::join(std::span<const Box<D>> boxes, std::size_t left_count, PairSink& pairs) {
  core::Sample<D> sample;
  sample.take(boxes);
  std::array<int, D> order = sample.axes_by_overlap();
  sorted_boxes_ = sorted_.sort(boxes, order);
  statistics_ = {};
  pairs_ = &pairs;
  stack_.clear();
  const auto push_all = [&](bool left) {
    const std::size_t begin = stack_.size();
    for (std::uint32_t i = 0; i < sorted_boxes_.size(); ++i) {
      if (left_count == 0 || (index(sorted_boxes_[i].id) < left_count) == left) stack_.push_back({i, 0});
    }
    return List{begin, stack_.size()};
  };
  constexpr std::uint32_t all_axes = (1U << D) - 1;
  const List first = push_all(true);
  if (left_count == 0)
    search({first, first, true, all_axes, 0});
  else
    search({first, push_all(false), false, all_axes, 0});
  return statistics_;
}

template <int D>
void SegmentJoin<D>::search(const Node& node) {
  if (node.is_self ? node.a.size() < 2 : node.a.size() == 0 || node.b.size() == 0) return;
  const bool is_short = !node.is_self && std::min(node.a.size(), node.b.size()) <= short_list;
  if (is_short || node.size() <= leaf_size || std::popcount(node.open) == 1) return sweep(node);
  Cut cut = choose(node);
  if (!set_range(node, cut)) return;  // no box begins here, so every pair is found elsewhere
  if (node.depth >= depth_of_medians) set_exact_median(node, cut);
  const std::size_t top = stack_.size();
  if (cut.low == cut.high)
    decide(node, cut);
  else
    cut_in_two(node, cut);
  stack_.resize(top);
}

/// All that begin in the region do so at one place: what does not end before it overlaps there.
template <int D>
void SegmentJoin<D>::decide(const Node& node, const Cut& cut) {
  const auto reaches = [&](const Reference& reference, std::uint32_t&) {
    return box(reference).max[cut.axis] >= cut.low;
  };
  const List a = push(node.a, reaches);
  const List b = node.is_self ? a : push(node.b, reaches);
  search({a, b, node.is_self, node.open & ~(1U << cut.axis), node.depth + 1});
}

template <int D>
void SegmentJoin<D>::cut_in_two(const Node& node, const Cut& cut) {
  const std::uint32_t bit = 1U << cut.axis;
  const std::size_t top = stack_.size();
  const auto spans = [&](const Reference& reference, std::uint32_t&) { return covers(reference, cut); };
  const auto begins = [&](const Reference& reference, std::uint32_t&) { return (reference.apart & bit) == 0; };
  const auto join_spanning = [&](const List& spanning, const List& others) {
    const List long_ones = push(spanning, spans);
    if (long_ones.size() > 0)
      search({long_ones, push(others, begins), false, node.open & ~bit, node.depth + 1});
    stack_.resize(top);
  };
  join_spanning(node.a, node.b);
  if (!node.is_self) join_spanning(node.b, node.a);
  const auto search_side = [&](auto wanted) {
    const List a = push(node.a, wanted);
    const List b = node.is_self ? a : push(node.b, wanted);
    search({a, b, node.is_self, node.open, node.depth + 1});
    stack_.resize(top);
  };
  search_side([&](const Reference& reference, std::uint32_t&) {
    const Box<D>& b = box(reference);
    return b.min[cut.axis] < cut.at && b.max[cut.axis] >= cut.low && !covers(reference, cut);
  });
  search_side([&](const Reference& reference, std::uint32_t& apart) {
    const Box<D>& b = box(reference);
    if (b.max[cut.axis] < cut.at || covers(reference, cut)) return false;
    if (b.min[cut.axis] < cut.at) apart |= bit;
    return true;
  });
}

template <int D>
bool SegmentJoin<D>::covers(const Reference& reference, const Cut& cut) const {
  return (reference.apart >> cut.axis & 1U) != 0 && box(reference).max[cut.axis] >= cut.high;
}

template <int D>
template <typename Wanted>
auto SegmentJoin<D>::push(const List& list, Wanted wanted) -> List {
  const std::size_t begin = stack_.size();
  stack_.resize(begin + list.size());
  Reference* out = stack_.data() + begin;
  for (std::size_t i = list.begin; i < list.end; ++i) {
    Reference reference = stack_[i];
    const bool is_wanted = wanted(reference, reference.apart);
    *out = reference;
    out += is_wanted ? 1 : 0;
  }
  const auto end = static_cast<std::size_t>(out - stack_.data());
  stack_.resize(end);
  return {begin, end};
}

/// Chooses the axis on which a cut at the sample's median parts most boxes, or meets most that cover it.
template <int D>
auto SegmentJoin<D>::choose(const Node& node) -> Cut {
  std::array<Reference, samples> sampled;
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t at = (2 * i + 1) * node.size() / (2 * samples);
    sampled[i] =
        stack_[at < node.a.size() ? node.a.begin + at : node.b.begin + (at - node.a.size())];
  }
  Cut best{};
  std::size_t most = 0;
  for (int axis = 0; axis < D; ++axis) {
    if ((node.open >> axis & 1U) == 0) continue;
    std::array<float, samples> minima;
    std::size_t count = 0;
    for (const Reference& reference : sampled) {
      if ((reference.apart >> axis & 1U) == 0) minima[count++] = box(reference).min[axis];
    }
    std::sort(minima.begin(), minima.begin() + count);
    const float at = count == 0 ? 0 : minima[count / 2];
    const float high = count == 0 ? 0 : minima[count - 1];
    std::size_t parted = 1;
    for (const Reference& reference : sampled) {
      const Box<D>& b = box(reference);
      const bool is_covering = (reference.apart >> axis & 1U) != 0 && b.max[axis] >= high;
      parted += static_cast<std::size_t>(is_covering || !(b.min[axis] < at && b.max[axis] >= at));
    }
    if (count > 0 && minima[0] == high) parted = 1;
    if (parted <= most) continue;
    most = parted;
    best.axis = axis;
    best.at = at;
  }
  return best;
}

/// Sets the least and the greatest minimum in the region, and moves the cut between them. False if no box
/// begins in the region.
template <int D>
bool SegmentJoin<D>::set_range(const Node& node, Cut& cut) const {
  float low = std::numeric_limits<float>::infinity();
  float high = -low;
  float next = low;  // the least that is not the lowest, of those not above the cut
  bool any = false;
  const auto look_at = [&](const List& list) {
    for (std::size_t i = list.begin; i < list.end; ++i) {
      if ((stack_[i].apart >> cut.axis & 1U) != 0) continue;
      any = true;
      const float min = box(stack_[i]).min[cut.axis];
      low = std::min(low, min);
      high = std::max(high, min);
    }
  };
  look_at(node.a);
  if (!node.is_self) look_at(node.b);
  cut.low = low;
  cut.high = high;
  if (!(cut.at > low && cut.at <= high)) {
    // The median is the least: the cut goes behind it.
    next = high;
    const auto look_again = [&](const List& list) {
      for (std::size_t i = list.begin; i < list.end; ++i) {
        const float min = box(stack_[i]).min[cut.axis];
        if ((stack_[i].apart >> cut.axis & 1U) == 0 && min > low) next = std::min(next, min);
      }
    };
    look_again(node.a);
    if (!node.is_self) look_again(node.b);
    cut.at = next;
  }
  return any;
}

template <int D>
void SegmentJoin<D>::set_exact_median(const Node& node, Cut& cut) {
  minima_.clear();
  const auto take = [&](const List& list) {
    for (std::size_t i = list.begin; i < list.end; ++i) {
      if ((stack_[i].apart >> cut.axis & 1U) == 0) minima_.push_back(box(stack_[i]).min[cut.axis]);
    }
  };
  take(node.a);
  if (!node.is_self) take(node.b);
  const auto middle = minima_.begin() + static_cast<std::ptrdiff_t>(minima_.size() / 2);
  std::ranges::nth_element(minima_, middle);
  if (*middle > cut.low) cut.at = *middle;
}

/// Compares the node's boxes with each other, along an axis that may tell them apart.
template <int D>
void SegmentJoin<D>::sweep(const Node& node) {
  const int axis = std::countr_zero(node.open);
  statistics_.references += node.size();
  const kernels::Run<D> a = run_of(node.a, axis, run_a_);
  if (node.is_self)
    statistics_.tests += kernels::sweep(a, *pairs_);
  else
    statistics_.tests += kernels::sweep(a, run_of(node.b, axis, run_b_), *pairs_);
}

/// The list's boxes sorted along the axis.
template <int D>
kernels::Run<D> SegmentJoin<D>::run_of(const List& list, int axis, kernels::RunBuffer<D>& run) {
  run.clear();
  run.reserve(list.size());
  const auto append = [&](const Reference& reference) {
    Box<D> swept = box(reference);
    std::swap(swept.min[0], swept.min[axis]);
    std::swap(swept.max[0], swept.max[axis]);
    run.append(swept, sorted_boxes_[reference.place].id, reference.apart);
  };
  const std::span<Reference> references = std::span(stack_).subspan(list.begin, list.size());
  if (axis == 0) {
    for (const Reference& reference : references) append(reference);
    return run.view();
  }
  const std::span<core::KeyedPlace> keys = radix_.places(references.size());
  for (std::size_t i = 0; i < references.size(); ++i)
    keys[i] = {core::sort_key(box(references[i]).min[axis]), static_cast<std::uint32_t>(i)};
  if (references.size() >= many_to_sort) {
    for (const core::KeyedPlace& key : radix_.sort()) append(references[key.place]);
  } else {
    std::ranges::sort(keys, {}, [](const core::KeyedPlace& key) { return std::pair(key.key, key.place); });
    for (const core::KeyedPlace& key : keys) append(references[key.place]);
  }
  return run.view();
}

template class SegmentJoin<2>;
template class SegmentJoin<3>;

}  // namespace broadside::own

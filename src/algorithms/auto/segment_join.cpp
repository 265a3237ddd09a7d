// The streamed segment tree.
//
// A pair is found in the region that holds the greater of its two minima on each axis. A region is cut in two
// at a median, on one axis; a box goes to each side that it touches. On the cut axis, a box that begins
// before its region and covers it overlaps every box that begins in the region. It is joined with these on
// the other axes alone, and not cut any further. So a long box is in few regions, where a plain tree of cells
// would hold it in every cell that it touches. Where boxes can be disjoint on one axis only, a sweep along it
// tests only pairs that overlap.
#include "algorithms/auto/segment_join.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "core/sample.hpp"
#include "kernels/sweep.hpp"

namespace broadside::algorithm {
namespace {

/// Up to this many boxes a sweep costs about what a further cut would.
constexpr std::size_t leaf_size = 384;

/// A node with a list of at most this many boxes is not cut but swept.
constexpr std::size_t short_list = 64;

constexpr std::size_t samples = 32;

/// At this depth, sample medians have failed to halve the boxes; exact medians are used from here on.
constexpr int depth_of_medians = 48;

}  // namespace

template <int D>
Statistics SegmentJoin<D>::join(std::span<const Box<D>> boxes, std::size_t left_count,
                                const Box<D, double>* doubles, Checkpoint& checkpoint, PairSink& pairs) {
  core::Sample<D> sample;
  sample.take(boxes);
  std::array<int, D> order = sample.axes_by_overlap();
  sorted_boxes_ = sorted_.sort(boxes, order);
  statistics_ = {};
  doubles_ = doubles;
  checkpoint_ = &checkpoint;
  pairs_ = &pairs;
  stack_.clear();
  const auto push_all = [&](bool left) {
    const std::size_t begin = stack_.size();
    for (std::uint32_t i = 0; i < sorted_boxes_.size(); ++i) {
      const core::SortedBox<D>& sorted = sorted_boxes_[i];
      // Another thread may have made the box invalid since the check. It could then be on both sides of every
      // cut.
      if (!is_present(sorted.box)) continue;
      if (left_count == 0 || (index(sorted.id) < left_count) == left) stack_.push_back({i, 0});
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
void SegmentJoin<D>::search(const SegmentNode& node) {
  if (node.is_self ? node.a.size() < 2 : node.a.size() == 0 || node.b.size() == 0) return;
  const bool is_short = !node.is_self && std::min(node.a.size(), node.b.size()) <= short_list;
  if (is_short || node.size() <= leaf_size || std::popcount(node.open) == 1) return sweep(node);
  SegmentCut cut = choose(node);
  if (!set_range(node, cut)) return;  // no box begins here, so every pair is found elsewhere
  if (node.depth >= depth_of_medians) set_exact_median(node, cut);
  const std::size_t top = stack_.size();
  if (cut.low == cut.high)
    decide(node, cut);
  else
    cut_in_two(node, cut);
  stack_.resize(top);
}

/// All boxes that begin here begin at one coordinate. Every box that reaches it overlaps them on this axis.
template <int D>
void SegmentJoin<D>::decide(const SegmentNode& node, const SegmentCut& cut) {
  const auto reaches = [&](const Reference& reference) { return box(reference).max[cut.axis] >= cut.low; };
  const List a = push(node.a, reaches);
  const List b = node.is_self ? a : push(node.b, reaches);
  search({a, b, node.is_self, node.open & ~(1U << cut.axis), node.depth + 1});
}

template <int D>
void SegmentJoin<D>::cut_in_two(const SegmentNode& node, const SegmentCut& cut) {
  const std::uint32_t bit = 1U << cut.axis;
  const SegmentParts a = part(node.a, cut);
  const SegmentParts b = node.is_self ? a : part(node.b, cut);
  const std::size_t top = stack_.size();
  const auto join_covering = [&](const List& covering, const List& others) {
    if (covering.size() == 0) return;
    const auto begins = [&](const Reference& reference) { return (reference.dedup_mask & bit) == 0; };
    search({covering, push(others, begins), false, node.open & ~bit, node.depth + 1});
    stack_.resize(top);
  };
  join_covering(a.covering, node.b);
  if (!node.is_self) join_covering(b.covering, node.a);
  search({a.below, b.below, node.is_self, node.open, node.depth + 1});
  search({a.above, b.above, node.is_self, node.open, node.depth + 1});
}

/// Pushes a list's parts: the boxes that begin before the region and cover it, and for each side of the cut
/// the others that touch it.
template <int D>
auto SegmentJoin<D>::part(const List& list, const SegmentCut& cut) -> SegmentParts {
  const std::size_t begin = stack_.size();
  const std::size_t size = list.size();
  stack_.resize(begin + 3 * size);
  Reference* const first = stack_.data() + begin;
  std::array<Reference*, 3> out = {first, first + size, first + 2 * size};
  for (const Reference& reference : std::span(stack_).subspan(list.begin, size)) {
    const float min = box(reference).min[cut.axis];
    const float max = box(reference).max[cut.axis];
    const std::uint32_t has_begun = reference.dedup_mask >> cut.axis & 1U;
    const bool covers = has_begun != 0 && max >= cut.high;
    // Always written, and kept only if it belongs there: a branch would be unpredictable.
    *out[0] = reference;
    out[0] += covers ? 1 : 0;
    *out[1] = reference;
    out[1] += !covers && min < cut.at && max >= cut.low ? 1 : 0;
    *out[2] = {reference.place, reference.dedup_mask | (min < cut.at ? 1U << cut.axis : 0U)};
    out[2] += !covers && max >= cut.at ? 1 : 0;
  }
  // Closes the gaps between the parts.
  const auto count = [&](int i) {
    return static_cast<std::size_t>(out[i] - (first + static_cast<std::size_t>(i) * size));
  };
  const std::array<std::size_t, 3> counts = {count(0), count(1), count(2)};
  std::copy(first + size, out[1], first + counts[0]);
  std::copy(first + 2 * size, out[2], first + counts[0] + counts[1]);
  const std::size_t below = begin + counts[0];
  const std::size_t above = below + counts[1];
  stack_.resize(above + counts[2]);
  return {{begin, below}, {below, above}, {above, above + counts[2]}};
}

template <int D>
template <typename Wanted>
auto SegmentJoin<D>::push(const List& list, Wanted wanted) -> List {
  const std::size_t begin = stack_.size();
  stack_.resize(begin + list.size());
  Reference* out = stack_.data() + begin;
  for (std::size_t i = list.begin; i < list.end; ++i) {
    const Reference reference = stack_[i];
    *out = reference;
    out += wanted(reference) ? 1 : 0;
  }
  const auto end = static_cast<std::size_t>(out - stack_.data());
  stack_.resize(end);
  return {begin, end};
}

/// Chooses the axis on which the sample's median cuts the fewest boxes that do not cover the region.
template <int D>
auto SegmentJoin<D>::choose(const SegmentNode& node) -> SegmentCut {
  std::array<Reference, samples> sampled;
  for (std::size_t i = 0; i < samples; ++i) {
    const std::size_t at = (2 * i + 1) * node.size() / (2 * samples);
    sampled[i] = stack_[at < node.a.size() ? node.a.begin + at : node.b.begin + (at - node.a.size())];
  }
  SegmentCut best{};
  std::size_t max_parted = 0;
  for (int axis = 0; axis < D; ++axis) {
    if ((node.open >> axis & 1U) == 0) continue;
    std::array<float, samples> minima;
    std::size_t count = 0;
    for (const Reference& reference : sampled) {
      if ((reference.dedup_mask >> axis & 1U) == 0) minima[count++] = box(reference).min[axis];
    }
    std::sort(minima.data(), minima.data() + count);
    const float at = count == 0 ? 0 : minima[count / 2];
    const float high = count == 0 ? 0 : minima[count - 1];
    std::size_t parted = 1;
    for (const Reference& reference : sampled) {
      const Box<D>& b = box(reference);
      const bool is_covering = (reference.dedup_mask >> axis & 1U) != 0 && b.max[axis] >= high;
      parted += static_cast<std::size_t>(is_covering || !(b.min[axis] < at && b.max[axis] >= at));
    }
    if (count > 0 && minima[0] == high) parted = 1;
    if (parted <= max_parted) continue;
    max_parted = parted;
    best.axis = axis;
    best.at = at;
  }
  return best;
}

/// Sets the least and the greatest minimum in the region, and moves the cut between them if it is not there.
/// False if no box begins in the region.
template <int D>
bool SegmentJoin<D>::set_range(const SegmentNode& node, SegmentCut& cut) const {
  float low = std::numeric_limits<float>::infinity();
  float high = -low;
  bool any = false;
  for_minima(node, cut.axis, [&](float min) {
    any = true;
    low = std::min(low, min);
    high = std::max(high, min);
  });
  cut.low = low;
  cut.high = high;
  if (!(cut.at > low && cut.at <= high)) {
    // The median is the least minimum: cut at the next greater one.
    cut.at = high;
    for_minima(node, cut.axis, [&](float min) {
      if (min > low) cut.at = std::min(cut.at, min);
    });
  }
  return any;
}

template <int D>
void SegmentJoin<D>::set_exact_median(const SegmentNode& node, SegmentCut& cut) {
  minima_.clear();
  for_minima(node, cut.axis, [this](float min) { minima_.push_back(min); });
  const float median = core::median(minima_);
  if (median > cut.low) cut.at = median;
}

/// Sweeps the node's boxes along an axis on which they may be disjoint.
template <int D>
void SegmentJoin<D>::sweep(const SegmentNode& node) {
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
    run.append(swept, sorted_boxes_[reference.place].id, reference.dedup_mask);
  };
  const std::span<const Reference> references = std::span(stack_).subspan(list.begin, list.size());
  if (axis == 0) {
    for (const Reference& reference : references) append(reference);
  } else {
    const std::span<core::KeyedPlace> keys = radix_.places(references.size());
    for (std::size_t i = 0; i < references.size(); ++i)
      keys[i] = {core::sort_key(box(references[i]).min[axis]), static_cast<std::uint32_t>(i)};
    for (const core::KeyedPlace& key : radix_.sort()) append(references[key.place]);
  }
  return run.view(doubles_, checkpoint_);
}

template class SegmentJoin<2>;
template class SegmentJoin<3>;

}  // namespace broadside::algorithm

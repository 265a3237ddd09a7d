// The difference between the pairs of two frames, by their boxes.
#include "interface/pair_difference.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/prefetch.hpp"

namespace broadside::core {
namespace {

/// How many pairs ahead boxes are prefetched: finders write neighbours one after the other, but boxes may be
/// anywhere in their array.
constexpr std::size_t ahead = 16;

template <typename Box>
void prefetch_boxes(std::span<const Box> boxes, Pair pair) {
  prefetch(&boxes[index(pair.first)]);
  prefetch(&boxes[index(pair.second)]);
}

/// Whether two boxes, each of them present or absent, overlap: without a branch, which no predictor could
/// foresee.
template <int D, typename Real>
unsigned overlapping(const Box<D, Real>& a, const Box<D, Real>& b) {
  unsigned all = static_cast<unsigned>(a.min[0] <= a.max[0]) & static_cast<unsigned>(b.min[0] <= b.max[0]);
  for (int axis = 0; axis < D; ++axis) {
    all &= static_cast<unsigned>(a.min[axis] <= b.max[axis]);
    all &= static_cast<unsigned>(b.min[axis] <= a.max[axis]);
  }
  return all;
}

/// Whether a filter has changed: then a pair may differ whose boxes overlap in both frames.
template <int D, typename Real>
bool has_changed_filter(const Change<D, Real>& change) {
  return !change.filters_now.empty() && std::ranges::any_of(change.changed, [&](BoxId id) {
    return change.filters_before[index(id)] != change.filters_now[index(id)];
  });
}

/// Calls `report` for each of `pairs` with a changed box whose boxes do not overlap in `boxes`; unless
/// `by_boxes`, for every one with a changed box.
template <int D, typename Real, typename Report>
void for_differing(const Change<D, Real>& change, std::span<const Pair> pairs,
                   std::span<const Box<D, Real>> boxes, bool by_boxes, Report report) {
  constexpr std::size_t at_once = 256;
  std::array<Pair, at_once> differing;
  for (std::size_t begin = 0; begin < pairs.size(); begin += at_once) {
    const std::size_t end = std::min(begin + at_once, pairs.size());
    std::size_t count = 0;
    for (std::size_t i = begin; i < end; ++i) {
      if (i + ahead < pairs.size()) prefetch_boxes(boxes, pairs[i + ahead]);
      const std::uint32_t a = index(pairs[i].first);
      const std::uint32_t b = index(pairs[i].second);
      const unsigned goes_on = overlapping(boxes[a], boxes[b]) & static_cast<unsigned>(by_boxes);
      differing[count] = pairs[i];
      count += static_cast<std::size_t>((change.flags[a] | change.flags[b]) & (goes_on ^ 1U));
    }
    for (const Pair pair : std::span(differing).first(count)) report(pair);
  }
}

}  // namespace

template <int D, typename Real>
void report_differences(const Change<D, Real>& change, std::span<const Pair> found,
                        std::span<const Pair> kept, PairSink& begun, PairSink& ended) {
  const bool by_boxes = !has_changed_filter(change);
  for_differing<D, Real>(change, found, change.before, by_boxes, [&](Pair pair) {
    if (!change.held(pair.first, pair.second) && change.holds(pair.first, pair.second))
      begun.add(pair.first, pair.second);
  });
  for_differing<D, Real>(change, kept, change.now, by_boxes, [&](Pair pair) {
    if (!change.holds(pair.first, pair.second) && change.held(pair.first, pair.second))
      ended.add(pair.first, pair.second);
  });
}

template void report_differences(const Change<2>&, std::span<const Pair>, std::span<const Pair>, PairSink&,
                                 PairSink&);
template void report_differences(const Change<3>&, std::span<const Pair>, std::span<const Pair>, PairSink&,
                                 PairSink&);
template void report_differences(const Change<2, double>&, std::span<const Pair>, std::span<const Pair>,
                                 PairSink&, PairSink&);
template void report_differences(const Change<3, double>&, std::span<const Pair>, std::span<const Pair>,
                                 PairSink&, PairSink&);

}  // namespace broadside::core

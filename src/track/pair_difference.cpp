// The difference between the pairs of two frames, by their boxes.
#include "track/pair_difference.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/overlap_flags.hpp"

namespace broadside::track {
namespace {

/// Pairs that one of several threads compares at a time.
constexpr std::size_t pairs_at_once = 4096;

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
  std::array<std::uint8_t, at_once> goes_on;
  for (std::size_t begin = 0; begin < pairs.size(); begin += at_once) {
    const std::span<const Pair> some = pairs.subspan(begin, std::min(at_once, pairs.size() - begin));
    kernels::set_overlap_flags(boxes, some, goes_on.data());
    std::size_t count = 0;
    for (std::size_t i = 0; i < some.size(); ++i) {
      const unsigned is_changed = change.flags[index(some[i].first)] | change.flags[index(some[i].second)];
      differing[count] = some[i];
      count += is_changed & ((goes_on[i] & static_cast<unsigned>(by_boxes)) ^ 1U);
    }
    for (const Pair pair : std::span(differing).first(count)) report(pair);
  }
}

}  // namespace

template <int D, typename Real>
void report_differences(const Change<D, Real>& change, std::span<const Pair> found,
                        std::span<const Pair> kept, core::Parallel& parallel, PairSink& begun,
                        PairSink& ended) {
  const bool by_boxes = !has_changed_filter(change);
  parallel.start(change.workers, (found.size() + kept.size()) / pairs_per_box);
  const auto report = [&](std::span<const Pair> pairs, std::span<const Box<D, Real>> other_frame,
                          PairSink& sink, auto is_event) {
    const std::size_t all_parts = (pairs.size() + pairs_at_once - 1) / pairs_at_once;
    parallel.search(all_parts, sink, [&](core::Range parts, std::size_t, PairSink& events) {
      const std::size_t begin = parts.begin * pairs_at_once;
      const std::size_t end = std::min(parts.end * pairs_at_once, pairs.size());
      for_differing<D, Real>(change, pairs.subspan(begin, end - begin), other_frame, by_boxes,
                             [&](Pair pair) {
                               if (is_event(pair)) events.add(pair.first, pair.second);
                             });
      return Statistics{};
    });
  };
  report(found, change.before, begun, [&change](Pair pair) {
    return !change.held(pair.first, pair.second) && change.holds(pair.first, pair.second);
  });
  report(kept, change.now, ended, [&change](Pair pair) {
    return !change.holds(pair.first, pair.second) && change.held(pair.first, pair.second);
  });
}

template void report_differences(const Change<2>&, std::span<const Pair>, std::span<const Pair>,
                                 core::Parallel&, PairSink&, PairSink&);
template void report_differences(const Change<3>&, std::span<const Pair>, std::span<const Pair>,
                                 core::Parallel&, PairSink&, PairSink&);
template void report_differences(const Change<2, double>&, std::span<const Pair>, std::span<const Pair>,
                                 core::Parallel&, PairSink&, PairSink&);
template void report_differences(const Change<3, double>&, std::span<const Pair>, std::span<const Pair>,
                                 core::Parallel&, PairSink&, PairSink&);

}  // namespace broadside::track

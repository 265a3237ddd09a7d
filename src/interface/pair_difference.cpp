// The difference between the pairs of two frames, by their boxes.
#include "interface/pair_difference.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "kernels/overlap_flags.hpp"

namespace broadside::core {
namespace {

/// Pairs that one of several threads compares at a time.
constexpr std::size_t pairs_at_once = 4096;

/// Pairs that take as long as one box of a search.
constexpr std::size_t pairs_a_box = 8;

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
                        std::span<const Pair> kept, const Workers& workers, Parallel& parallel,
                        PairSink& begun, PairSink& ended) {
  const bool by_boxes = !has_changed_filter(change);
  parallel.start(workers, (found.size() + kept.size()) / pairs_a_box);
  const auto parts_of = [](std::span<const Pair> pairs) {
    return (pairs.size() + pairs_at_once - 1) / pairs_at_once;
  };
  const auto part = [](std::span<const Pair> pairs, Range parts) {
    const std::size_t begin = parts.begin * pairs_at_once;
    return pairs.subspan(begin, std::min(parts.end * pairs_at_once, pairs.size()) - begin);
  };
  parallel.search(parts_of(found), begun, [&](Range parts, std::size_t, PairSink& sink) {
    for_differing<D, Real>(change, part(found, parts), change.before, by_boxes, [&](Pair pair) {
      if (!change.held(pair.first, pair.second) && change.holds(pair.first, pair.second))
        sink.add(pair.first, pair.second);
    });
    return Statistics{};
  });
  parallel.search(parts_of(kept), ended, [&](Range parts, std::size_t, PairSink& sink) {
    for_differing<D, Real>(change, part(kept, parts), change.now, by_boxes, [&](Pair pair) {
      if (!change.holds(pair.first, pair.second) && change.held(pair.first, pair.second))
        sink.add(pair.first, pair.second);
    });
    return Statistics{};
  });
}

template void report_differences(const Change<2>&, std::span<const Pair>, std::span<const Pair>,
                                 const Workers&, Parallel&, PairSink&, PairSink&);
template void report_differences(const Change<3>&, std::span<const Pair>, std::span<const Pair>,
                                 const Workers&, Parallel&, PairSink&, PairSink&);
template void report_differences(const Change<2, double>&, std::span<const Pair>, std::span<const Pair>,
                                 const Workers&, Parallel&, PairSink&, PairSink&);
template void report_differences(const Change<3, double>&, std::span<const Pair>, std::span<const Pair>,
                                 const Workers&, Parallel&, PairSink&, PairSink&);

}  // namespace broadside::core

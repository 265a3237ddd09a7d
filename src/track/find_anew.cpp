// FindAnew: compares the pairs of two frames.
#include "track/find_anew.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "broadside/sinks.hpp"

#include "kernels/overlap_flags.hpp"
#include "track/candidate_limit.hpp"

namespace broadside::track {
namespace {

/// The number of pairs that a thread compares at a time.
constexpr std::size_t pairs_at_once = 4096;

/// Whether a filter has changed. A pair may then begin or end while its boxes overlap in both frames.
template <int D, typename Real>
bool has_changed_filter(const Change<D, Real>& change) {
  return !change.filters_now.empty() &&
         std::any_of(change.changed.begin(), change.changed.end(), [&](BoxId id) {
           return change.filters_before[index(id)] != change.filters_now[index(id)];
         });
}

/// Calls `report` for each pair with a changed box; if `by_boxes`, leaves out those that overlap in `boxes`.
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

/// Writes the pairs that began and ended. `found` are all pairs that hold now, and `kept` all that held in
/// the frame before.
///
/// No pair is looked up in the other list: its boxes tell whether it was a pair in the other frame, and two
/// boxes at rest need no test. Most pairs persist, so that is tested first.
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

}  // namespace

template <int D, typename Real>
std::optional<Statistics> FindAnew<D, Real>::update(const Change<D, Real>& change, std::size_t max_pairs,
                                                    PairSink& begun, PairSink& ended) {
  const bool knows_before = std::exchange(has_pairs_, false) && !change.rebuild;
  if (!knows_before) find(change.before, change.filters_before, change.workers, max_pairs, pairs_);
  const std::optional<Statistics> statistics =
      find(change.now, change.filters_now, change.workers, max_pairs, found_);
  report_differences<D, Real>(change, found_, pairs_, parallel_, begun, ended);
  std::swap(pairs_, found_);
  has_pairs_ = true;
  return statistics;
}

template <int D, typename Real>
std::optional<Statistics> FindAnew<D, Real>::find(std::span<const Box<D, Real>> boxes,
                                                  std::span<const Filter> filters, const Workers& workers,
                                                  std::size_t max_pairs, std::vector<Pair>& pairs) {
  pairs.clear();
  if (max_pairs != no_limit) {
    CandidateCollector<D, Real> collector(pairs, max_pairs);
    const auto statistics = find_within_limits(boxes, filters, workers, collector);
    collector.flush();
    return statistics;
  }
  PairCollector collector(pairs);
  const auto statistics =
      search_.find(boxes, {.filters = {.filters = filters}, .workers = workers}, collector);
  collector.flush();
  return statistics;
}

template <int D, typename Real>
std::optional<Statistics> FindAnew<D, Real>::find_within_limits(std::span<const Box<D, Real>> boxes,
                                                                std::span<const Filter> filters,
                                                                const Workers& workers, PairSink& pairs) {
  LimitedTests<D> limited;
  return search_.find(boxes, {.filters = {.filters = filters}, .workers = workers, .successor = &limited},
                      pairs);
}

template class FindAnew<2, float>;
template class FindAnew<3, float>;
template class FindAnew<2, double>;
template class FindAnew<3, double>;

}  // namespace broadside::track

// FindAnew: compares the pairs of two frames.
#include "track/find_anew.hpp"

#include <algorithm>
#include <cstddef>
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

/// Calls write(some pairs, sink) for all pairs, `sink` having room for as many, and commits what it wrote.
template <typename Write>
void for_pairs(std::span<const Pair> pairs, core::Parallel& parallel, PairSink& sink, Write write) {
  const std::size_t all_parts = (pairs.size() + pairs_at_once - 1) / pairs_at_once;
  parallel.search(all_parts, sink, [&](core::Range parts, std::size_t, PairSink& events) {
    const std::size_t end = std::min(parts.end * pairs_at_once, pairs.size());
    for (std::size_t begin = parts.begin * pairs_at_once; begin < end; begin += PairSink::max_room) {
      const auto some = pairs.subspan(begin, std::min(PairSink::max_room, end - begin));
      events.commit(write(some, events.room(some.size())));
    }
    return Statistics{};
  });
}

/// Writes the pairs that began and ended. `found` are all pairs that hold now, and `kept` all that held in
/// the frame before.
///
/// No pair is looked up in the other list: its boxes tell whether it was a pair in the other frame, unless
/// filters have changed.
template <int D, typename Real>
void report_differences(const Change<D, Real>& change, std::span<const Pair> found,
                        std::span<const Pair> kept, core::Parallel& parallel, PairSink& begun,
                        PairSink& ended) {
  parallel.start(change.workers, (found.size() + kept.size()) / pairs_per_box);
  if (!has_changed_filter(change)) {
    for_pairs(found, parallel, begun, [&](std::span<const Pair> some, Pair* events) {
      return kernels::select_apart(change.before, some, events);
    });
    for_pairs(kept, parallel, ended, [&](std::span<const Pair> some, Pair* events) {
      return kernels::select_apart(change.now, some, events);
    });
    return;
  }
  for_pairs(found, parallel, begun, [&](std::span<const Pair> some, Pair* events) {
    return std::copy_if(some.begin(), some.end(), events,
                        [&](Pair pair) { return !change.held(pair.first, pair.second); }) -
           events;
  });
  for_pairs(kept, parallel, ended, [&](std::span<const Pair> some, Pair* events) {
    return std::copy_if(some.begin(), some.end(), events,
                        [&](Pair pair) { return !change.holds(pair.first, pair.second); }) -
           events;
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
void FindAnew<D, Real>::report(const Change<D, Real>& change, std::span<const Pair> found, PairSink& begun,
                               PairSink& ended) {
  report_differences<D, Real>(change, found, pairs_, parallel_, begun, ended);
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

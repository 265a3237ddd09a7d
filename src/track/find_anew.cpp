// FindAnew.
#include "track/find_anew.hpp"

#include <utility>

#include "broadside/sinks.hpp"

#include "core/grow.hpp"
#include "track/candidate_limit.hpp"
#include "track/pair_difference.hpp"

namespace broadside::track {

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
    CandidateCollector<D, Real> collector(pairs, {max_pairs});
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

template <int D, typename Real>
void FindAnew<D, Real>::forget() noexcept {
  core::give_back(pairs_, found_);
  has_pairs_ = false;
}

template class FindAnew<2, float>;
template class FindAnew<3, float>;
template class FindAnew<2, double>;
template class FindAnew<3, double>;

}  // namespace broadside::track

// find_pairs_batch(): the pairs of many small worlds in one call.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box_view.hpp"
#include "broadside/error.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"
#include "broadside/spec.hpp"

namespace broadside {

/// The pairs of many worlds, world by world: the rows of a matrix in CSR form.
struct BROADSIDE_CALLERS_VECTOR BatchPairs {
  std::vector<Pair> pairs;           ///< ids count from the first box of the pair's world
  std::vector<std::size_t> offsets;  ///< where each world's pairs begin; last, the number of all

  /// The pairs of one world; `world` must be less than offsets.size() - 1.
  [[nodiscard]] std::span<const Pair> of(std::size_t world) const {
    return {pairs.data() + offsets[world], offsets[world + 1] - offsets[world]};
  }
};

namespace detail {

/// Writes the pairs of all worlds to `pairs` and flushes it. `pair_offsets` is as long as `offsets`. Lists
/// invalid boxes in `quarantined`; if that is null, throws InvalidInput for the first one.
template <int D, typename Real>
BROADSIDE_PUBLIC void find_pairs_batch(BoxView<D, Real> boxes, std::span<const std::size_t> offsets,
                                       const Spec& algorithm, const Workers& workers,
                                       const PairFilters& filters, PairSink& pairs,
                                       std::span<std::size_t> pair_offsets, bool touching,
                                       Output<BoxId>* quarantined);

template <int D, typename Real>
BROADSIDE_CALLERS_VECTOR BatchPairs find_pairs_batch(BoxView<D, Real> boxes,
                                                     std::span<const std::size_t> offsets,
                                                     const FindOptions& options) {
  Workers workers = Finder<D, Real>(options.algorithm).workers();
  workers.executor = options.executor;
  const PairFilters filters{options.filters, options.right_filters, options.ignored};
  BatchPairs found;
  found.offsets.resize(offsets.size());
  std::vector<BoxId> places;
  OutputTo<std::vector<BoxId>> quarantined(places);
  PairCollector collector(found.pairs, boxes.size());
  find_pairs_batch(boxes, offsets, options.algorithm, workers, filters, static_cast<PairSink&>(collector),
                   found.offsets, options.touching, options.quarantined == nullptr ? nullptr : &quarantined);
  if (options.quarantined != nullptr) *options.quarantined = std::move(places);
  return found;
}

}  // namespace detail

/// Finds the pairs of every world: world i has the boxes from offsets[i] up to offsets[i + 1]. The pairs
/// and their order are those of find_pairs() for each world in turn. Ids count from the world's first box.
///
///     const BatchPairs found = find_pairs_batch(boxes, offsets, {.algorithm = AutoOptions{.threads = 0}});
///     for (const Pair pair : found.of(world)) ...
///
/// The first offset must be 0, none may be less than the one before, and the last must be boxes.size();
/// otherwise throws InvalidFrame. Filters are one for each of `boxes`. Ignored pairs are ids within a world,
/// and are ignored in every world. Quarantined boxes are listed by their places in `boxes`; InvalidInput has
/// the place as well, and its message also the world. `right_filters` must be empty.
///
/// With several threads, these share the worlds; a world with a large part of all boxes is searched by all of
/// them. Keeps memory from world to world, so that a world costs little beside its search.
template <typename Boxes>
[[nodiscard]] BatchPairs find_pairs_batch(const Boxes& boxes, std::span<const std::size_t> offsets,
                                          const FindOptions& options = {}) {
  if constexpr (BoxRange<Boxes>)
    return detail::find_pairs_batch(detail::ViewOf<Boxes>(boxes), offsets, options);
  else
    detail::refuse_boxes<Boxes>();
}

}  // namespace broadside

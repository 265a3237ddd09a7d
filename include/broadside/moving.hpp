// find_pairs_moving(): the pairs of boxes that overlap at the same time while they move through a step.
#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/box_view.hpp"
#include "broadside/executor.hpp"
#include "broadside/export.hpp"
#include "broadside/filter.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"
#include "broadside/spec.hpp"

namespace broadside {

/// The times at which two boxes begin and stop overlapping in a step: 0 <= enter <= leave <= 1.
struct OverlapTime {
  double enter;
  double leave;

  friend constexpr bool operator==(const OverlapTime&, const OverlapTime&) = default;
};

/// Returns when two present boxes overlap, or nothing if they never do. Each bound moves at a constant speed
/// from its position in `from` at time 0 to its position in `to` at time 1. Boxes are closed, so a contact at
/// a single time counts, with enter = leave. A bound that is infinite at time 0 or 1 is infinite throughout.
///
/// Two boxes overlap at some time unless one pair of bounds meets only after another pair has parted. To
/// decide this, the function computes the distances of the bounds at times 0 and 1, each rounded to double,
/// and compares products of two distances, also rounded. The result is exact if the distances and products
/// are exact, as with whole numbers below 2^25. If only the distances are exact, no pair is missed, but a
/// pair that misses by 2^-52 of a product may count. The distances of floats are exact unless the floats
/// differ in size by a factor of 2^29. The times are quotients of the distances, rounded twice. No distance
/// is too large or too small for this, unless two bounds are 2^1500 times as far apart at one time as at the
/// other.
///
/// The function is compiled into the library, so that every program rounds in the same way.
template <int D, typename Real>
[[nodiscard]] BROADSIDE_PUBLIC std::optional<OverlapTime> overlap_time(const Box<D, Real>& from_a,
                                                                       const Box<D, Real>& to_a,
                                                                       const Box<D, Real>& from_b,
                                                                       const Box<D, Real>& to_b) noexcept;

namespace detail {

/// A set of boxes at the beginning and at the end of a step.
template <int D, typename Real>
struct MovingBoxes {
  BoxView<D, Real> from;
  BoxView<D, Real> to;
};

/// Writes the pairs of one set if `right` is null, otherwise those of two sets, and flushes. Lists invalid
/// boxes in `quarantined`; if that is null, throws InvalidInput for the first invalid box.
template <int D, typename Real>
BROADSIDE_PUBLIC void find_pairs_moving(const MovingBoxes<D, Real>& boxes, const MovingBoxes<D, Real>* right,
                                        PairSink& pairs, const Spec& algorithm, const Workers& workers,
                                        const PairFilters& filters, bool touching,
                                        Output<BoxId>* quarantined);

template <int D, typename Real>
BROADSIDE_CALLERS_VECTOR void find_pairs_moving(const MovingBoxes<D, Real>& boxes,
                                                const MovingBoxes<D, Real>* right, PairSink& pairs,
                                                const FindOptions& options) {
  Workers workers = Finder<D, Real>(options.algorithm).workers();
  workers.executor = options.executor;
  std::vector<BoxId> places;
  OutputTo<std::vector<BoxId>> quarantined(places);
  find_pairs_moving(boxes, right, pairs, options.algorithm, workers,
                    {options.filters, options.right_filters, options.ignored}, options.touching,
                    options.quarantined == nullptr ? nullptr : &quarantined);
  if (options.quarantined != nullptr) *options.quarantined = std::move(places);
}

/// Sets times[i] to the overlap time of pairs[i]: {infinity, -infinity} for a pair that never overlaps.
template <int D, typename Real>
BROADSIDE_PUBLIC void set_overlap_times(const MovingBoxes<D, Real>& left, const MovingBoxes<D, Real>& right,
                                        std::span<const Pair> pairs, std::span<OverlapTime> times);

template <int D, typename Real>
MovingBoxes<D, Real> moving(BoxView<D, Real> from, BoxView<D, Real> to) {
  return {from, to};
}

}  // namespace detail

/// Writes each pair of boxes that overlap at some time of a step once, as indexes into `from`, and flushes.
/// `from` has the boxes at the beginning of the step, `to` those at its end; overlap_time() defines which
/// pairs overlap. Two boxes that pass through the same place one after the other are not a pair. A box that
/// is absent at one of the two times pairs with nothing.
///
///     find_pairs_moving(positions, next_positions, [&](Pair pair) { ... });
///
/// Finds the pairs of the swept boxes, merged(from[i], to[i]), and tests each of them. `pairs` and `options`
/// are those of find_pairs(); the algorithm and the boxes determine the order of pairs. Throws what
/// find_pairs() throws; InvalidFrame if the lengths of `from` and `to` differ; std::invalid_argument if
/// options.touching is false. Nothing has been written then.
template <BoxRange From, BoxRange To, PairTarget Target>
void find_pairs_moving(const From& from, const To& to, Target&& pairs, const FindOptions& options = {}) {
  using View = detail::ViewOf<From>;
  const auto boxes = detail::moving(View(from), View(to));
  detail::with_sink(pairs, [&](PairSink& sink) {
    detail::find_pairs_moving(boxes, static_cast<decltype(&boxes)>(nullptr), sink, options);
  });
}

/// Returns the same pairs in a vector.
template <BoxRange From, BoxRange To>
[[nodiscard]] std::vector<Pair> find_pairs_moving(const From& from, const To& to,
                                                  const FindOptions& options = {}) {
  return detail::collect_pairs(detail::box_count(from),
                               [&](PairSink& pairs) { find_pairs_moving(from, to, pairs, options); });
}

/// Writes each pair of a moving box of the left set and one of the right set that overlap at some time, and
/// flushes. A pair's `first` is an index into `from`, its `second` an index into `right_from`.
template <BoxRange From, BoxRange To, BoxRange RightFrom, BoxRange RightTo, PairTarget Target>
void find_pairs_moving(const From& from, const To& to, const RightFrom& right_from, const RightTo& right_to,
                       Target&& pairs, const FindOptions& options = {}) {
  using View = detail::ViewOf<From>;
  const auto right = detail::moving(View(right_from), View(right_to));
  detail::with_sink(pairs, [&](PairSink& sink) {
    detail::find_pairs_moving(detail::moving(View(from), View(to)), &right, sink, options);
  });
}

/// Returns the same pairs in a vector.
template <BoxRange From, BoxRange To, BoxRange RightFrom, BoxRange RightTo>
[[nodiscard]] std::vector<Pair> find_pairs_moving(const From& from, const To& to, const RightFrom& right_from,
                                                  const RightTo& right_to, const FindOptions& options = {}) {
  return detail::collect_pairs(detail::box_count(from, right_from), [&](PairSink& pairs) {
    find_pairs_moving(from, to, right_from, right_to, pairs, options);
  });
}

/// Returns the overlap_time() of each pair: {infinity, -infinity} for a pair that never overlaps. Throws
/// InvalidFrame if the lengths of `from` and `to` differ, or if an id is out of range.
template <BoxRange From, BoxRange To>
[[nodiscard]] std::vector<OverlapTime> overlap_times(const From& from, const To& to,
                                                     std::span<const Pair> pairs) {
  return overlap_times(from, to, from, to, pairs);
}

/// The same for pairs of two sets.
template <BoxRange From, BoxRange To, BoxRange RightFrom, BoxRange RightTo>
[[nodiscard]] std::vector<OverlapTime> overlap_times(const From& from, const To& to,
                                                     const RightFrom& right_from, const RightTo& right_to,
                                                     std::span<const Pair> pairs) {
  using View = detail::ViewOf<From>;
  std::vector<OverlapTime> found(pairs.size());
  detail::set_overlap_times(detail::moving(View(from), View(to)),
                            detail::moving(View(right_from), View(right_to)), pairs, found);
  return found;
}

}  // namespace broadside

// find_pairs_within(): the pairs of boxes within a Euclidean distance, and neighbour lists of pairs.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
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

/// The Euclidean distance of two present boxes: the square root of the sum of the squared gaps along each
/// axis, in order of the axes. The gap is 0 on an axis on which the boxes share a coordinate.
///
/// Each operation is rounded to double once, with unlimited exponents: a square neither overflows nor
/// vanishes. So distances of boxes of floats are exact up to four roundings, and those of whole numbers have
/// the last one only. The distance of boxes that overlap is 0, and no other. A gap to infinity is infinite.
///
/// It is compiled into the library, so that every program rounds it in the same way.
template <int D, typename Real>
[[nodiscard]] BROADSIDE_PUBLIC double distance(const Box<D, Real>& a, const Box<D, Real>& b) noexcept;

/// Whether the distance of two present boxes is at most `distance`, which must be finite and at least 0: the
/// sum of the squared gaps, rounded as for distance(), is compared with the square of `distance`, rounded in
/// the same way. If `distance` is 0, it is overlap().
template <int D, typename Real>
[[nodiscard]] BROADSIDE_PUBLIC bool is_within(const Box<D, Real>& a, const Box<D, Real>& b,
                                              double distance) noexcept;

/// The distance() of two present boxes in space that repeats: `periods` has a length for each axis after
/// which it does, or infinity if it does not. It is that of the images which are nearest on every axis.
///
/// First each box is moved by whole periods until its min is in [0, period]. Bounds that already are stay as
/// they are, to the bit; otherwise the min becomes its exact remainder, and the box keeps its length, both
/// rounded to double once. A box at least as long as the period becomes the whole axis. Then on each axis one
/// of the two boxes is moved back by a period, also rounded once, if that brings them nearer.
///
/// Throws InvalidQuery as find_pairs_within() does for periods.
template <int D, typename Real>
[[nodiscard]] BROADSIDE_PUBLIC double distance(const Box<D, Real>& a, const Box<D, Real>& b,
                                               std::span<const double> periods);

/// How near two boxes must be to count as a pair: one distance for all (a cutoff), or a radius for each box.
/// Two boxes with radii pair if their distance is at most the sum of the two, rounded to double. The radii
/// must outlive it.
class Reach {
 public:
  template <typename Number>
  requires std::integral<Number> || std::floating_point<Number> Reach(Number distance)
      : distance_(static_cast<double>(distance)) {}

  template <std::convertible_to<std::span<const double>> Radii>
  Reach(const Radii& radii) : radii_(radii), has_radii_(true) {}

  /// The radii of two sets.
  Reach(std::span<const double> left, std::span<const double> right)
      : radii_(left), right_radii_(right), has_radii_(true) {}

  /// The same reach in space that repeats: `periods` are those of distance(). With a distance of 0, boxes
  /// pair if they overlap around the edge.
  ///
  ///     find_pairs_within(atoms, Reach(cutoff).periodic({10.0, 10.0, 10.0}), ...)
  ///     find_pairs_within(parcels, Reach(0).periodic({360.0, infinity}), ...)     // longitude and latitude
  [[nodiscard]] Reach periodic(std::span<const double> periods) const {
    Reach result = *this;
    result.is_periodic_ = true;
    result.period_count_ = periods.size();
    for (std::size_t axis = 0; axis < periods_.size() && axis < periods.size(); ++axis)
      result.periods_[axis] = periods[axis];
    return result;
  }
  template <std::size_t Axes>
  [[nodiscard]] Reach periodic(const double (&periods)[Axes]) const {
    return periodic(std::span<const double>(periods));
  }

  [[nodiscard]] bool has_radii() const noexcept { return has_radii_; }
  [[nodiscard]] double distance() const noexcept { return distance_; }
  [[nodiscard]] std::span<const double> radii() const noexcept { return radii_; }
  [[nodiscard]] std::span<const double> right_radii() const noexcept { return right_radii_; }

  [[nodiscard]] bool is_periodic() const noexcept { return is_periodic_; }

  /// How many periods were given.
  [[nodiscard]] std::size_t period_count() const noexcept { return period_count_; }

  /// The periods of the first three axes.
  [[nodiscard]] std::span<const double> periods() const noexcept {
    return std::span(periods_).first(period_count_ < periods_.size() ? period_count_ : periods_.size());
  }

 private:
  double distance_ = 0;
  std::span<const double> radii_;
  std::span<const double> right_radii_;
  bool has_radii_ = false;
  bool is_periodic_ = false;
  std::size_t period_count_ = 0;
  std::array<double, 3> periods_{};
};

namespace detail {

/// Throws std::invalid_argument, for an option `touching` that is false.
[[noreturn]] BROADSIDE_PUBLIC void refuse_touching();

/// Writes the pairs of one set if `right` is null, otherwise of two, and flushes. Lists invalid boxes in
/// `quarantined`; if that is null, throws InvalidInput for the first one.
template <int D, typename Real>
BROADSIDE_PUBLIC void find_pairs_within(BoxView<D, Real> boxes, const BoxView<D, Real>* right,
                                        const Reach& reach, PairSink& pairs, const Spec& algorithm,
                                        const Workers& workers, const PairFilters& filters,
                                        Output<BoxId>* quarantined);

template <int D, typename Real>
BROADSIDE_CALLERS_VECTOR void find_pairs_within(BoxView<D, Real> boxes, const BoxView<D, Real>* right,
                                                const Reach& reach, PairSink& pairs,
                                                const FindOptions& options) {
  if (!options.touching) refuse_touching();
  Workers workers = Finder<D, Real>(options.algorithm).workers();
  workers.executor = options.executor;
  std::vector<BoxId> places;
  OutputTo<std::vector<BoxId>> quarantined(places);
  find_pairs_within(boxes, right, reach, pairs, options.algorithm, workers,
                    {options.filters, options.right_filters, options.ignored},
                    options.quarantined == nullptr ? nullptr : &quarantined);
  if (options.quarantined != nullptr) *options.quarantined = std::move(places);
}

/// Sets distances[i] to the distance of the boxes of pairs[i]: of the first from `left`, the second from
/// `right`. `periods` is empty if space does not repeat.
template <int D, typename Real>
BROADSIDE_PUBLIC void set_distances(BoxView<D, Real> left, BoxView<D, Real> right,
                                    std::span<const Pair> pairs, std::span<const double> periods,
                                    std::span<double> distances);

/// Throws InvalidFrame for more than 2^32 - 2 boxes.
BROADSIDE_PUBLIC void check_neighbour_count(std::size_t boxes);

/// Fills the neighbour lists of sorted pairs.
BROADSIDE_PUBLIC void set_neighbours(std::span<const Pair> sorted, bool is_full,
                                     std::span<std::size_t> offsets, std::span<BoxId> neighbours);

}  // namespace detail

/// Writes each pair of boxes with a distance of at most `reach` once, as indexes into `boxes`, and flushes:
/// the pairs with is_within(boxes[a], boxes[b], reach), or radii[a] + radii[b] for radii. Points are boxes
/// with min = max. `pairs` and `options` are those of find_pairs(). The algorithm, the boxes and the reach
/// determine the order of pairs.
///
///     find_pairs_within(boxes, 0.5, [&](Pair pair) { ... });
///
/// Throws what find_pairs() throws; InvalidQuery for a distance or a radius that is not a finite number of 0
/// or more, for a period that is not above 0, or if there is not one for each axis; InvalidFrame if there are
/// radii, but not one for each box; std::invalid_argument if options.touching is false. Nothing has been
/// written then.
template <BoxRange Boxes, PairTarget Target>
void find_pairs_within(const Boxes& boxes, const Reach& reach, Target&& pairs,
                       const FindOptions& options = {}) {
  using View = detail::ViewOf<Boxes>;
  detail::with_sink(pairs, [&](PairSink& sink) {
    detail::find_pairs_within(View(boxes), static_cast<const View*>(nullptr), reach, sink, options);
  });
}

/// Returns the same pairs in a vector.
template <BoxRange Boxes>
[[nodiscard]] std::vector<Pair> find_pairs_within(const Boxes& boxes, const Reach& reach,
                                                  const FindOptions& options = {}) {
  return detail::collect_pairs(detail::box_count(boxes),
                               [&](PairSink& pairs) { find_pairs_within(boxes, reach, pairs, options); });
}

/// Writes each pair of a box of `left` and a box of `right` within reach, and flushes. A pair's `first` is an
/// index into `left`, its `second` an index into `right`. With radii, `reach` has those of both sets.
template <BoxRange Left, BoxRange Right, PairTarget Target>
void find_pairs_within(const Left& left, const Right& right, const Reach& reach, Target&& pairs,
                       const FindOptions& options = {}) {
  using View = detail::ViewOf<Left>;
  const View of_right(right);
  detail::with_sink(
      pairs, [&](PairSink& sink) { detail::find_pairs_within(View(left), &of_right, reach, sink, options); });
}

/// Returns the same pairs in a vector.
template <BoxRange Left, BoxRange Right>
[[nodiscard]] std::vector<Pair> find_pairs_within(const Left& left, const Right& right, const Reach& reach,
                                                  const FindOptions& options = {}) {
  return detail::collect_pairs(detail::box_count(left, right), [&](PairSink& pairs) {
    find_pairs_within(left, right, reach, pairs, options);
  });
}

/// The distance() of the boxes of each pair, around the edge if there are `periods`. Pairs that
/// find_pairs_within() finds for a distance have none that is greater. Throws InvalidFrame for an id that is
/// out of range.
template <BoxRange Boxes>
[[nodiscard]] std::vector<double> distances(const Boxes& boxes, std::span<const Pair> pairs,
                                            std::span<const double> periods = {}) {
  return distances(boxes, boxes, pairs, periods);
}

/// The same for pairs of two sets.
template <BoxRange Left, BoxRange Right>
[[nodiscard]] std::vector<double> distances(const Left& left, const Right& right, std::span<const Pair> pairs,
                                            std::span<const double> periods = {}) {
  using View = detail::ViewOf<Left>;
  std::vector<double> found(pairs.size());
  detail::set_distances(View(left), View(right), pairs, periods, found);
  return found;
}

/// The neighbours of every box, box by box, ascending: the rows of a matrix in CSR form.
struct BROADSIDE_CALLERS_VECTOR Neighbours {
  std::vector<std::size_t> offsets;  ///< where each box's neighbours begin; last, the number of all
  std::vector<BoxId> ids;

  /// The neighbours of one box; `box` must be less than offsets.size() - 1.
  [[nodiscard]] std::span<const BoxId> of(std::size_t box) const {
    return {ids.data() + offsets[box], offsets[box + 1] - offsets[box]};
  }
};

/// Which neighbours a box of a pair has.
enum class NeighbourLists : std::uint8_t {
  half,  ///< the first box of a pair has the second: each pair once
  full   ///< each box of a pair has the other: each pair twice
};

/// The neighbour lists of pairs among `boxes` boxes, in any order. For pairs between two sets, `boxes` is the
/// number of left boxes, and lists are half: each left box has its right boxes. O(n) by radix sort.
///
///     const Neighbours near = neighbours(find_pairs_within(atoms, cutoff), atoms.size(),
///     NeighbourLists::full);
///
/// Throws InvalidFrame for an id that is out of range, or for more than 2^32 - 2 boxes.
[[nodiscard]] BROADSIDE_CALLERS_VECTOR inline Neighbours neighbours(std::vector<Pair> pairs,
                                                                    std::size_t boxes, NeighbourLists lists) {
  detail::check_neighbour_count(boxes);
  const bool is_full = lists == NeighbourLists::full;
  if (is_full) {
    for (Pair& pair : pairs) {
      if (pair.second < pair.first) pair = {pair.second, pair.first};
    }
  }
  std::vector<Pair> scratch;
  sort_pairs(pairs, scratch);
  Neighbours found;
  found.offsets.resize(boxes + 1);
  found.ids.resize(is_full ? 2 * pairs.size() : pairs.size());
  detail::set_neighbours(pairs, is_full, found.offsets, found.ids);
  return found;
}

}  // namespace broadside

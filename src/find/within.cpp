// Within: pairs within a Euclidean distance. Searches boxes that are enlarged outwards, and tests the pairs.
#include "broadside/within.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"

#include "algorithms/registry.hpp"
#include "core/filter_sink.hpp"
#include "core/input_check.hpp"
#include "core/large_array.hpp"
#include "core/message.hpp"
#include "core/number_text.hpp"
#include "core/parallel.hpp"
#include "find/deliver.hpp"
#include "find/periodic.hpp"
#include "find/search.hpp"
#include "find/spatial_order.hpp"
#include "kernels/squared_distances.hpp"

namespace broadside {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// The greatest gap of two boxes on any axis.
template <int D, typename Real>
double greatest_gap(const Box<D, Real>& a, const Box<D, Real>& b) {
  double greatest = 0;
  for (std::size_t axis = 0; axis < D; ++axis) greatest = std::max(greatest, kernels::gap(a, b, axis));
  return greatest;
}

/// The squared distance, with each gap times 2^-exponent.
template <int D, typename Real>
double scaled_square(const Box<D, Real>& a, const Box<D, Real>& b, int exponent) {
  double sum = 0;
  for (std::size_t axis = 0; axis < D; ++axis) {
    const double gap = std::ldexp(kernels::gap(a, b, axis), -exponent);
    sum += gap * gap;
  }
  return sum;
}

/// Whether sums of squares can be compared with the square of this number: no square overflows that is less,
/// and those that vanish are too small to matter.
bool has_plain_square(double number) { return number >= 1e-100 && number <= 1e100; }

/// The definition for any distance.
template <int D, typename Real>
bool are_within(const Box<D, Real>& a, const Box<D, Real>& b, double distance) {
  if (has_plain_square(distance)) return kernels::squared_distance(a, b) <= distance * distance;
  if (distance == 0) return greatest_gap(a, b) == 0;
  if (distance == infinite) return greatest_gap(a, b) < infinite;  // a sum of radii
  const int exponent = std::ilogb(distance);
  const double limit = std::ldexp(distance, -exponent);
  return scaled_square(a, b, exponent) <= limit * limit;
}

template <std::size_t D, typename Real>
bool are_within(const std::array<Real, D>& a, const std::array<Real, D>& b, double distance) {
  using PointBox = Box<static_cast<int>(D), Real>;
  return are_within(PointBox{a, a}, PointBox{b, b}, distance);
}

template <int D, typename Real>
double distance_of(const Box<D, Real>& a, const Box<D, Real>& b) {
  const double greatest = greatest_gap(a, b);
  if (has_plain_square(greatest)) return std::sqrt(kernels::squared_distance(a, b));
  if (greatest == 0 || greatest == infinite) return greatest;
  const int exponent = std::ilogb(greatest);
  return std::ldexp(std::sqrt(scaled_square(a, b, exponent)), exponent);
}

/// One distance for all pairs.
struct OneDistance {
  double operator()(Pair) const { return distance; }

  double distance;
};

/// The sum of two boxes' radii.
struct SumOfRadii {
  double operator()(Pair pair) const { return left[index(pair.first)] + right[index(pair.second)]; }

  const double* left;
  const double* right;
};

/// Passes on the pairs of shapes, which are boxes or points, within limit(pair) of each other, in the same
/// order, under their `ids` unless these are null.
template <typename Shape, typename Limit>
class WithinSink final : public core::FilterSink {
 public:
  WithinSink(const Shape* left, const Shape* right, const BoxId* ids, Limit limit, PairSink& target)
      : FilterSink(target), left_(left), right_(right), ids_(ids), limit_(limit) {}

  std::unique_ptr<FilterSink> onto(PairSink& target) const override {
    return std::make_unique<WithinSink>(left_, right_, ids_, limit_, target);
  }

 private:
  void consume(std::span<const Pair> pairs) override {
    while (!pairs.empty()) {
      const std::span<const Pair> some = pairs.first(std::min(pairs.size(), max_room));
      std::array<double, max_room> squares;
      kernels::set_squared_distances(left_, right_, some, squares.data());
      Pair* const out = target().room(some.size());
      std::size_t passed = 0;
      for (std::size_t i = 0; i < some.size(); ++i) {
        out[passed] = some[i];
        const double limit = limit_(some[i]);
        passed += (has_plain_square(limit)
                       ? squares[i] <= limit * limit
                       : are_within(left_[index(some[i].first)], right_[index(some[i].second)], limit))
                      ? 1
                      : 0;
      }
      if (ids_ != nullptr) std::transform(out, out + passed, out, [this](Pair pair) { return named(pair); });
      target().commit(passed);
      pairs = pairs.subspan(some.size());
    }
  }

  Pair named(Pair pair) const {
    const std::uint32_t a = ids_[index(pair.first)];
    const std::uint32_t b = ids_[index(pair.second)];
    const std::uint32_t swap =
        (a ^ b) & (0U - static_cast<std::uint32_t>(b < a));  // a branch would mispredict
    return {BoxId{a ^ swap}, BoxId{b ^ swap}};
  }

  const Shape* left_;
  const Shape* right_;
  const BoxId* ids_;
  Limit limit_;
};

void check_distance(double distance, const std::string& name) {
  if (distance >= 0 && distance < infinite) return;
  throw InvalidQuery(
      core::message({name, " is ", core::text_of(distance), "; expected a finite number of 0 or more"}));
}

void check_radii(std::span<const double> radii, std::size_t boxes, const char* set) {
  if (radii.size() != boxes)
    throw InvalidFrame(
        core::message({radii.size(), " radii for ", boxes, set, " boxes; expected one for each box"}));
  for (std::size_t i = 0; i < boxes; ++i) {
    if (!(radii[i] >= 0 && radii[i] < infinite))
      check_distance(radii[i], core::message({"the radius of", set, " box ", i}));
  }
}

/// How far a box is enlarged on each side. Two boxes overlap if their gap on every axis is at most the reach,
/// even after the gap, the sum of two radii and the square have been rounded: together by less than 2^-50.
double enlargement(double radius) {
  const double enlarged = radius * (1 + 0x1p-50) + std::numeric_limits<double>::denorm_min();
  return radius == 0 ? 0 : std::min(enlarged, std::numeric_limits<double>::max());
}

/// A Real below every number that rounds to the double `rounded`.
template <typename Real>
Real less_than(double rounded) {
  const auto number = static_cast<Real>(rounded);
  return number == -std::numeric_limits<Real>::infinity() ? number : detail::next_below(number);
}

/// Writes to `to` rather than returning a box: a copy of the box would have to wait for the stores of its
/// coordinates.
template <typename Real, int D, typename Given>
void enlarge_outwards(const Box<D, Given>& box, double by, Box<D, Real>& to) {
  if (!is_present(box)) {
    to = absent_box<D, Real>();
    return;
  }
  for (int axis = 0; axis < D; ++axis) {
    to.min[axis] = less_than<Real>(static_cast<double>(box.min[axis]) - by);
    to.max[axis] = -less_than<Real>(-static_cast<double>(box.max[axis]) - by);
  }
}

/// From this number of boxes on, which no cache of a core holds, sorting them by place pays: a search writes
/// the pairs of neighbours one after the other, and each looks up two boxes.
constexpr std::size_t min_sorted_boxes = std::size_t{1} << 15;

/// Boxes that are read, from anywhere in memory, before any is worked on: the reads then overlap.
constexpr std::size_t gathered_at_once = 256;

/// A set of boxes, in which some may be absent, and what is searched in their stead.
template <int D, typename Real>
struct Set {
  Set(BoxView<D, Real> view, std::vector<Box<D, Real>>& gathered, std::span<const double> set_radii)
      : boxes(find::array_of(view, gathered)), radii(set_radii) {}

  /// Whether all boxes are finite points.
  bool are_points() const {
    return std::all_of(boxes.begin(), boxes.end(), [](const Box<D, Real>& box) {
      bool is_point = true;
      for (std::size_t axis = 0; axis < D; ++axis)
        is_point &= box.min[axis] == box.max[axis] && std::isfinite(box.min[axis]);
      return is_point;
    });
  }

  /// Makes `enlarged`, and `points` if the boxes are finite points. If `sorts`, all of these, `boxes` and
  /// `radii` are by place in space, and no box may be absent.
  void prepare(const Reach& reach, bool as_points, bool sorts, core::Parallel& parallel) {
    find::SpatialOrder<D, Real> curve;
    std::span<const core::KeyedPlace> order;
    if (sorts) order = curve.sort(boxes, parallel);
    const std::size_t count = boxes.size();
    core::renew(enlarged, count);
    if (as_points) core::renew(points, count);
    if (sorts) core::renew(ids, count);
    if (sorts && !as_points) core::renew(sorted, count);
    if (sorts && reach.has_radii()) core::renew(sorted_radii, count);
    const auto by = enlargements(reach);
    parallel.for_ranges(count, [&](core::Range range, std::size_t) {
      std::array<Box<D, Real>, gathered_at_once> gathered;
      for (std::size_t begin = range.begin; begin < range.end; begin += gathered_at_once) {
        const std::size_t end = std::min(begin + gathered_at_once, range.end);
        for (std::size_t i = begin; sorts && i < end; ++i) gathered[i - begin] = boxes[order[i].place];
        const Box<D, Real>* const some = sorts ? gathered.data() : boxes.data() + begin;
        for (std::size_t i = begin; i < end; ++i) {
          const std::size_t place = sorts ? order[i].place : i;
          const Box<D, Real>& box = some[i - begin];
          enlarge_outwards(box, by(place), enlarged[i]);
          if (as_points) points[i] = box.min;
          if (!sorts) continue;
          ids[i] = BoxId(place);
          if (!as_points) sorted[i] = box;
          if (reach.has_radii()) sorted_radii[i] = radii[place];
        }
      }
    });
    if (!sorts) return;
    boxes = sorted;
    radii = sorted_radii;
  }

  /// How far each box is enlarged.
  auto enlargements(const Reach& reach) const {
    return [half = enlargement(reach.distance() / 2), set_radii = radii, has_radii = reach.has_radii()](
               std::size_t box) { return has_radii ? enlargement(set_radii[box]) : half; };
  }

  std::span<const Box<D, Real>> boxes;
  std::span<const double> radii;
  core::LargeArray<Box<D, Real>> enlarged{};
  core::LargeArray<Point<D, Real>> points{};
  core::LargeArray<Box<D, Real>> sorted{};
  core::LargeArray<double> sorted_radii{};
  core::LargeArray<BoxId> ids{};  // of sorted boxes
};

/// The periods. Throws InvalidQuery.
template <int D>
find::Periods<D> checked_periods(std::span<const double> periods, std::size_t count) {
  find::Periods<D> checked;
  if (count != D) {
    throw InvalidQuery(
        core::message({count, count == 1 ? " period" : " periods", " for boxes of ", D,
                       " dimensions; expected ", D, ", with infinity for an axis that does not repeat"}));
  }
  for (std::size_t axis = 0; axis < D; ++axis) {
    if (!(periods[axis] > 0)) {
      throw InvalidQuery(
          core::message({"the period of axis ", axis, " is ", core::text_of(periods[axis]),
                         "; expected a number above 0, or infinity for an axis that does not repeat"}));
    }
    checked[axis] = periods[axis];
  }
  return checked;
}

/// Finds the pairs within limit(pair) in space that repeats. `right` is `left` if there is one set.
template <int D, typename Real, typename Limit>
std::optional<Statistics> find_periodic(const Set<D, Real>& left, const Set<D, Real>& right,
                                        const Reach& reach, const find::Periods<D>& periods, Limit limit,
                                        find::Search<D, Real>& search, find::SearchOptions<D> options,
                                        PairSink& pairs) {
  const bool is_between = &left != &right;
  double most = enlargement(reach.distance() / 2);
  for (const std::span<const double> radii : {left.radii, right.radii}) {
    for (const double radius : radii) most = std::max(most, enlargement(radius));
  }
  const auto enlarge = [](const Box<D, double>& box, double by) {
    Box<D, Real> enlarged;
    enlarge_outwards(box, by, enlarged);
    return enlarged;
  };
  find::PeriodicSet<D, Real> left_places(left.boxes, periods);
  left_places.make_places(left.enlargements(reach), most, enlarge);
  find::PeriodicSet<D, Real> right_places(is_between ? right.boxes : std::span<const Box<D, Real>>(),
                                          periods);
  right_places.make_places(right.enlargements(reach), most, enlarge);
  core::check_count(left_places.places().size() + right_places.places().size());

  const core::PairSet* const ignored = core::PairSet::of(std::exchange(options.filters.ignored, nullptr));
  const std::vector<Filter> filters = left_places.filters_of_places(options.filters.filters);
  const std::vector<Filter> right_filters = right_places.filters_of_places(options.filters.right_filters);
  options.filters.filters = filters;
  options.filters.right_filters = right_filters;
  const auto is_within = [limit](const Box<D, double>& a, const Box<D, double>& b, Pair pair) {
    return are_within(a, b, limit(pair));
  };
  return core::search_through(
      find::PeriodicSink<D, Real, std::remove_const_t<decltype(is_within)>>(
          left_places, is_between ? right_places : left_places, periods, ignored, is_within, pairs),
      [&](PairSink& candidates) {
        return is_between
                   ? search.find_between(left_places.places(), right_places.places(), options, candidates)
                   : search.find(left_places.places(), options, candidates);
      });
}

template <int D, typename Real>
double distance_around(const Box<D, Real>& a, const Box<D, Real>& b, const find::Periods<D>& periods) {
  Box<D, double> moved_a = find::in_cell(a, periods);
  Box<D, double> moved_b = find::in_cell(b, periods);
  find::move_to_nearest(moved_a, moved_b, periods);
  return distance_of(moved_a, moved_b);
}

}  // namespace

void detail::refuse_touching() {
  throw std::invalid_argument("touching is false for pairs within a distance; expected true");
}

template <int D, typename Real>
double distance(const Box<D, Real>& a, const Box<D, Real>& b) noexcept {
  const core::DefaultEnvironment environment;
  const volatile double result = distance_of(a, b);
  return result;
}

template <int D, typename Real>
double distance(const Box<D, Real>& a, const Box<D, Real>& b, std::span<const double> periods) {
  const core::DefaultEnvironment environment;
  const volatile double result = distance_around<D, Real>(a, b, checked_periods<D>(periods, periods.size()));
  return result;
}

template <int D, typename Real>
bool is_within(const Box<D, Real>& a, const Box<D, Real>& b, double distance) noexcept {
  const core::DefaultEnvironment environment;
  const volatile bool result = are_within(a, b, distance);
  return result;
}

template <int D, typename Real>
void detail::find_pairs_within(BoxView<D, Real> view, const BoxView<D, Real>* right_view, const Reach& reach,
                               PairSink& pairs, const Spec& spec, const Workers& workers,
                               const PairFilters& filters, Output<BoxId>* quarantined) {
  const core::DefaultEnvironment environment;
  const bool is_between = right_view != nullptr;
  const std::size_t right_count = is_between ? right_view->size() : 0;
  core::check_count(view.size() + right_count);
  find::check_filters(filters, view.size(), is_between ? &right_count : nullptr);
  if (!reach.has_radii()) {
    check_distance(reach.distance(), "the distance");
  } else {
    check_radii(reach.radii(), view.size(), is_between ? " left" : "");
    check_radii(reach.right_radii(), right_count, " right");
  }
  const bool is_periodic = reach.is_periodic();
  find::Periods<D> periods{};
  if (is_periodic) periods = checked_periods<D>(reach.periods(), reach.period_count());

  const Algorithm& algorithm = algorithm::require_algorithm(spec.name);
  find::Search<D, Real> search(find::searchers_of<D>(algorithm, algorithm::settings_of(algorithm, spec)));
  std::vector<Box<D, Real>> gathered;
  std::vector<Box<D, Real>> right_gathered;
  Set<D, Real> left(view, gathered, reach.radii());
  Set<D, Real> right(is_between ? *right_view : BoxView<D, Real>(), right_gathered, reach.right_radii());
  const BadInput bad_input = quarantined == nullptr ? BadInput::reject : BadInput::quarantine;
  const std::size_t absent_left =
      search.check_and_count_absent(left.boxes, workers, bad_input, is_between ? "left " : "");
  const std::size_t absent_right = search.check_and_count_absent(right.boxes, workers, bad_input, "right ");
  if (quarantined != nullptr) {
    std::vector<BoxId> places;
    if (absent_left > 0) find::list_invalid(left.boxes, 0, places);
    if (absent_right > 0) find::list_invalid(right.boxes, left.boxes.size(), places);
    std::copy(places.begin(), places.end(), quarantined->resize(places.size()).begin());
  }

  core::Parallel parallel;
  parallel.start(workers, left.boxes.size() + right.boxes.size());
  const bool sorts = !is_periodic && !is_between && absent_left == 0 &&
                     left.boxes.size() >= min_sorted_boxes && filters.filters.empty() &&
                     (filters.ignored == nullptr || filters.ignored->empty());
  const bool as_points = !is_periodic && left.are_points() && right.are_points();
  if (!is_periodic) {
    left.prepare(reach, as_points, sorts, parallel);
    right.prepare(reach, as_points, false, parallel);
  }
  const Set<D, Real>& other = is_between ? right : left;
  const auto find_within = [&](auto limit, PairSink& sink) {
    // Candidates may overlap only as floats: their distance is tested anyway.
    const find::SearchOptions<D> options{filters, workers,    nullptr, absent_left + absent_right,
                                         false,   is_periodic};
    if (is_periodic) return find_periodic<D, Real>(left, other, reach, periods, limit, search, options, sink);
    const auto find_candidates = [&](PairSink& candidates) {
      return is_between ? search.find_between(left.enlarged, right.enlarged, options, candidates)
                        : search.find(left.enlarged, options, candidates);
    };
    const BoxId* const ids = sorts ? left.ids.data() : nullptr;
    const auto search_shapes = [&](const auto* lefts, const auto* rights) {
      return core::search_through(WithinSink(lefts, rights, ids, limit, sink), find_candidates);
    };
    return as_points ? search_shapes(left.points.data(), other.points.data())
                     : search_shapes(left.boxes.data(), other.boxes.data());
  };
  find::deliver(environment, pairs, [&](PairSink& sink) {
    return reach.has_radii() ? find_within(SumOfRadii{left.radii.data(), other.radii.data()}, sink)
                             : find_within(OneDistance{reach.distance()}, sink);
  });
}

template <int D, typename Real>
void detail::set_distances(BoxView<D, Real> left, BoxView<D, Real> right, std::span<const Pair> pairs,
                           std::span<const double> periods, std::span<double> distances) {
  const core::DefaultEnvironment environment;
  find::check_ids(pairs, left.size(), right.size());
  if (!periods.empty()) {
    const find::Periods<D> checked = checked_periods<D>(periods, periods.size());
    for (std::size_t i = 0; i < pairs.size(); ++i)
      distances[i] =
          distance_around<D, Real>(left[index(pairs[i].first)], right[index(pairs[i].second)], checked);
    return;
  }
  std::vector<Box<D, Real>> gathered;
  std::vector<Box<D, Real>> right_gathered;
  const Box<D, Real>* const lefts = find::array_of(left, gathered).data();
  const Box<D, Real>* const rights = find::array_of(right, right_gathered).data();
  kernels::set_squared_distances(lefts, rights, pairs, distances.data());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const bool is_plain = distances[i] >= 1e-190 && distances[i] <= 1e190;
    distances[i] = is_plain ? std::sqrt(distances[i])
                            : distance_of(lefts[index(pairs[i].first)], rights[index(pairs[i].second)]);
  }
}

#define BROADSIDE_WITHIN(D, Real)                                                                     \
  template double distance(const Box<D, Real>&, const Box<D, Real>&) noexcept;                        \
  template bool is_within(const Box<D, Real>&, const Box<D, Real>&, double) noexcept;                 \
  template void detail::find_pairs_within(BoxView<D, Real>, const BoxView<D, Real>*, const Reach&,    \
                                          PairSink&, const Spec&, const Workers&, const PairFilters&, \
                                          Output<BoxId>*);                                            \
  template double distance(const Box<D, Real>&, const Box<D, Real>&, std::span<const double>);        \
  template void detail::set_distances(BoxView<D, Real>, BoxView<D, Real>, std::span<const Pair>,      \
                                      std::span<const double>, std::span<double>);
BROADSIDE_WITHIN(2, float)
BROADSIDE_WITHIN(3, float)
BROADSIDE_WITHIN(2, double)
BROADSIDE_WITHIN(3, double)
#undef BROADSIDE_WITHIN

}  // namespace broadside

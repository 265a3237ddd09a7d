// Moving boxes: pairs that overlap at the same time. Searches the swept boxes, and tests the pairs.
#include "broadside/moving.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>
#include <tuple>

#include "broadside/error.hpp"

#include "core/filter_sink.hpp"
#include "core/float_environment.hpp"
#include "core/input_check.hpp"
#include "core/message.hpp"
#include "find/deliver.hpp"

namespace broadside {
namespace {

/// Two bounds that meet or part in a step: how far they are from each other before and after they do, in a
/// unit of its own, so that the product of two of these neither overflows nor underflows.
struct Crossing {
  double before;
  double after;

  Crossing() = default;
  Crossing(double before_it, double after_it) {
    int exponent = 0;
    std::ignore = std::frexp(std::max(before_it, after_it), &exponent);
    before = std::ldexp(before_it, 500 - exponent);
    after = std::ldexp(after_it, 500 - exponent);
  }

  double time() const { return before / (before + after); }
};

/// How far a max is beyond a min at the start and at the end of a step.
struct Distances {
  double at_start;
  double at_end;
};

Distances distances_between(double max, double min, double max_at_end, double min_at_end) {
  Distances found{max - min, max_at_end - min_at_end};
  if (std::isfinite(found.at_start) && std::isfinite(found.at_end)) return found;
  if (std::isfinite(max) && std::isfinite(min) && std::isfinite(max_at_end) && std::isfinite(min_at_end))
    return {max / 2 - min / 2, max_at_end / 2 - min_at_end / 2};  // it has overflowed
  // What is infinite at one of the two times is so throughout.
  if (std::isinf(found.at_start))
    found.at_end = found.at_start;
  else if (std::isinf(found.at_end))
    found.at_start = found.at_end;
  return found;
}

template <int D, typename Real>
std::optional<OverlapTime> time_of(const Box<D, Real>& from_a, const Box<D, Real>& to_a,
                                   const Box<D, Real>& from_b, const Box<D, Real>& to_b) {
  std::array<Crossing, std::size_t{2} * D> meeting;
  std::array<Crossing, std::size_t{2} * D> parting;
  std::size_t meetings = 0;
  std::size_t partings = 0;
  // Takes how far a max is beyond a min at both times. False if it never reaches it. A NaN, of bounds at
  // infinity, is no obstacle.
  const auto take = [&](const Distances& distances) {
    const auto [at_start, at_end] = distances;
    if (at_start < 0) {
      if (at_end < 0) return false;
      meeting[meetings++] = {-at_start, at_end};
    } else if (at_end < 0) {
      parting[partings++] = {at_start, -at_end};
    }
    return true;
  };
  for (std::size_t axis = 0; axis < D; ++axis) {
    const auto overlaps = [&](const Box<D, Real>& from, const Box<D, Real>& to,
                              const Box<D, Real>& from_other, const Box<D, Real>& to_other) {
      return take(distances_between(from.max[axis], from_other.min[axis], to.max[axis], to_other.min[axis]));
    };
    if (!overlaps(from_a, to_a, from_b, to_b) || !overlaps(from_b, to_b, from_a, to_a)) return std::nullopt;
  }
  OverlapTime found{0, 1};
  for (std::size_t i = 0; i < meetings; ++i) {
    const Crossing& one = meeting[i];
    for (std::size_t k = 0; k < partings; ++k) {
      // one.time() > parting[k].time(), without quotients
      if (one.before * parting[k].after > parting[k].before * one.after) return std::nullopt;
    }
    if (one.time() > found.enter) found.enter = one.time();
  }
  for (std::size_t k = 0; k < partings; ++k) {
    if (parting[k].time() < found.leave) found.leave = parting[k].time();
  }
  found.leave = std::max(found.leave, found.enter);  // which roundings may have exchanged
  return found;
}

template <int D, typename Real>
void check_ends(const detail::MovingBoxes<D, Real>& boxes) {
  if (boxes.from.size() == boxes.to.size()) return;
  throw InvalidFrame(core::message({boxes.to.size(), " boxes at the end of a step that begins with ",
                                    boxes.from.size(), "; expected as many"}));
}

/// The boxes that contain each box all the time. Of a box that is invalid at one time, that.
template <int D, typename Real>
std::vector<Box<D, Real>> swept_boxes(const detail::MovingBoxes<D, Real>& boxes) {
  check_ends(boxes);
  std::vector<Box<D, Real>> swept(boxes.from.size());
  for (std::size_t i = 0; i < swept.size(); ++i) {
    const Box<D, Real> from = boxes.from[i];
    const Box<D, Real> to = boxes.to[i];
    if (core::is_invalid(from) || core::is_invalid(to))
      swept[i] = core::is_invalid(from) ? from : to;
    else
      swept[i] = is_absent(from) || is_absent(to) ? absent_box<D, Real>() : merged(from, to);
  }
  return swept;
}

}  // namespace

template <int D, typename Real>
std::optional<OverlapTime> overlap_time(const Box<D, Real>& from_a, const Box<D, Real>& to_a,
                                        const Box<D, Real>& from_b, const Box<D, Real>& to_b) noexcept {
  const core::DefaultEnvironment environment;
  const std::optional<OverlapTime> found = time_of(from_a, to_a, from_b, to_b);
  if (!found) return std::nullopt;
  const volatile double enter = found->enter;
  const volatile double leave = found->leave;
  return OverlapTime{enter, leave};
}

template <int D, typename Real>
void detail::find_pairs_moving(const MovingBoxes<D, Real>& boxes, const MovingBoxes<D, Real>* right,
                               PairSink& pairs, const Spec& algorithm, const Workers& workers,
                               const PairFilters& filters, bool touching, Output<BoxId>* quarantined) {
  const core::DefaultEnvironment environment;
  if (!touching) throw std::invalid_argument("touching is false for moving boxes; expected true");
  Finder<D, Real> finder(algorithm);
  finder.set_workers(workers);
  if (quarantined != nullptr) finder.set_bad_input(BadInput::quarantine);
  const std::vector<Box<D, Real>> swept = swept_boxes(boxes);
  std::vector<Box<D, Real>> right_swept;
  if (right != nullptr) right_swept = swept_boxes(*right);
  const auto overlap_in_time = [left = boxes, other = right == nullptr ? boxes : *right](Pair pair,
                                                                                         Pair& to) {
    to = pair;
    const std::size_t a = index(pair.first);
    const std::size_t b = index(pair.second);
    return time_of<D, Real>(left.from[a], left.to[a], other.from[b], other.to[b]).has_value();
  };
  find::deliver(environment, pairs, [&](PairSink& sink) {
    return core::search_through(core::PassingSink(overlap_in_time, sink), [&](PairSink& candidates) {
      return right == nullptr ? finder.find(swept, candidates, filters)
                              : finder.find_between(swept, right_swept, candidates, filters);
    });
  });
  if (quarantined == nullptr) return;
  const std::span<const BoxId> places = finder.quarantined();
  std::copy(places.begin(), places.end(), quarantined->resize(places.size()).begin());
}

template <int D, typename Real>
void detail::set_overlap_times(const MovingBoxes<D, Real>& left, const MovingBoxes<D, Real>& right,
                               std::span<const Pair> pairs, std::span<OverlapTime> times) {
  constexpr OverlapTime never{std::numeric_limits<double>::infinity(),
                              -std::numeric_limits<double>::infinity()};
  const core::DefaultEnvironment environment;
  check_ends(left);
  check_ends(right);
  find::check_ids(pairs, left.from.size(), right.from.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const std::size_t a = index(pairs[i].first);
    const std::size_t b = index(pairs[i].second);
    const std::array<Box<D, Real>, 4> ends = {left.from[a], left.to[a], right.from[b], right.to[b]};
    const bool are_present = std::all_of(ends.begin(), ends.end(), is_present<D, Real>);
    times[i] = (are_present ? time_of(ends[0], ends[1], ends[2], ends[3]) : std::nullopt).value_or(never);
  }
}

#define BROADSIDE_MOVING(D, Real)                                                                           \
  template std::optional<OverlapTime> overlap_time(const Box<D, Real>&, const Box<D, Real>&,                \
                                                   const Box<D, Real>&, const Box<D, Real>&) noexcept;      \
  template void detail::find_pairs_moving(const MovingBoxes<D, Real>&, const MovingBoxes<D, Real>*,         \
                                          PairSink&, const Spec&, const Workers&, const PairFilters&, bool, \
                                          Output<BoxId>*);                                                  \
  template void detail::set_overlap_times(const MovingBoxes<D, Real>&, const MovingBoxes<D, Real>&,         \
                                          std::span<const Pair>, std::span<OverlapTime>);
BROADSIDE_MOVING(2, float)
BROADSIDE_MOVING(3, float)
BROADSIDE_MOVING(2, double)
BROADSIDE_MOVING(3, double)
#undef BROADSIDE_MOVING

}  // namespace broadside

// How often a case's algorithms run: what is too slow is estimated from a few of the boxes, and which rounds
// an algorithm takes part in. Algorithms take part in the first rounds, without a gap, so that round r of any
// two is on the same boxes.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// The order in which `entries` algorithms take their turn in a round: drawn anew for each round, and the
/// same in each run. No algorithm always runs after the same other one.
std::vector<std::size_t> turns(std::size_t entries, std::size_t round);

/// Whether a case that has taken `milliseconds` may play this round: one of the first two, or within the
/// effort.
bool has_time(const Effort& effort, std::size_t round, double milliseconds);

/// No limit for has_another_round().
inline constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

/// Whether the algorithm takes part in another round: it has neither failed nor run out of memory, and the
/// effort or, where there is one, its limit asks for more.
bool has_another_round(const Measurement& measurement, const Effort& effort, std::size_t limit);

/// After the first round: the limit for one of the algorithms that took part in it. Readers need the ratio of
/// what is close to the fastest, so the rounds are for that. `slow_seconds` is the effort's for searches or
/// for histories.
std::size_t round_limit(const Measurement& measurement, std::span<const Measurement> all,
                        const Effort& effort, double slow_seconds);

/// A time that was not measured.
struct Estimate {
  double seconds;    ///< for all boxes
  std::size_t from;  ///< the number of boxes that was measured
  double exponent;   ///< of the scaling: time grows as n^exponent
};

/// From this many boxes on, an algorithm is tried on a few of them before it runs on all.
inline constexpr std::size_t boxes_worth_estimating = 5'000;

/// Whether an algorithm would take longer than `budget` seconds on `boxes` boxes: its estimate if so, empty
/// if it may run. `seconds_for` measures it on that number of the boxes.
///
/// A twentieth of the boxes is measured first. If even quadratic growth from there stays in the budget,
/// nothing else is; otherwise a fifth, where that is affordable, and the growth between the two says how to
/// scale: as n^1 at least and n^2 at most, and n^1.8 counts as n^2.
std::optional<Estimate> estimate_above(double budget, std::size_t boxes,
                                       const std::function<double(std::size_t boxes)>& seconds_for);

/// "estimated 41.2 s from 20,000 boxes, scaled by n^2.00".
std::string text(const Estimate& estimate);

}  // namespace broadside::lab

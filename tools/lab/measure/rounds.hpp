// How many rounds a case's algorithms run. The time of slow algorithms is estimated from a few of the boxes.
// Algorithms take part in the first rounds, without gaps, so that round r of any two uses the same boxes.
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

/// How many inputs of a search take turns. The branch predictor learns inputs that come again after fewer
/// than some 30,000 boxes, as it could not learn a user's: with one input of 1,000 boxes, calls took 24 ns a
/// box, with 10 the same, with 32 they took 31 (2D, AMD EPYC). So at least 100,000 boxes take turns, but at
/// most 32 inputs, and at least four up to 500,000 boxes, since inputs differ.
std::size_t inputs_in_rotation(std::size_t boxes);

/// The order of `entries` algorithms in a round: random for each round, but the same in each run. No
/// algorithm always runs after the same other one.
std::vector<std::size_t> turns(std::size_t entries, std::size_t round);

/// Whether a case that has taken `milliseconds` may play this round: one of the first two, or within the
/// effort.
bool has_time(const Effort& effort, std::size_t round, double milliseconds);

/// No limit for has_another_round().
inline constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

/// Whether the algorithm takes part in another round: it has neither failed nor run out of memory, and the
/// effort and its limit, if it has one, allow more.
bool has_another_round(const Measurement& measurement, const Effort& effort, std::size_t limit);

/// After the first round: the limit for an algorithm that took part in it. Readers need the ratios of
/// algorithms close to the fastest, so most rounds are for these. `slow_seconds` is the effort's for searches
/// or for histories.
std::size_t round_limit(const Measurement& measurement, std::span<const Measurement> all,
                        const Effort& effort, double slow_seconds);

/// A time that was extrapolated, not measured.
struct Estimate {
  double seconds;    ///< for all boxes
  std::size_t from;  ///< the number of boxes that was measured
  double exponent;   ///< of the scaling: time grows as n^exponent
};

/// From this many boxes on, an algorithm is tried on a few of them before it runs on all.
inline constexpr std::size_t boxes_worth_estimating = 5'000;

/// The algorithm's estimated time if it would exceed `budget` seconds on `boxes` boxes; empty if it may run.
/// `seconds_for` measures it on a given number of the boxes.
///
/// First measures a twentieth of the boxes. If even quadratic growth from there stays within the budget,
/// measures nothing else. Otherwise measures a fifth, if affordable, and scales by the growth between the
/// two: at least n^1 and at most n^2, where n^1.8 counts as n^2.
std::optional<Estimate> estimate_above(double budget, std::size_t boxes,
                                       const std::function<double(std::size_t boxes)>& seconds_for);

/// "estimated 41.2 s from 20,000 boxes, scaled by n^2.00".
std::string text(const Estimate& estimate);

}  // namespace broadside::lab

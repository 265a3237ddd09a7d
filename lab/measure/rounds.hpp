// In which rounds of a case an algorithm takes part: the first ones, without a gap, so that round r of any
// two algorithms is on the same boxes. What was measured so far decides.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
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

/// Whether the algorithm takes part in another round: it has not failed, and the effort or, where there is
/// one, its limit asks for more.
bool has_another_round(const Measurement& measurement, const Effort& effort, std::size_t limit);

/// After the first round: the limit for one of the algorithms that took part in it. Readers need the ratio of
/// what is close to the fastest, so the rounds are for that. `slow_seconds` is the effort's for searches or
/// for histories.
std::size_t round_limit(const Measurement& measurement, std::span<const Measurement> all,
                        const Effort& effort, double slow_seconds);

}  // namespace broadside::lab

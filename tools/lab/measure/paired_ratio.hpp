// Ratios of times measured in the same rounds, with bootstrap confidence intervals (Efron and Tibshirani, An
// Introduction to the Bootstrap, 1993; in two stages, as for clustered samples: Davison and Hinkley,
// Bootstrap Methods and their Application, 1997, section 3.8). Rounds of one process share its memory layout
// and the time at which it ran, so they are not independent: tools/paper computes intervals between
// processes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// With fewer rounds there is no interval, because it would be too narrow.
inline constexpr std::size_t min_rounds_of_interval = 5;

/// The time of each round of the measurement, in milliseconds: that of a call, or the mean over a history's
/// frames.
std::vector<double> round_times(const Measurement& measurement);

/// Ratios of one pair of entries by seed: round r uses seed r % seeds.
class RatiosBySeed {
 public:
  /// Uses the rounds that both have. Throws std::invalid_argument if there is none, or no seed.
  RatiosBySeed(std::span<const double> times, std::span<const double> others, std::size_t seeds);

  std::size_t rounds() const noexcept { return rounds_; }

  /// The median over seeds of each seed's median, of logarithms: the median of the reciprocals is its
  /// reciprocal.
  double median() const;

  /// The medians of `count` bootstrap samples: draws seeds with replacement, then rounds of each seed. The
  /// same random `seed` gives the same medians.
  std::vector<double> replicates(std::size_t count, std::uint64_t seed) const;

  /// The interval that contains 95 % of the replicates; empty with fewer than min_rounds_of_interval rounds.
  std::optional<Interval> interval() const;

 private:
  std::vector<std::vector<double>> logs_;  // of the ratios: one non-empty list per seed
  std::size_t rounds_;
};

/// The ratios of two entries of one case; both must have times.
RatiosBySeed ratios_of(const Case& measured, const Measurement& entry, const Measurement& other);

/// The ratio of one entry's time to another's in the same case; both must have times.
PairedRatio paired_ratio(const Case& measured, const Measurement& entry, const Measurement& other);

/// Fills in each measurement's ratios.
void add_ratios(CaseResult& result);

/// The geometric mean of several pairs' ratios, and its confidence interval. A ratio with too few rounds for
/// an interval counts as exact.
struct MeanRatio {
  double mean;
  Interval interval;
};

/// Throws std::invalid_argument if there are no pairs.
MeanRatio geometric_mean(std::span<const RatiosBySeed> pairs);

/// The middle 95 % of `replicates`.
Interval middle_of(std::span<const double> replicates);

}  // namespace broadside::lab

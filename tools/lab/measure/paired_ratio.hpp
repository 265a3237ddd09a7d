// Ratios of times that were measured in the same rounds, with intervals by the bootstrap (Efron and
// Tibshirani, An Introduction to the Bootstrap, 1993; of two stages, as for clustered samples: Davison and
// Hinkley, Bootstrap Methods and their Application, 1997, section 3.8). Rounds of one process share its
// memory layout and its moment, so that they are not independent: intervals between processes are the
// business of tools/paper.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// Fewer rounds than this give no interval: it would claim too much.
inline constexpr std::size_t min_rounds_of_interval = 5;

/// The time of each round that the measurement took part in, in milliseconds: a call's, or the mean of a
/// history's frames.
std::vector<double> round_times(const Measurement& measurement);

/// Ratios of one pair of entries by seed: round r is on seed r % seeds.
class RatiosBySeed {
 public:
  /// From the rounds that both have. Throws std::invalid_argument if there is none, or no seed.
  RatiosBySeed(std::span<const double> times, std::span<const double> others, std::size_t seeds);

  std::size_t rounds() const noexcept { return rounds_; }

  /// The median over seeds of each seed's median, by logarithms: that of the reciprocals is its reciprocal.
  double median() const;

  /// Such medians of `count` bootstrap samples: seeds drawn with replacement, and of each its rounds. `seed`
  /// is the random numbers': the same gives the same medians.
  std::vector<double> replicates(std::size_t count, std::uint64_t seed) const;

  /// The interval that holds 95 % of the replicates; empty where there are fewer than
  /// min_rounds_of_interval rounds.
  std::optional<Interval> interval() const;

 private:
  std::vector<std::vector<double>> logs_;  // of the ratios: one list a seed, none empty
  std::size_t rounds_;
};

/// The ratios of two entries of one case, which both have times.
RatiosBySeed ratios_of(const Case& measured, const Measurement& entry, const Measurement& other);

/// The time of one entry over that of another of the same case. Both have times.
PairedRatio paired_ratio(const Case& measured, const Measurement& entry, const Measurement& other);

/// Fills in each measurement's ratios.
void add_ratios(CaseResult& result);

/// The geometric mean of several pairs' ratios, and where it would lie if all were measured again. A ratio of
/// too few rounds for an interval counts as if it were exact.
struct MeanRatio {
  double mean;
  Interval interval;
};

/// Throws std::invalid_argument if there is none.
MeanRatio geometric_mean(std::span<const RatiosBySeed> pairs);

/// The 95 % of `replicates` in the middle.
Interval middle_of(std::span<const double> replicates);

}  // namespace broadside::lab

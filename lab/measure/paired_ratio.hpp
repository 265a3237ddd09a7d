// Ratios of times that were measured in the same rounds, with intervals. Within one process they are by the
// bootstrap (Efron and Tibshirani, An Introduction to the Bootstrap, 1993; of two stages, as for clustered
// samples: Davison and Hinkley, Bootstrap Methods and their Application, 1997, section 3.8). Rounds of one
// process share its memory layout and its moment, so that they are not independent; where there are several
// processes, each gives one ratio, and the interval is Student's over these (Georges, Buytaert and Eeckhout,
// Statistically Rigorous Java Performance Evaluation, OOPSLA 2007; Kalibera and Jones, Rigorous Benchmarking
// in Reasonable Time, ISMM 2013).
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
inline constexpr std::size_t least_rounds_of_interval = 5;

/// The time of each round that the measurement took part in, in milliseconds: a call's, or the mean of a
/// history's frames.
std::vector<double> round_times(const Measurement& measurement);

/// Ratios of one pair of entries by seed, within one process: round r is on seed r % seeds.
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
  /// least_rounds_of_interval rounds.
  std::optional<Interval> interval() const;

 private:
  std::vector<std::vector<double>> logs_;  // of the ratios: one list a seed, none empty
  std::size_t rounds_;
};

/// Ratios of one pair of entries by process, and in each by seed.
class RatiosByProcess {
 public:
  /// Of one process.
  explicit RatiosByProcess(RatiosBySeed only) { processes_.emplace_back(std::move(only)); }

  /// Of two entries of one case. Throws std::invalid_argument if there is no round that both took part in.
  RatiosByProcess(const Case& measured, const Measurement& entry, const Measurement& other);

  /// Each process, in the order of the runs; empty for one in which not both took part.
  const std::vector<std::optional<RatiosBySeed>>& processes() const noexcept { return processes_; }

  /// How many of them both took part in.
  std::size_t process_count() const noexcept;
  std::size_t rounds() const noexcept;

  /// The geometric mean of the processes' ratios, each of which is the median over seeds of each seed's
  /// median.
  double ratio() const;

  /// The median times of the rounds that both took part in; of several processes their geometric mean.
  double milliseconds() const;
  double other_milliseconds() const;

  /// Over the processes, if there are several; else by the bootstrap, and empty where there are too few
  /// rounds.
  std::optional<Interval> interval() const;

 private:
  std::vector<double> ratios() const;

  std::vector<std::optional<RatiosBySeed>> processes_;
  std::vector<double> medians_ms_;  // of each process in which both took part
  std::vector<double> other_medians_ms_;
};

/// Where the geometric mean of the population lies that positive numbers are independent draws from:
/// Student's 95 % interval of their logarithms' mean. Throws std::invalid_argument if there are fewer than
/// two.
Interval student_interval(std::span<const double> numbers);

/// The time of one entry over that of another of the same case. Both have times.
PairedRatio paired_ratio(const Case& measured, const Measurement& entry, const Measurement& other);

/// Whether there is a round of one process that both took part in.
bool were_together(const Measurement& entry, const Measurement& other);

/// Fills in each measurement's ratios.
void add_ratios(CaseResult& result);

/// The geometric mean of several pairs' ratios, and where it would lie if all were measured again. With
/// several processes each gives one such mean, whose interval is Student's: what slows a process slows it in
/// many cases. One that lacks a pair counts with the others' mean there. With one process a ratio of too few
/// rounds for an interval counts as if it were exact.
struct MeanRatio {
  double mean;
  Interval interval;
};

/// Throws std::invalid_argument if there is none.
MeanRatio geometric_mean(std::span<const RatiosByProcess> pairs);

/// The 95 % of `replicates` in the middle.
Interval middle_of(std::span<const double> replicates);

}  // namespace broadside::lab

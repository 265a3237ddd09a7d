// Whether measured times can be trusted: whether other processes used the processor, and the spread of
// samples.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "lab/measure/measurement.hpp"
#include "lab/platform/child_process.hpp"

namespace broadside::lab {

/// The fraction of the time since construction in which this process, or one of its children that have ended,
/// had a processor: 1 for one thread that always runs, more for several. Waiting counts as not having one.
class ProcessorShare {
 public:
  double value() const;

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  double used_ = platform::processor_seconds();
};

/// Whether a run of one thread lacked the processor for more than a tenth of the time.
bool is_busy(double share);

/// A warning if a run of one thread had a processor for less than nine tenths of the time; otherwise empty.
std::string busy_hint(double share);

/// The median sample over the minimum, for samples of the same boxes (every `period`-th sample is); then the
/// median over all boxes that were sampled at least twice, so that a few stalls do not count. Empty with
/// fewer than three repetitions.
std::optional<double> spread(std::span<const double> samples, std::size_t period);

/// Whether something else slowed the measurement down, as far as its samples show: its spread() is above 1.5.
/// False if there are too few repetitions to tell: times also differ between the boxes of different seeds or
/// frames. docs/benchmarking.md explains the threshold.
bool is_unsteady(const Case& of, const Measurement& measurement);

/// The number of measurements with times, and how many of them are unsteady.
struct Steadiness {
  std::size_t measurements = 0;
  std::size_t unsteady = 0;

  void add(const Steadiness& other) {
    measurements += other.measurements;
    unsteady += other.unsteady;
  }

  friend bool operator==(const Steadiness&, const Steadiness&) = default;
};

/// For one case.
Steadiness steadiness_of(const CaseResult& result);

/// A line for the end of tables that says how many measurements are unsteady and what to do, followed by
/// `more`; empty if none is unsteady.
std::string hint_of(const Steadiness& steadiness, std::string_view more);

}  // namespace broadside::lab

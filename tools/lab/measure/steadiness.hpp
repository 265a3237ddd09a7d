// Whether measured times can be trusted: whether others had the processor, and how far samples lie apart.
#pragma once

#include <chrono>
#include <cstddef>
#include <ctime>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// How much of the time since it was made this process has had a processor: 1 for one thread that always
/// runs, more where several do. Waiting counts as not having one.
class ProcessorShare {
 public:
  double value() const;

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::clock_t used_ = std::clock();
};

/// Whether others had the processor for more than a tenth of the time, in a run of one thread.
bool is_busy(double share);

/// A line that says so where a run of one thread had a processor for less than nine tenths of the time; else
/// empty.
std::string busy_hint(double share);

/// The median sample over the least one, where every `period`-th sample is of the same boxes: the median over
/// all boxes that were sampled twice, so that a few stalls do not count. Empty with fewer than three
/// repetitions.
std::optional<double> spread(std::span<const double> samples, std::size_t period);

/// Whether something else slowed the measurement down, so far as its samples tell: its spread() is over 1.5.
/// False where there are too few repetitions to tell: other boxes of a scene, or other frames, take other
/// times by themselves. docs/benchmarking.md says why so much.
bool is_unsteady(const Case& of, const Measurement& measurement);

/// How many measurements have times, and how many of them are unsteady.
struct Steadiness {
  std::size_t measurements = 0;
  std::size_t unsteady = 0;

  void add(const Steadiness& other) {
    measurements += other.measurements;
    unsteady += other.unsteady;
  }

  friend bool operator==(const Steadiness&, const Steadiness&) = default;
};

/// Of one case.
Steadiness steadiness_of(const CaseResult& result);

/// A line for the end of tables that says how many are unsteady and what to do, `more` at last;
/// empty where none is.
std::string hint_of(const Steadiness& steadiness, std::string_view more);

}  // namespace broadside::lab

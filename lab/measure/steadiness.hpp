// Whether measured times are to be trusted: how far the samples of a measurement lie apart.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// How many times the least sample the median one is, of samples that come in turns: every `period`-th is of
/// the same boxes. The median over all boxes that had their turn twice, so that a few stalls do not count;
/// empty where fewer than three samples are such repetitions.
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

/// A line for the end of tables that says how many are unsteady and what to do, of which `more` is the last;
/// empty where none is.
std::string hint_of(const Steadiness& steadiness, std::string_view more);

}  // namespace broadside::lab

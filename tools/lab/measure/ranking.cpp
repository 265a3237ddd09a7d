// Ranks the measurements of a case by time.
#include "lab/measure/ranking.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

/// The fastest of the measurements that `eligible` accepts: of two, the one that is faster in their common
/// rounds.
template <typename Eligible>
const Measurement* fastest_among(const CaseResult& result, const Eligible& eligible) {
  const Measurement* fastest = nullptr;
  for (const Measurement& measurement : result.measurements) {
    if (!is_timed(measurement) || !eligible(measurement)) continue;
    if (fastest == nullptr || ratios_of(result.of, measurement, *fastest).median() < 1)
      fastest = &measurement;
  }
  return fastest;
}

bool is_of_auto(const Measurement& measurement) { return structure_of(measurement) == default_algorithm; }

}  // namespace

std::string structure_of(const Measurement& measurement) {
  return measurement.algorithm.substr(0, measurement.algorithm.find(':'));
}

bool is_timed(const Measurement& measurement) { return !measurement.samples_ms.empty(); }

double time_of(const Measurement& measurement) {
  return is_timed(measurement) ? median(round_times(measurement))
                               : measurement.estimated_ms.value_or(INFINITY);
}

const Measurement* fastest_of(const CaseResult& result) {
  return fastest_among(result, [](const Measurement&) { return true; });
}

const Measurement* fastest_of_kind(const CaseResult& result, AlgorithmKind kind) {
  return fastest_among(result, [kind](const Measurement& measurement) { return measurement.kind == kind; });
}

const Measurement* best_own_of(const CaseResult& result) {
  const Measurement* const best = fastest_among(result, [](const Measurement& measurement) {
    return measurement.kind == AlgorithmKind::own && !is_of_auto(measurement);
  });
  return best != nullptr ? best : auto_of(result);
}

const Measurement* auto_of(const CaseResult& result) { return fastest_among(result, is_of_auto); }

std::string whole_name_of(const Case& measured) {
  const std::string name = name_of(measured);
  return measured.mode == Mode::track ? fmt::format("{}, {:.3g} % moving", name, measured.moving * 100)
                                      : name;
}

std::string name_of(const Case& measured) {
  std::string name =
      fmt::format("{}, {}D, {}", measured.scene, measured.dimension, counted(measured.boxes, "box", "boxes"));
  if (measured.left > 0)
    name += fmt::format(", {:.3g} % joined with {:.3g} %", measured.left * 100, (1 - measured.left) * 100);
  if (measured.filtered) name += ", filtered";
  return name;
}

}  // namespace broadside::lab

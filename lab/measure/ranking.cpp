// Which measurements of a case are how fast.
#include "lab/measure/ranking.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

RatiosBySeed paired(const Measurement& entry, const Measurement& other, const CaseResult& result) {
  return {round_times(entry), round_times(other), std::max<std::size_t>(result.of.seeds.size(), 1)};
}

/// The fastest of the measurements that `eligible` accepts: of two, the one that is faster in the rounds that
/// both took part in, as ratios have it.
template <typename Eligible>
const Measurement* fastest_among(const CaseResult& result, const Eligible& eligible) {
  const Measurement* fastest = nullptr;
  for (const Measurement& measurement : result.measurements) {
    if (!is_timed(measurement) || !eligible(measurement)) continue;
    if (fastest == nullptr || paired(measurement, *fastest, result).median() < 1) fastest = &measurement;
  }
  return fastest;
}

/// Whatever its options are.
bool is_auto(const Measurement& measurement) {
  const std::string& spec = measurement.algorithm;
  return spec.substr(0, spec.find(':')) == default_algorithm;
}

}  // namespace

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
    return measurement.kind == AlgorithmKind::own && !is_auto(measurement);
  });
  return best != nullptr ? best : auto_of(result);
}

const Measurement* auto_of(const CaseResult& result) { return fastest_among(result, is_auto); }

std::string name_of(const Case& measured) {
  return fmt::format("{}, {}D, {}", measured.scene, measured.dimension,
                     counted(measured.boxes, "box", "boxes"));
}

}  // namespace broadside::lab

// Who is how fast in a case.
#include "lab/report/ranking.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {

bool is_timed(const Measurement& measurement) { return !measurement.samples_ms.empty(); }

double time_of(const Measurement& measurement) {
  return is_timed(measurement) ? median(measurement.samples_ms) : measurement.estimated_ms.value_or(INFINITY);
}

double fastest_of(const CaseResult& result) {
  double fastest = INFINITY;
  for (const Measurement& measurement : result.measurements) {
    if (is_timed(measurement)) fastest = std::min(fastest, time_of(measurement));
  }
  return std::isfinite(fastest) ? fastest : 0;
}

std::string ratio_text(double ratio) { return ratio < 99.95 ? fmt::format("{:.2f}", ratio) : rounded(ratio); }

std::string name_of(const Case& of) {
  return fmt::format("{}, {}D, {}", of.scene, of.dimension, counted(of.boxes, "box", "boxes"));
}

const Measurement* fastest_of_kind(const CaseResult& result, AlgorithmKind kind) {
  const Measurement* fastest = nullptr;
  for (const Measurement& measurement : result.measurements) {
    if (measurement.kind != kind || !is_timed(measurement)) continue;
    if (fastest == nullptr || time_of(measurement) < time_of(*fastest)) fastest = &measurement;
  }
  return fastest;
}

std::optional<double> lead_of(const CaseResult& result) {
  const Measurement* const own = fastest_of_kind(result, AlgorithmKind::own);
  const Measurement* const peer = fastest_of_kind(result, AlgorithmKind::peer);
  if (own == nullptr || peer == nullptr) return std::nullopt;
  return time_of(*peer) / time_of(*own);
}

}  // namespace broadside::lab

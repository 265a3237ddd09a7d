// What all cases of a comparison come to.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/samples.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/numbers.hpp"
#include "lab/report/columns.hpp"
#include "lab/report/ranking.hpp"
#include "lab/report/table.hpp"

namespace broadside::lab {
namespace {

/// How far auto is from the best of our own algorithms, over all cases, as a line; empty where it is not in
/// the comparison with another one.
std::string auto_text(const Comparison& comparison) {
  std::vector<double> ratios;
  std::string worst;
  for (const CaseResult& result : comparison.cases) {
    const auto is_auto = [](const Measurement& m) { return m.algorithm == "auto" && is_timed(m); };
    const auto chosen = std::ranges::find_if(result.measurements, is_auto);
    double best = INFINITY;
    for (const Measurement& measurement : result.measurements) {
      if (measurement.kind == AlgorithmKind::own && !is_auto(measurement) && is_timed(measurement) &&
          chosen != result.measurements.end() && measurement.threads == chosen->threads)
        best = std::min(best, time_of(measurement));
    }
    if (chosen == result.measurements.end() || !std::isfinite(best)) continue;
    const double ratio = time_of(*chosen) / best;
    if (ratios.empty() || ratio > std::ranges::max(ratios)) worst = name_of(result.of);
    ratios.push_back(ratio);
  }
  if (ratios.empty()) return "";
  return fmt::format(
      "auto takes {} times as long as the best of our others, geometric mean of {}; at most {} times ({})\n",
      ratio_text(geometric_mean(ratios)), counted(ratios.size(), "case", "cases"),
      ratio_text(std::ranges::max(ratios)), worst);
}

/// The leads of all cases as a line; empty where no case has one.
std::string leads_text(const Comparison& comparison) {
  std::vector<double> leads;
  for (const CaseResult& result : comparison.cases) {
    if (const std::optional<double> lead = lead_of(result)) leads.push_back(*lead);
  }
  if (leads.empty()) return "";
  return fmt::format(
      "the fastest of ours is {} times as fast as the fastest peer, geometric mean of {}; at least {} "
      "times\n",
      ratio_text(geometric_mean(leads)), counted(leads.size(), "case", "cases"),
      ratio_text(std::ranges::min(leads)));
}

struct Standing {
  std::string algorithm;
  std::size_t fastest = 0;
  std::vector<double> ratios;

  double mean() const { return ratios.empty() ? INFINITY : geometric_mean(ratios); }
};

std::vector<Standing> standings(const Comparison& comparison) {
  std::vector<Standing> all;
  for (const CaseResult& result : comparison.cases) {
    const double fastest = fastest_of(result);
    for (const Measurement& measurement : result.measurements) {
      auto standing = std::ranges::find(all, measurement.algorithm, &Standing::algorithm);
      if (standing == all.end()) standing = all.insert(all.end(), {measurement.algorithm, 0, {}});
      if (!is_timed(measurement)) continue;
      standing->ratios.push_back(time_of(measurement) / fastest);
      if (time_of(measurement) == fastest) ++standing->fastest;
    }
  }
  std::ranges::stable_sort(all, {}, &Standing::mean);
  return all;
}

}  // namespace

std::string summary_of(const Comparison& comparison) {
  std::size_t measured = 0;
  std::size_t skipped = 0;
  std::vector<std::string> failures;
  Steadiness steadiness;
  for (const CaseResult& result : comparison.cases) {
    steadiness.add(steadiness_of(result));
    for (const Measurement& measurement : result.measurements) {
      ++(measurement.outcome == Outcome::skipped ? skipped : measured);
      if (measurement.outcome == Outcome::failed)
        failures.push_back(name_of(result.of) + ": " + measurement.reason);
    }
  }

  std::string text;
  if (comparison.cases.size() > 1) {
    text += fmt::format("All {}\n", counted(comparison.cases.size(), "case", "cases"));
    Columns columns("<>>><");
    columns.add({"algorithm", "cases", "fastest", "ratio to the fastest, geometric mean", ""});
    for (const Standing& standing : standings(comparison)) {
      columns.add({standing.algorithm, grouped(standing.ratios.size()), grouped(standing.fastest),
                   standing.ratios.empty() ? "-" : ratio_text(standing.mean()), ""});
    }
    text += columns.text("  ") + auto_text(comparison) + leads_text(comparison) + "\n";
  }
  for (const NotCompared& missing : comparison.not_compared)
    text += fmt::format("not compared: {}: {}\n", missing.request.scene, missing.reason);
  text += measured == 0 ? "nothing was verified" : counted(measured, "measurement", "measurements");
  if (measured > 0) text += failures.empty() ? ", all verified" : fmt::format(", {} FAILED", failures.size());
  if (skipped > 0) text += fmt::format("; {} skipped", grouped(skipped));
  if (comparison.stopped) text += "; stopped before the end";
  text += "\n";
  for (const std::string& failure : failures) text += "FAILED: " + failure + "\n";
  return text + hint_of(steadiness, "or go by the least times (min_ms in --json)");
}

}  // namespace broadside::lab

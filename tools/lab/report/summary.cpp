// Summarises all cases of a comparison.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/measure/samples.hpp"
#include "lab/measure/steadiness.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"
#include "lab/report/table.hpp"

namespace broadside::lab {
namespace {

/// "1.04 (1.03 to 1.05)": a mean over many cases has three meaningful digits.
std::string mean_text(const MeanRatio& ratio) {
  return fmt::format("{:.3g} ({:.3g} to {:.3g})", ratio.mean, ratio.interval.low, ratio.interval.high);
}

/// The ratios of two entries over all cases that have both.
struct Ratios {
  std::vector<RatiosBySeed> pairs;
  std::vector<std::string> names;  // of the cases

  void add(const CaseResult& result, const Measurement* entry, const Measurement* other) {
    if (entry == nullptr || other == nullptr || entry == other) return;
    pairs.push_back(ratios_of(result.of, *entry, *other));
    names.push_back(name_of(result.of));
  }

  /// The case with the maximum or the minimum ratio.
  template <typename Order>
  std::size_t extreme(Order order) const {
    const auto found = std::ranges::max_element(pairs, order, &RatiosBySeed::median);
    return static_cast<std::size_t>(found - pairs.begin());
  }
};

/// A line with auto's time relative to the best of our own algorithms, over all cases; empty unless both are
/// in the comparison.
std::string auto_text(const Comparison& comparison) {
  Ratios ratios;
  for (const CaseResult& result : comparison.cases) ratios.add(result, auto_of(result), best_own_of(result));
  if (ratios.pairs.empty()) return "";
  const std::size_t worst = ratios.extreme(std::less<>());
  return fmt::format(
      "auto takes {} times as long as the best of our others, geometric mean of {}; at most {} times ({})\n",
      mean_text(geometric_mean(ratios.pairs)), counted(ratios.pairs.size(), "case", "cases"),
      fmt::format("{:.3g}", ratios.pairs[worst].median()), ratios.names[worst]);
}

/// A line that says how many times as fast as the fastest of a kind (called `rival`) the algorithm `name` is,
/// which `entry_of` selects in each case; empty if no case has both.
template <typename EntryOf>
std::string lead_text(const Comparison& comparison, AlgorithmKind kind, std::string_view rival,
                      std::string_view name, const EntryOf& entry_of) {
  Ratios ratios;
  for (const CaseResult& result : comparison.cases)
    ratios.add(result, fastest_of_kind(result, kind), entry_of(result));
  if (ratios.pairs.empty()) return "";
  const std::size_t smallest = ratios.extreme(std::greater<>());
  return fmt::format(
      "{} is {} times as fast as the fastest {}, geometric mean of {}; at least {} times ({})\n", name,
      mean_text(geometric_mean(ratios.pairs)), rival, counted(ratios.pairs.size(), "case", "cases"),
      fmt::format("{:.3g}", ratios.pairs[smallest].median()), ratios.names[smallest]);
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
    const Measurement* const fastest = fastest_of(result);
    for (const Measurement& measurement : result.measurements) {
      auto standing = std::ranges::find(all, measurement.algorithm, &Standing::algorithm);
      if (standing == all.end()) standing = all.insert(all.end(), {measurement.algorithm, 0, {}});
      if (!measurement.to_fastest) continue;
      standing->ratios.push_back(measurement.to_fastest->median);
      if (&measurement == fastest) ++standing->fastest;
    }
  }
  std::ranges::stable_sort(all, {}, &Standing::mean);
  return all;
}

/// A line with the number of skipped measurements and the reasons; empty if there are none.
std::string left_out_text(const Comparison& comparison) {
  std::size_t skipped = 0;
  std::size_t over_budget = 0;
  std::map<std::string, std::size_t> reasons;
  for (const CaseResult& result : comparison.cases) {
    for (const Measurement& measurement : result.measurements) {
      if (measurement.outcome != Outcome::skipped) continue;
      ++skipped;
      measurement.estimated_ms ? ++over_budget : ++reasons[measurement.reason];
    }
  }
  if (skipped == 0) return "";
  std::vector<std::string> parts;
  if (over_budget > 0) parts.push_back(fmt::format("{} over the budget", grouped(over_budget)));
  for (const auto& [reason, count] : reasons) parts.push_back(fmt::format("{} '{}'", grouped(count), reason));
  return fmt::format("left out: {} ({})\n", counted(skipped, "measurement", "measurements"),
                     fmt::join(parts, ", "));
}

}  // namespace

std::string summary_of(const Comparison& comparison, std::size_t width) {
  std::size_t measured = 0;
  std::vector<std::string> failures;
  Steadiness steadiness;
  for (const CaseResult& result : comparison.cases) {
    steadiness.add(steadiness_of(result));
    for (const Measurement& measurement : result.measurements) {
      if (measurement.outcome != Outcome::skipped) ++measured;
      if (measurement.outcome == Outcome::failed)
        failures.push_back(name_of(result.of) + ": " + measurement.reason);
    }
  }

  std::string text;
  if (comparison.cases.size() > 1) {
    text += fmt::format("All {}\n", counted(comparison.cases.size(), "case", "cases"));
    AlignedColumns columns("<>>><");
    columns.add({"algorithm", "cases", "fastest", "ratio to the fastest, geometric mean", ""});
    for (const Standing& standing : standings(comparison)) {
      if (standing.ratios.empty()) continue;
      columns.add({standing.algorithm, grouped(standing.ratios.size()), grouped(standing.fastest),
                   ratio_text(standing.mean()), ""});
    }
    text += columns.text("  ", width) + auto_text(comparison);
    for (const auto& [kind, rival] : {std::pair(AlgorithmKind::peer, "peer"),
                                      std::pair(AlgorithmKind::literature, "from the literature")})
      text += lead_text(comparison, kind, rival, "the best of ours", best_own_of) +
              lead_text(comparison, kind, rival, "auto", auto_of);
    text += "\n";
  }
  for (const NotCompared& missing : comparison.not_compared)
    text += fmt::format("not compared: {}: {}\n", missing.request.scene, missing.reason);
  text += measured == 0 ? "nothing was verified" : counted(measured, "measurement", "measurements");
  if (measured > 0) text += failures.empty() ? ", all verified" : fmt::format(", {} FAILED", failures.size());
  if (comparison.stopped) text += "; stopped before the end";
  text += "\n" + left_out_text(comparison);
  for (const std::string& failure : failures) text += "FAILED: " + failure + "\n";
  return folded(text + hint_of(steadiness, "or go by the least times (min_ms in --json)") +
                    busy_hint(comparison.processor_share),
                width);
}

}  // namespace broadside::lab

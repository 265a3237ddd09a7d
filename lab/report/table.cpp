// A comparison as tables that a person likes to read.
#include "lab/report/table.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include <fmt/format.h>

#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/columns.hpp"

namespace broadside::lab {
namespace {

/// The unit of one table's times.
struct Unit {
  std::string name;
  double per_ms;

  std::string text(double milliseconds) const { return rounded(milliseconds * per_ms); }
};

Unit unit_for(double fastest_ms) {
  if (fastest_ms < 0.1) return {"us", 1e3};
  if (fastest_ms < 1e3) return {"ms", 1};
  return {"s", 1e-3};
}

bool is_timed(const Measurement& measurement) { return !measurement.samples_ms.empty(); }

/// The median, or what it is thought to be; infinite where nothing is known.
double time_of(const Measurement& measurement) {
  return is_timed(measurement) ? median(measurement.samples_ms) : measurement.estimated_ms.value_or(INFINITY);
}

/// The best median of the case; 0 where nothing was timed.
double fastest_of(const CaseResult& result) {
  double fastest = INFINITY;
  for (const Measurement& measurement : result.measurements) {
    if (is_timed(measurement)) fastest = std::min(fastest, time_of(measurement));
  }
  return std::isfinite(fastest) ? fastest : 0;
}

std::string ratio_text(double ratio) { return ratio < 99.95 ? fmt::format("{:.2f}", ratio) : rounded(ratio); }

std::vector<const Measurement*> in_order(const CaseResult& result) {
  std::vector<const Measurement*> order;
  for (const Measurement& measurement : result.measurements) order.push_back(&measurement);
  std::ranges::stable_sort(order, {}, [](const Measurement* measurement) {
    return std::tuple(!is_timed(*measurement), measurement->outcome == Outcome::skipped,
                      time_of(*measurement));
  });
  return order;
}

std::string name_of(const Case& of) {
  return fmt::format("{}, {}D, {}", of.scene, of.dimension, counted(of.boxes, "box", "boxes"));
}

/// What the results were compared with: "quadtree or sweep_and_prune + 200 sampled boxes".
std::string references_of(const CaseResult& result) {
  std::vector<std::string> names;
  std::string addition;
  for (const Measurement& measurement : result.measurements) {
    const std::string& by = measurement.verified_by;
    const std::size_t end = std::min(by.find(' '), by.size());
    if (by.empty() || std::ranges::find(names, by.substr(0, end)) != names.end()) continue;
    names.push_back(by.substr(0, end));
    addition = by.substr(end);
  }
  return fmt::format("{}{}", fmt::join(names, " or "), addition);
}

std::string heading(const CaseResult& result) {
  const Case& of = result.of;
  std::string text = name_of(of);
  if (of.mode == Mode::track)
    text += fmt::format(", {:.3g} % moving, {}", of.moving * 100, counted(of.frames, "frame", "frames"));
  for (const Measurement& measurement : result.measurements) {
    if (measurement.outcome != Outcome::verified || !measurement.pairs) continue;
    text += fmt::format(", {}{}", counted(*measurement.pairs, "pair", "pairs"),
                        of.mode == Mode::track ? " at the end" : "");
    break;
  }
  const std::string references = references_of(result);
  if (!references.empty()) text += ", checked against " + references;
  return text + "\n";
}

/// The fastest measurement of a kind; null where none was timed.
const Measurement* fastest_of_kind(const CaseResult& result, AlgorithmKind kind) {
  const Measurement* fastest = nullptr;
  for (const Measurement& measurement : result.measurements) {
    if (measurement.kind != kind || !is_timed(measurement)) continue;
    if (fastest == nullptr || time_of(measurement) < time_of(*fastest)) fastest = &measurement;
  }
  return fastest;
}

/// How many times as fast as the fastest peer our fastest algorithm is; empty where either is missing.
std::optional<double> lead_of(const CaseResult& result) {
  const Measurement* const own = fastest_of_kind(result, AlgorithmKind::own);
  const Measurement* const peer = fastest_of_kind(result, AlgorithmKind::peer);
  if (own == nullptr || peer == nullptr) return std::nullopt;
  return time_of(*peer) / time_of(*own);
}

/// The lead as a line; empty where there is none.
std::string lead_text(const CaseResult& result) {
  const std::optional<double> lead = lead_of(result);
  if (!lead) return "";
  return fmt::format("  {} is {} times as fast as the fastest peer, {}\n",
                     fastest_of_kind(result, AlgorithmKind::own)->algorithm, ratio_text(*lead),
                     fastest_of_kind(result, AlgorithmKind::peer)->algorithm);
}

/// What algorithms that choose have chosen, a line each.
std::string explanations_of(const CaseResult& result) {
  std::string text;
  for (const Measurement& measurement : result.measurements) {
    if (!measurement.explanation.empty())
      text += fmt::format("  {}: {}\n", measurement.algorithm, measurement.explanation);
  }
  return text;
}

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

std::string verdict(const Measurement& measurement) {
  switch (measurement.outcome) {
    case Outcome::verified:
      return "verified";
    case Outcome::failed:
      return "FAILED";
    case Outcome::skipped:
      break;
  }
  return "skipped: " + measurement.reason;
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

std::string table_of(const CaseResult& result) {
  const Case& of = result.of;
  const double fastest = fastest_of(result);
  const double floor = result.floor_ms.empty() ? 0 : median(result.floor_ms);
  const double boxes = static_cast<double>(std::max<std::size_t>(of.boxes, 1));
  const Unit unit = unit_for(fastest);
  const bool any_estimate = std::ranges::any_of(
      result.measurements, [](const Measurement& m) { return m.estimated_ms.has_value(); });
  const std::string no_mark = any_estimate ? "     " : "";  // as wide as " est."
  const bool tracked = of.mode == Mode::track;
  const auto range = [&](const std::vector<double>& samples) {
    return unit.text(std::ranges::min(samples)) + ".." +
           unit.text(tracked ? percentile(samples, 0.99) : std::ranges::max(samples));
  };

  // Where there is no floor, there is no column for it.
  Columns columns(floor > 0 ? "<>>>>>>><<" : "<>>>>>><<");
  const auto add = [&](std::vector<std::string> row, const std::string& over_floor) {
    if (floor > 0) row.insert(row.begin() + 3, over_floor);
    columns.add(std::move(row));
  };
  add({"algorithm", (tracked ? unit.name + " a frame" : unit.name) + no_mark, "ratio", "ns a box",
       "tests a box", "memory", "peak", tracked ? "min..p99" : "min..max", ""},
      "floors");
  for (const Measurement* const measurement : in_order(result)) {
    const auto& statistics = measurement->statistics;
    const bool timed = is_timed(*measurement);
    const double time = time_of(*measurement);
    const bool estimated = measurement->estimated_ms.has_value();
    const double ratio = fastest > 0 ? time / fastest : INFINITY;
    add(
        {
            measurement->algorithm,
            timed       ? unit.text(time) + no_mark
            : estimated ? "~" + unit.text(time) + " est."
                        : "-" + no_mark,
            !std::isfinite(ratio) ? "-"
            : timed               ? ratio_text(ratio)
                                  : "~" + ratio_text(ratio),
            timed ? rounded(time * 1e6 / boxes) : "-",
            timed && statistics ? rounded(static_cast<double>(statistics->tests) / boxes) : "-",
            timed && measurement->own_bytes ? bytes(*measurement->own_bytes) : "-",
            timed && measurement->peak_bytes ? bytes(*measurement->peak_bytes) : "-",
            timed ? range(measurement->samples_ms) : "-",
            verdict(*measurement),
        },
        timed ? ratio_text(time / floor) : "-");
  }
  if (floor > 0) {
    add({"the floor", unit.text(floor) + no_mark, fastest > 0 ? ratio_text(floor / fastest) : "-",
         rounded(floor * 1e6 / boxes), "-", "-", "-", range(result.floor_ms),
         "boxes sorted and gathered, pairs written"},
        "1.00");
  }
  return heading(result) + columns.text("  ") + explanations_of(result) + lead_text(result);
}

std::string summary_of(const Comparison& comparison) {
  std::size_t measured = 0;
  std::size_t skipped = 0;
  std::vector<std::string> failures;
  for (const CaseResult& result : comparison.cases) {
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
  return text;
}

}  // namespace broadside::lab

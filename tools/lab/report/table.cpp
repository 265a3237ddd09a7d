// A comparison as text.
#include "lab/report/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"

namespace broadside::lab {
namespace {

constexpr std::array<std::size_t, 6> line_widths = {48, 25, 19, 30, 19, 13};

/// Lines are printed one by one, when cases end, so their columns have fixed widths.
std::string line(const std::array<std::string, line_widths.size()>& cells, std::size_t width) {
  constexpr std::string_view continued = "\n    ";
  std::string text;
  std::size_t used = 0;
  for (std::size_t column = 0; column < cells.size(); ++column) {
    if (column > 0 && used + 2 + line_widths[column] > width) {
      text.erase(text.find_last_not_of(' ') + 1);
      text += continued;
      used = continued.size() - 1;
    } else if (column > 0) {
      text += "  ";
      used += 2;
    }
    text += fmt::format("{:<{}}", cells[column], line_widths[column]);
    used += line_widths[column];
  }
  text.erase(text.find_last_not_of(' ') + 1);
  return text + "\n";
}

std::string name_and_time(const Measurement* measurement) {
  if (measurement == nullptr) return "-";
  return measurement->algorithm + " " + duration(time_of(*measurement) / 1e3);
}

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

std::vector<const Measurement*> in_order(const CaseResult& result) {
  std::vector<const Measurement*> order;
  for (const Measurement& measurement : result.measurements) order.push_back(&measurement);
  std::ranges::stable_sort(order, {}, [](const Measurement* measurement) {
    return std::tuple(!is_timed(*measurement), measurement->outcome == Outcome::skipped,
                      measurement->to_fastest ? measurement->to_fastest->median : time_of(*measurement));
  });
  return order;
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
  const std::string evidence = evidence_of(result);
  if (!evidence.empty()) text += ", verified " + evidence;
  return text + "\n";
}

/// A line with our best's speed relative to the fastest peer; empty if one of the two is missing.
std::string lead_text(const CaseResult& result) {
  const Measurement* const own = best_own_of(result);
  const Measurement* const peer = fastest_of_kind(result, AlgorithmKind::peer);
  if (own == nullptr || peer == nullptr) return "";
  return fmt::format("  {} is {} times as fast as the fastest peer, {}\n", own->algorithm,
                     ratio_text(peer->to_best_own->median, peer->to_best_own->interval), peer->algorithm);
}

/// The choices of algorithms that choose, one line each.
std::string explanations_of(const CaseResult& result) {
  std::string text;
  for (const Measurement& measurement : result.measurements) {
    if (!measurement.explanation.empty())
      text += fmt::format("  {}: {}\n", measurement.algorithm, measurement.explanation);
  }
  return text;
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

/// The time of the fastest algorithm; 0 without a timed one.
double min_time(const CaseResult& result) {
  const Measurement* const fastest = fastest_of(result);
  return fastest == nullptr ? 0 : time_of(*fastest);
}

/// Values shared by the rows of a case's table.
struct Scale {
  explicit Scale(const CaseResult& result)
      : fastest(min_time(result)),
        unit(unit_for(fastest)),
        boxes(static_cast<double>(std::max<std::size_t>(result.of.boxes, 1))) {
    const auto is_estimate = [](const Measurement& m) { return m.estimated_ms.has_value(); };
    if (std::ranges::any_of(result.measurements, is_estimate)) no_mark = "     ";
  }

  std::string time(const Measurement& measurement) const {
    if (is_timed(measurement)) return unit.text(time_of(measurement)) + no_mark;
    return measurement.estimated_ms ? "~" + unit.text(time_of(measurement)) + " est." : "-" + no_mark;
  }

  /// The ratio to the fastest and, in its own cell, the interval.
  std::string ratio(const Measurement& measurement) const {
    if (measurement.to_fastest) return ratio_text(measurement.to_fastest->median);
    const double ratio = fastest > 0 ? time_of(measurement) / fastest : INFINITY;
    return std::isfinite(ratio) ? "~" + ratio_text(ratio) : "-";
  }

  static std::string interval(const Measurement& measurement) {
    if (!measurement.to_fastest || measurement.to_fastest->of == measurement.algorithm) return "-";
    return interval_text(measurement.to_fastest->interval);
  }

  std::string tests(const Measurement& measurement) const {
    return is_timed(measurement) && measurement.statistics
               ? rounded(static_cast<double>(measurement.statistics->tests) / boxes)
               : "-";
  }

  static std::string memory(const Measurement& measurement, const std::optional<std::uint64_t>& count) {
    return is_timed(measurement) && count ? bytes(*count) : "-";
  }

  double fastest;
  Unit unit;
  double boxes;
  std::string no_mark{};  // as wide as " est.", if one occurs
};

std::string still_rows(const CaseResult& result, std::size_t width) {
  const Scale scale(result);
  const double floor = result.floor_ms.empty() ? 0 : median(result.floor_ms);
  const auto range = [&](const std::vector<double>& samples) {
    return scale.unit.text(std::ranges::min(samples)) + ".." + scale.unit.text(std::ranges::max(samples));
  };
  // Without a lower bound there is no column for it.
  AlignedColumns columns(floor > 0 ? "<>><>>>>><<" : "<>><>>>><<");
  const auto add = [&](std::vector<std::string> row, const std::string& over_floor) {
    if (floor > 0) row.insert(row.begin() + 4, over_floor);
    columns.add(std::move(row));
  };
  add({"algorithm", scale.unit.name + scale.no_mark, "ratio", "95 % interval", "ns a box", "tests a box",
       "memory", "peak", "min..max", ""},
      "floors");
  for (const Measurement* const measurement : in_order(result)) {
    const bool timed = is_timed(*measurement);
    add({measurement->algorithm, scale.time(*measurement), scale.ratio(*measurement),
         Scale::interval(*measurement), timed ? rounded(time_of(*measurement) * 1e6 / scale.boxes) : "-",
         scale.tests(*measurement), Scale::memory(*measurement, measurement->own_bytes),
         Scale::memory(*measurement, measurement->peak_bytes), timed ? range(measurement->samples_ms) : "-",
         verdict(*measurement)},
        timed ? ratio_text(time_of(*measurement) / floor) : "-");
  }
  if (floor > 0) {
    add({"the floor", scale.unit.text(floor) + scale.no_mark,
         scale.fastest > 0 ? ratio_text(floor / scale.fastest) : "-", "-", rounded(floor * 1e6 / scale.boxes),
         "-", "-", "-", range(result.floor_ms), "boxes moved into parts and read back, pairs written"},
        "1.0");
  }
  return columns.text("  ", width);
}

std::string moving_rows(const CaseResult& result, std::size_t width) {
  const Scale scale(result);
  const double movers = std::max(result.of.moving * scale.boxes, 1.0);
  AlignedColumns columns("<>>>><>>>>>><");
  columns.add({"algorithm", scale.unit.name + " a frame" + scale.no_mark, "p99", "worst", "ratio",
               "95 % interval", "to a peer", "ns a mover", "first frame", "tests a box", "memory", "peak",
               ""});
  for (const Measurement* const measurement : in_order(result)) {
    const std::vector<double>& samples = measurement->samples_ms;
    const bool timed = is_timed(*measurement);
    const double time = time_of(*measurement);
    columns.add({measurement->algorithm, scale.time(*measurement),
                 timed ? scale.unit.text(percentile(samples, 0.99)) : "-",
                 timed ? scale.unit.text(std::ranges::max(samples)) : "-", scale.ratio(*measurement),
                 Scale::interval(*measurement),
                 measurement->to_fastest_peer ? ratio_text(measurement->to_fastest_peer->median) : "-",
                 timed ? rounded(time * 1e6 / movers) : "-",
                 timed && measurement->build_ms ? scale.unit.text(*measurement->build_ms) : "-",
                 scale.tests(*measurement), Scale::memory(*measurement, measurement->own_bytes),
                 Scale::memory(*measurement, measurement->peak_bytes), verdict(*measurement)});
  }
  return columns.text("  ", width);
}

}  // namespace

std::string interval_text(const std::optional<Interval>& interval) {
  if (!interval) return "-";
  // A wide interval that contains 1 does not show that the two are level, only that nothing is known.
  constexpr double wide = 1.5;
  if (interval->includes(1) && interval->high <= wide && interval->low >= 1 / wide) return "level";
  return ratio_text(interval->low) + " to " + ratio_text(interval->high);
}

std::string ratio_text(double ratio, const std::optional<Interval>& interval) {
  return interval ? fmt::format("{} ({})", ratio_text(ratio), interval_text(interval)) : ratio_text(ratio);
}

std::string evidence_of(const CaseResult& result) {
  std::optional<Evidence> weakest;
  for (const Measurement& measurement : result.measurements) {
    if (measurement.outcome != Outcome::verified || !measurement.evidence) continue;
    weakest = weakest ? weaker(*weakest, *measurement.evidence) : *measurement.evidence;
  }
  return weakest ? weakest->text() : "";
}

std::string verdict_of(const CaseResult& result) {
  const auto failed = std::ranges::count(result.measurements, Outcome::failed, &Measurement::outcome);
  if (failed > 0) return fmt::format("{} FAILED", failed);
  const std::string evidence = evidence_of(result);
  return evidence.empty() ? "nothing verified" : evidence;
}

std::string case_line_heading(std::size_t width) {
  return line({"case", "best of ours", "auto over it", "fastest peer", "over the best", "verified"}, width);
}

std::string case_line(const CaseResult& result, std::size_t width) {
  const Case& measured = result.of;
  const Measurement* const own = best_own_of(result);
  const Measurement* const chosen = auto_of(result);
  const Measurement* const peer = fastest_of_kind(result, AlgorithmKind::peer);
  const auto ratio = [&](const Measurement* measurement) -> std::string {
    if (measurement == nullptr || measurement == own || !measurement->to_best_own) return "-";
    return ratio_text(measurement->to_best_own->median, measurement->to_best_own->interval);
  };
  return line({whole_name_of(measured), name_and_time(own), ratio(chosen), name_and_time(peer), ratio(peer),
               verdict_of(result)},
              width);
}

std::string table_of(const CaseResult& result, std::size_t width) {
  const std::string rows =
      result.of.mode == Mode::track ? moving_rows(result, width) : still_rows(result, width);
  return folded(heading(result) + rows + explanations_of(result) + lead_text(result), width);
}

}  // namespace broadside::lab

// What a result says in words.
#include "lab/report/phrases.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {

std::string interval_text(const std::optional<Interval>& interval) {
  if (!interval) return "-";
  if (interval->includes(1)) return "level";
  const std::string low = ratio_text(interval->low);
  const std::string high = ratio_text(interval->high);
  return low == high && low == ratio_text(1) ? "nearly level" : low + " to " + high;
}

std::string ratio_text(double ratio, const std::optional<Interval>& interval) {
  return interval ? fmt::format("{} ({})", ratio_text(ratio), interval_text(interval)) : ratio_text(ratio);
}

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

std::string verdict_of(const CaseResult& result) {
  const auto failed = std::ranges::count(result.measurements, Outcome::failed, &Measurement::outcome);
  if (failed > 0) return fmt::format("{} FAILED", failed);
  const std::string references = references_of(result);
  return references.empty() ? "nothing verified" : references;
}

namespace {

/// Lines are printed one by one, as cases end: their columns have widths of their own.
std::string line(std::string_view name, std::string_view own, std::string_view chosen, std::string_view peer,
                 std::string_view lead, std::string_view verified) {
  return fmt::format("{:<48}  {:<25}  {:<19}  {:<30}  {:<19}  {}\n", name, own, chosen, peer, lead, verified);
}

std::string name_and_time(const Measurement* measurement) {
  if (measurement == nullptr) return "-";
  return measurement->algorithm + " " + duration(time_of(*measurement) / 1e3);
}

}  // namespace

std::string case_line_heading() {
  return line("case", "best of ours", "auto over it", "fastest peer", "over the best", "checked against");
}

std::string case_line(const CaseResult& result) {
  const Case& measured = result.of;
  const Measurement* const own = best_own_of(result);
  const Measurement* const chosen = auto_of(result);
  const Measurement* const peer = fastest_of_kind(result, AlgorithmKind::peer);
  std::string name = name_of(measured);
  if (measured.mode == Mode::track) name += fmt::format(", {:.3g} % moving", measured.moving * 100);
  const auto ratio = [&](const Measurement* measurement) -> std::string {
    if (measurement == nullptr || measurement == own || !measurement->to_best_own) return "-";
    return ratio_text(measurement->to_best_own->median, measurement->to_best_own->interval);
  };
  return line(name, name_and_time(own), ratio(chosen), name_and_time(peer), ratio(peer), verdict_of(result));
}

}  // namespace broadside::lab

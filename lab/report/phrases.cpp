// What tables and lines say alike: ratios with their intervals, and how results were verified.
#include "lab/report/phrases.hpp"

#include <algorithm>
#include <vector>

#include <fmt/format.h>

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

}  // namespace broadside::lab

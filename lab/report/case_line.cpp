// A comparison as a line a case.
#include "lab/report/case_line.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/numbers.hpp"
#include "lab/report/phrases.hpp"

namespace broadside::lab {
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

// Machines side by side.
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/paired_ratio.hpp"
#include "lab/measure/ranking.hpp"
#include "lab/numbers.hpp"
#include "lab/report/columns.hpp"
#include "lab/report/table.hpp"

namespace broadside::lab {
namespace {

/// The lead in a case, if it has a peer and one of ours.
std::string lead_in(const CaseResult& result, const Measurement* ours, std::vector<RatiosByProcess>& all) {
  const Measurement* const peer = fastest_of_kind(result, AlgorithmKind::peer);
  if (ours == nullptr || peer == nullptr || !were_together(*peer, *ours)) return "-";
  all.emplace_back(result.of, *peer, *ours);
  return ratio_text(all.back().ratio(), all.back().interval());
}

std::string mean_text(const std::vector<RatiosByProcess>& ratios) {
  if (ratios.empty()) return "-";
  const MeanRatio mean = geometric_mean(ratios);
  return fmt::format("{:.3g} ({:.3g} to {:.3g})", mean.mean, mean.interval.low, mean.interval.high);
}

}  // namespace

std::string heading_of(const Results& results) {
  const Build& build = results.build;
  const std::string& first = results.processes.front().date;
  const std::string& last = results.processes.back().date;
  return fmt::format("{}: {}, {}; revision {}, {} {}", name_of_machine(results),
                     counted(results.processes.size(), "process", "processes"),
                     first == last ? first : first + " to " + last,
                     build.revision.empty() ? "unknown" : build.revision, build.compiler, build.flags);
}

std::string leads_of(std::span<const Results> machines) {
  Columns columns("<" + std::string(machines.size(), '<'));
  std::vector<std::string> row = {"case"};
  for (const Results& results : machines) row.push_back(name_of_machine(results));
  columns.add(row);
  std::vector<std::vector<RatiosByProcess>> best(machines.size());
  std::vector<std::vector<RatiosByProcess>> chosen(machines.size());
  for (std::size_t i = 0; i < machines[0].comparison.cases.size(); ++i) {
    row = {whole_name_of(machines[0].comparison.cases[i].of)};
    for (std::size_t j = 0; j < machines.size(); ++j) {
      const CaseResult& result = machines[j].comparison.cases[i];
      row.push_back(lead_in(result, best_own_of(result), best[j]));
      lead_in(result, auto_of(result), chosen[j]);
    }
    columns.add(row);
  }
  std::vector<std::string> means = {"geometric mean, the best of ours"};
  std::vector<std::string> means_of_auto = {"geometric mean, auto"};
  for (std::size_t j = 0; j < machines.size(); ++j) {
    means.push_back(mean_text(best[j]));
    means_of_auto.push_back(mean_text(chosen[j]));
  }
  columns.add(means);
  columns.add(means_of_auto);
  return "How many times as fast as the fastest peer our best is, by machine\n" + columns.text("  ");
}

}  // namespace broadside::lab

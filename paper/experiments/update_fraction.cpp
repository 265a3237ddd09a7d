// Section VI-A: updating only what changed pays where few boxes move. Up to how many, for each structure.
#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/mending.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

/// A structure of the paper, and the ways to mend it; as values of `update`.
struct Structure {
  std::string algorithm;
  std::vector<std::string> updates;
};

const std::vector<Structure>& structures() {
  static const std::vector<Structure> list = {
      {"paper_grid", {"search_delete_reinsert", "reinsert", "translate"}},
      {"paper_sweep_and_prune", {"heap", "insertion", "binary"}},
      {"paper_quadtree", {"root", "relative", "siblings", "cousins"}}};
  return list;
}

std::vector<Table> measure(const Laboratory& laboratory) {
  const auto fractions = laboratory.either<std::vector<double>>({0.001, 0.003, 0.01, 0.03, 0.1, 0.2, 0.5, 1},
                                                                {0.001, 0.1, 0.3, 1});
  const std::size_t boxes = laboratory.either<std::size_t>(10'000, 3'000);
  Table table{
      .name = "times",
      .title = fmt::format("A frame of {} uniform boxes in 2D: the structure mended in the fastest way, or "
                           "built anew, and then searched",
                           grouped(boxes)),
      .columns = {{"algorithm"},
                  {"moving", "%"},
                  {"updating", "ms"},
                  {"by"},
                  {"rebuilding", "ms"},
                  {"updating over rebuilding"},
                  {"mending", "ms"},
                  {"building", "ms"},
                  {"mending over building"},
                  {"searching", "ms"}},
      .charts = {log_log_chart("Whole frames: updating over rebuilding, by the boxes that move", "moving",
                               "updating over rebuilding", "algorithm"),
                 log_log_chart("The structure alone: mending over building, by the boxes that move", "moving",
                               "mending over building", "algorithm")}};
  for (const Structure& structure : structures()) {
    std::vector<std::string> specs = {structure.algorithm + ":update=rebuild"};
    for (const std::string& update : structure.updates)
      specs.push_back(structure.algorithm + ":update=" + update);
    for (const double moving : fractions) {
      const std::vector<MendingCost> costs =
          measure_mending<2>(laboratory, specs,
                             {.scene = "uniform",
                              .boxes = boxes,
                              .moving = moving,
                              .frames = laboratory.either<std::size_t>(12, 4)});
      const auto best = std::ranges::min_element(costs.begin() + 1, costs.end(), {}, &MendingCost::frame_ms);
      const std::string& by = structure.updates[static_cast<std::size_t>(best - costs.begin()) - 1];
      const MendingCost& built = costs[0];
      table.add({structure.algorithm, 100 * moving, best->frame_ms, by, built.frame_ms,
                 best->frame_ms / built.frame_ms, best->mending_ms, built.mending_ms,
                 best->mending_ms / built.mending_ms, best->searching_ms});
    }
  }
  return {table};
}

/// Up to which fraction updating pays, with one structure.
struct Limit {
  std::string algorithm;
  double percent = 100;  ///< 0 if it does not even where the fewest move
  bool is_always = false;
  double gain = 0;            ///< rebuilding over updating where the fewest move
  double loss_at_all = 0;     ///< updating over rebuilding where the most move
  double mending_gain = 0;    ///< building over mending where the fewest move
  double mending_at_all = 0;  ///< mending over building where the most move
};

Limit limit_of(const Table& table, const std::string& algorithm) {
  const Table rows = table.where("algorithm", algorithm);
  const auto ratios = rows.points("moving", "updating over rebuilding");
  const auto mending = rows.points("moving", "mending over building");
  if (ratios.size() < 2 || mending.size() < 2)
    throw std::invalid_argument(fmt::format("table 'times': {} rows with both times of '{}'; expected two",
                                            std::min(ratios.size(), mending.size()), algorithm));
  const auto from = crossover_in(rows, "moving", "rebuilding", "updating");
  Limit limit{.algorithm = algorithm,
              .is_always = !from,
              .gain = 1 / ratios.front().second,
              .loss_at_all = ratios.back().second,
              .mending_gain = 1 / mending.front().second,
              .mending_at_all = mending.back().second};
  if (from) limit.percent = *from > ratios.front().first ? *from : 0;
  return limit;
}

Finding judge(const std::vector<Table>& tables) {
  const Table& table = table_named(tables, "times");
  std::vector<Limit> limits;
  for (const std::string& algorithm : table.distinct_texts("algorithm"))
    limits.push_back(limit_of(table, algorithm));
  if (limits.empty()) throw std::invalid_argument("table 'times' has no rows; expected two an algorithm");
  const auto [least, most] = std::ranges::minmax_element(limits, {}, &Limit::percent);

  Finding finding;
  if (least->percent == 0) {
    finding.verdict = Verdict::does_not_hold;
  } else if (std::ranges::all_of(limits, &Limit::is_always)) {
    finding.verdict = Verdict::holds;
  } else {
    finding.verdict = Verdict::holds_when;
    finding.condition = fmt::format("less than {:.0f} % of the boxes move", least->percent);
  }
  std::string list;
  for (const Limit& limit : limits) {
    list += fmt::format("{}{} {}", list.empty() ? "" : ", ", limit.algorithm,
                        limit.is_always      ? "at any"
                        : limit.percent == 0 ? "never"
                                             : fmt::format("{:.0f} %", limit.percent));
  }
  const auto gains = std::ranges::minmax(limits, {}, &Limit::gain);
  const auto losses = std::ranges::minmax(limits, {}, &Limit::loss_at_all);
  const auto mending_gains = std::ranges::minmax(limits, {}, &Limit::mending_gain);
  const auto mending_losses = std::ranges::minmax(limits, {}, &Limit::mending_at_all);
  finding.reason = fmt::format(
      "Updating pays in whole frames up to this fraction of moving boxes: {}. Where the fewest move, mending "
      "is {} to "
      "{} times as fast as building, but a frame, which searches everything either way, only {:.2f} to "
      "{:.2f} times; "
      "where all move, mending takes {:.2f} to {:.2f} times as long as building, and a frame {:.2f} to "
      "{:.2f} times.",
      list, rounded(mending_gains.min.mending_gain), rounded(mending_gains.max.mending_gain), gains.min.gain,
      gains.max.gain, mending_losses.min.mending_at_all, mending_losses.max.mending_at_all,
      losses.min.loss_at_all, losses.max.loss_at_all);
  for (const Limit& limit : limits)
    finding.figures.push_back({fmt::format("{}_pays_up_to", limit.algorithm), limit.percent, "%"});
  finding.figures.insert(finding.figures.end(),
                         {{"least_crossover", least->percent, "%"},
                          {"greatest_crossover", most->percent, "%"},
                          {"least_gain_where_fewest_move", gains.min.gain},
                          {"greatest_gain_where_fewest_move", gains.max.gain},
                          {"least_mending_gain_where_fewest_move", mending_gains.min.mending_gain},
                          {"greatest_mending_gain_where_fewest_move", mending_gains.max.mending_gain},
                          {"greatest_loss_where_all_move", losses.max.loss_at_all}});
  return finding;
}

}  // namespace

Experiment update_fraction() {
  return {.number = 9,
          .name = "update_fraction",
          .title = "Updating only what changed",
          .claim =
              "For all algorithms we can append a flag to each object to check if it has been changed ... If "
              "it has been changed, we then reposition its reference within a collection. If it has not been "
              "changed then we do not need to rebuild the collection, and only change a subset of objects.",
          .section = "VI-A",
          .measured =
              "A frame of the paper's grid, sweep and quadtree on uniform boxes that drift by a fifth of "
              "themselves: "
              "changed boxes are known by a flag, the structure is mended in the fastest of its ways or "
              "built anew, "
              "all of it is searched as the listing does, and the pairs are compared with those of the frame "
              "before.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

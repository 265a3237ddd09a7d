// Section VI-B: where most boxes move, a grid is rebuilt faster than they are reinserted into it.
#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/mending.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

const std::vector<std::string> specs = {"paper_grid:update=reinsert", "paper_grid:update=translate",
                                        "paper_grid:update=rebuild"};

/// "Most objects are moving": more than half of them.
constexpr double most = 50;

struct Case {
  std::size_t boxes;
  double drift;
};

std::vector<Table> measure(const Laboratory& laboratory) {
  Table table{
      .name = "times",
      .title =
          "The cells of the paper's grid: movers reinserted, their references translated, or all boxes "
          "added to empty cells; and the whole frame, which is then searched",
      .columns = {{"case"},
                  {"boxes"},
                  {"drift", "of a box"},
                  {"moving", "%"},
                  {"reinserting", "ms"},
                  {"translating", "ms"},
                  {"rebuilding", "ms"},
                  {"reinserting over rebuilding"},
                  {"searching", "ms"},
                  {"frame reinserting", "ms"},
                  {"frame rebuilding", "ms"}},
      .charts = {
          log_log_chart("Reinserting over rebuilding, by the boxes that move: below 1 reinserting wins",
                        "moving", "reinserting over rebuilding", "case")}};
  const auto fractions =
      laboratory.either<std::vector<double>>({0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1}, {0.1, 0.3, 1});
  const std::size_t many = laboratory.either<std::size_t>(50'000, 10'000);
  for (const Case& of : {Case{1'000, 0.2}, Case{5'000, 0.2}, Case{many, 0.2}, Case{5'000, 2}}) {
    const std::string name = fmt::format("{} boxes, drift {}", grouped(of.boxes), of.drift);
    for (const double moving : fractions) {
      const std::vector<MendingCost> costs =
          measure_mending<2>(laboratory, specs,
                             {.scene = "uniform",
                              .boxes = of.boxes,
                              .moving = moving,
                              .frames = laboratory.either<std::size_t>(12, 4),
                              .drift = of.drift});
      const MendingCost& reinserted = costs[0];
      const MendingCost& rebuilt = costs[2];
      table.add({name, static_cast<double>(of.boxes), of.drift, 100 * moving, reinserted.mending_ms,
                 costs[1].mending_ms, rebuilt.mending_ms, reinserted.mending_ms / rebuilt.mending_ms,
                 rebuilt.searching_ms, reinserted.frame_ms, rebuilt.frame_ms});
    }
  }
  return {table};
}

/// What one case comes to.
struct Crossing {
  std::string name;
  double from = 0;          ///< % that move from which on rebuilding wins; above 100 if it never does
  double at_all = 0;        ///< reinserting over rebuilding where all move
  double frame_at_all = 0;  ///< the same of whole frames
};

Crossing crossing_of(const Table& table, const std::string& name) {
  const Table rows = table.where("case", name);
  const auto from = crossover_in(rows, "moving", "rebuilding", "reinserting");
  const auto ratios = rows.points("moving", "reinserting over rebuilding");
  const auto frames = rows.points("frame rebuilding", "frame reinserting");
  if (ratios.size() < 2 || frames.empty() || !(frames.back().first > 0))
    throw std::invalid_argument(
        fmt::format("table 'times': {} rows with times of '{}'; expected two", ratios.size(), name));
  return {name, from.value_or(200), ratios.back().second, frames.back().second / frames.back().first};
}

Finding judge(const std::vector<Table>& tables) {
  const Table& table = table_named(tables, "times");
  std::vector<Crossing> crossings;
  for (const std::string& name : table.distinct_texts("case")) crossings.push_back(crossing_of(table, name));
  if (crossings.empty()) throw std::invalid_argument("table 'times' has no rows; expected two a case");
  const auto [first, last] = std::ranges::minmax_element(crossings, {}, &Crossing::from);
  const auto [least, greatest] = std::ranges::minmax_element(crossings, {}, &Crossing::at_all);
  const auto frames = std::ranges::minmax(crossings, {}, &Crossing::frame_at_all);

  Finding finding;
  if (last->from <= most) {
    finding.verdict = Verdict::holds;
  } else if (last->from <= 100) {
    finding.verdict = Verdict::holds_when;
    finding.condition = fmt::format("more than {:.0f} % of the boxes move", last->from);
  } else {
    finding.verdict = Verdict::does_not_hold;
  }
  finding.reason = fmt::format(
      "Building all cells anew is faster than reinserting from {:.0f} % moving boxes on ({}) at the earliest "
      "and {} "
      "at the latest. Where all move, reinserting takes {:.2f} ({}) to {:.2f} times ({}) as long; two hashes "
      "against "
      "one would be 2. Of whole frames it is {:.2f} to {:.2f} times, since both search all cells.",
      first->from, first->name,
      last->from <= 100 ? fmt::format("{:.0f} % ({})", last->from, last->name)
                        : fmt::format("never ({})", last->name),
      least->at_all, least->name, greatest->at_all, greatest->name, frames.min.frame_at_all,
      frames.max.frame_at_all);
  finding.figures = {{"earliest_crossover", first->from, "%"},
                     {"latest_crossover", std::min(last->from, 100.0), "%"},
                     {"least_ratio_where_all_move", least->at_all},
                     {"greatest_ratio_where_all_move", greatest->at_all},
                     {"least_ratio_of_frames_where_all_move", frames.min.frame_at_all},
                     {"greatest_ratio_of_frames_where_all_move", frames.max.frame_at_all}};
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const Table rows = table.where("case", crossings[i].name);
    finding.figures.push_back({fmt::format("crossover_{:.0f}_boxes_drift_{:.0f}_percent",
                                           rows.numbers("boxes").at(0), 100 * rows.numbers("drift").at(0)),
                               std::min(crossings[i].from, 100.0), "%"});
  }
  return finding;
}

}  // namespace

Experiment grid_rebuilding() {
  return {
      .number = 11,
      .name = "grid_rebuilding",
      .title = "Grid: reinserting or rebuilding",
      .claim =
          "As a whole if most objects are moving objects, then rebuilding the entire subcollections "
          "would be faster as reinserting requires one hash to find an object and another hash to place "
          "it. Whereas rebuilding requires only one hash to place an object.",
      .section = "VI-B",
      .measured =
          "The time to mend the cells of the paper's grid on uniform boxes, by the fraction that moves: each "
          "mover found by one hash and placed by another (paper_grid:update=reinsert), or all boxes added to "
          "empty "
          "cells (update=rebuild). Finding out by a flag which boxes moved is part of it; the search of all "
          "cells "
          "that follows is the same for both.",
      .measure = measure,
      .judge = judge};
}

}  // namespace broadside::lab

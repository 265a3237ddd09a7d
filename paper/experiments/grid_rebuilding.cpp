// Section VI-B: where most boxes move, a grid is rebuilt faster than they are reinserted into it.
#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/following.hpp"
#include "paper/experiments/growth.hpp"

namespace broadside::lab {
namespace {

constexpr const char* reinserting = "grid:update=reinsert";
constexpr const char* translating = "grid:update=translate";
constexpr const char* rebuilding = "grid:update=rebuild";

/// "Most objects are moving": more than half of them.
constexpr double most = 50;

struct Case {
  int dimension;
  std::size_t boxes;
  double drift;
};

std::vector<Table> measure(const Laboratory& laboratory) {
  const Chart chart =
      log_log_chart("Reinserting over rebuilding, by the boxes that move: below 1 reinserting wins", "moving",
                    "reinserting over rebuilding", "case");
  Chart chart_3d = chart;
  Chart chart_2d = chart;
  chart_2d.title += ", 2D";
  chart_2d.where = {{"dimension", "2D"}};
  chart_3d.title += ", 3D";
  chart_3d.where = {{"dimension", "3D"}};
  Table table{.name = "times",
              .title = "A frame of the grid: movers reinserted, translated, or all pairs found anew",
              .columns = {{"case"},
                          {"dimension"},
                          {"boxes"},
                          {"drift", "of a box"},
                          {"moving", "%"},
                          {"reinserting", "ms"},
                          {"translating", "ms"},
                          {"rebuilding", "ms"},
                          {"reinserting over rebuilding"},
                          {"tests reinserting"},
                          {"tests rebuilding"}},
              .charts = {chart_2d, chart_3d}};
  const auto fractions =
      laboratory.either<std::vector<double>>({0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1}, {0.1, 0.3, 1});
  constexpr std::size_t usual = 10'000;
  const std::size_t many = laboratory.either<std::size_t>(100'000, 20'000);
  Effort few = effort_to_follow(laboratory);
  few.least_rounds = 2;
  const std::size_t frames = laboratory.either<std::size_t>(20, 6);
  for (const int dimension : {2, 3}) {
    const std::vector<Case> cases = {
        {dimension, 1'000, 0.2}, {dimension, usual, 0.2}, {dimension, many, 0.2}, {dimension, usual, 2}};
    for (const Case& of : cases) {
      const std::string name =
          fmt::format("{}, {} boxes, drift {}", dimension_text(dimension), grouped(of.boxes), of.drift);
      for (const double moving : fractions) {
        const CaseResult result =
            laboratory.measure(fmt::format("{},{},{}", reinserting, translating, rebuilding),
                               {.scene = "uniform",
                                .dimension = dimension,
                                .boxes = of.boxes,
                                .moving = moving,
                                .frames = of.boxes > usual ? std::size_t{6} : frames,
                                .drift = of.drift},
                               of.boxes > usual ? few : effort_to_follow(laboratory));
        const Measurement& inserted = measurement_of(result, reinserting);
        const Measurement& rebuilt = measurement_of(result, rebuilding);
        table.add({name, dimension_text(dimension), static_cast<double>(of.boxes), of.drift, 100 * moving,
                   time_cell(inserted), time_cell(measurement_of(result, translating)), time_cell(rebuilt),
                   ratio_cell(time_cell(inserted), time_cell(rebuilt)), tests_cell(inserted),
                   tests_cell(rebuilt)});
      }
    }
  }
  return {table};
}

/// What one case comes to.
struct Crossing {
  std::string name;
  double from = 0;    ///< % that move from which on rebuilding wins; above 100 if it never does
  double at_all = 0;  ///< reinserting over rebuilding where all move
  double tests_at_all = 0;
};

Crossing crossing_of(const Table& table, const std::string& name) {
  const Table rows = table.where("case", name);
  const auto from = crossover_in(rows, "moving", "rebuilding", "reinserting");
  const auto ratios = rows.points("moving", "reinserting over rebuilding");
  const auto tests = rows.points("tests rebuilding", "tests reinserting");
  if (ratios.size() < 2 || tests.empty() || !(tests.back().first > 0))
    throw std::invalid_argument(fmt::format(
        "table 'times': {} rows with times and tests of '{}'; expected two", ratios.size(), name));
  return {name, from.value_or(200), ratios.back().second, tests.back().second / tests.back().first};
}

Finding judge(const std::vector<Table>& tables) {
  const Table& table = table_named(tables, "times");
  std::vector<Crossing> crossings;
  for (const std::string& name : table.distinct_texts("case")) crossings.push_back(crossing_of(table, name));
  if (crossings.empty()) throw std::invalid_argument("table 'times' has no rows; expected two a case");
  const auto [first, last] = std::ranges::minmax_element(crossings, {}, &Crossing::from);
  const auto [least, greatest] = std::ranges::minmax_element(crossings, {}, &Crossing::at_all);
  const auto tests = std::ranges::minmax(crossings, {}, &Crossing::tests_at_all);

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
      "Rebuilding is the faster one from {:.0f} % moving boxes on ({}) at the earliest and {} at the latest. "
      "Where all move, reinserting takes {:.2f} ({}) to {:.2f} times ({}) as long. Two hashes against one "
      "would be 2; there are {:.1f} to {:.1f} times as many tests as well, since each mover is compared with "
      "what was near it and with what is, and two movers with each other twice.",
      first->from, first->name,
      last->from <= 100 ? fmt::format("{:.0f} % ({})", last->from, last->name)
                        : fmt::format("never ({})", last->name),
      least->at_all, least->name, greatest->at_all, greatest->name, tests.min.tests_at_all,
      tests.max.tests_at_all);
  finding.figures = {{"earliest_crossover", first->from, "%"},
                     {"latest_crossover", std::min(last->from, 100.0), "%"},
                     {"least_ratio_where_all_move", least->at_all},
                     {"greatest_ratio_where_all_move", greatest->at_all},
                     {"least_ratio_of_tests_where_all_move", tests.min.tests_at_all},
                     {"greatest_ratio_of_tests_where_all_move", tests.max.tests_at_all}};
  for (std::size_t i = 0; i < crossings.size(); ++i) {
    const Table rows = table.where("case", crossings[i].name);
    finding.figures.push_back({fmt::format("crossover_{}_{:.0f}_boxes_drift_{:.0f}_percent",
                                           rows.texts("dimension").at(0) == "2D" ? "2d" : "3d",
                                           rows.numbers("boxes").at(0), 100 * rows.numbers("drift").at(0)),
                               std::min(crossings[i].from, 100.0), "%"});
  }
  return finding;
}

}  // namespace

Experiment grid_rebuilding() {
  return {.number = 11,
          .name = "grid_rebuilding",
          .title = "Grid: reinserting or rebuilding",
          .claim =
              "As a whole if most objects are moving objects, then rebuilding the entire subcollections "
              "would be faster as reinserting requires one hash to find an object and another hash to place "
              "it. Whereas rebuilding requires only one hash to place an object.",
          .section = "VI-B",
          .measured =
              "A frame of our grid on uniform boxes, by the fraction that moves: each mover taken from its "
              "cells and filed anew (update=reinsert, at any fraction), or all pairs found anew and compared "
              "with those of the frame before (update=rebuild).",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

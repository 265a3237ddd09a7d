// Section VI-B: for boxes that span many cells, translating references to neighbouring cells beats
// reinsertion; for boxes in a single cell it is said to be the other way round.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "paper/experiments/boxes.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/following.hpp"
#include "paper/experiments/growth.hpp"

namespace broadside::lab {
namespace {

constexpr const char* scene = "uniform";
constexpr double moving = 0.2;
constexpr const char* small_step = "a tenth of a cell";
constexpr const char* whole_step = "a cell";

/// What is less than this faster is as fast.
constexpr double margin = 0.1;

/// Cells that a mover's references are taken from or put into, a mover and frame.
struct Touched {
  double reinserting = 0;
  double translating = 0;
};

/// The cells of a box, or those that two have in common.
template <int D>
double cells_of(const Box<D>& box, const Box<D>& other, double cell) {
  double cells = 1;
  for (int axis = 0; axis < D; ++axis) {
    const double first = std::floor(std::max(box.min[axis], other.min[axis]) / cell);
    const double last = std::floor(std::min(box.max[axis], other.max[axis]) / cell);
    cells *= std::max(0.0, last - first + 1);
  }
  return cells;
}

template <int D>
Touched count_cells(const CaseRequest& request, double cell) {
  const History<D> history = history_of<D>(
      request.scene,
      {.boxes = request.boxes, .frames = request.frames, .moving = request.moving, .drift = request.drift});
  std::vector<Box<D>> boxes = history.boxes;
  Touched touched;
  double movers = 0;
  for (const Step<D>& step : history.steps) {
    for (std::size_t i = 0; i < step.changed.size(); ++i) {
      const Box<D>& before = boxes[index(step.changed[i])];
      const Box<D>& now = step.boxes[i];
      const double all = cells_of(before, before, cell) + cells_of(now, now, cell);
      touched.reinserting += all;
      touched.translating += all - 2 * cells_of(before, now, cell);
      ++movers;
    }
    apply(step, boxes);
  }
  return {touched.reinserting / movers, touched.translating / movers};
}

Table make_table(int dimension) {
  const std::string axes = dimension_text(dimension);
  return {.name = fmt::format("ways_{}d", dimension),
          .title = fmt::format("A mover of the grid in {}: taken out and filed anew, or only where it leaves "
                               "and enters cells; by the cells that a box spans",
                               axes),
          .columns = {{"step"},
                      {"cell", "of a box"},
                      {"cells a box"},
                      {"reinserting", "ns"},
                      {"translating", "ns"},
                      {"reinserting over translating"},
                      {"cells touched by reinserting"},
                      {"cells touched by translating"}},
          .charts = {
              {.title = "Reinserting over translating, by the cells a box spans: above 1 translating wins; " +
                        axes,
               .x = "cells a box",
               .y = "reinserting over translating",
               .series = "step",
               .log_x = true}}};
}

std::vector<Table> measure(const Laboratory& laboratory) {
  std::vector<Table> tables;
  for (const int dimension : {2, 3}) {
    Table& table = tables.emplace_back(make_table(dimension));
    std::vector<double> cells = {16, 8, 4, 2, 1, 0.5, 0.25};
    if (laboratory.is_quick()) cells = {16, 4, 1, 0.25};
    if (dimension == 2) cells.push_back(0.125);
    const auto boxes = static_cast<std::size_t>(dimension == 2 ? 6'000 : 5'500);
    for (const auto& [step, cells_a_frame] : {std::pair{small_step, 0.1}, std::pair{whole_step, 1.0}}) {
      for (const double cell : cells) {
        const std::string reinserting = fmt::format("grid:cell={}:span=16:update=reinsert", cell);
        const std::string translating = fmt::format("grid:cell={}:span=16:update=translate", cell);
        const CaseRequest request = {.scene = scene,
                                     .dimension = dimension,
                                     .boxes = boxes,
                                     .moving = moving,
                                     .frames = laboratory.either<std::size_t>(12, 5),
                                     .drift = cells_a_frame * cell};
        const CaseResult result =
            laboratory.measure(reinserting + "," + translating, request, effort_to_follow(laboratory));
        const Measurement& reinserted = measurement_of(result, reinserting);
        const Cell slow = mover_cell(result, reinserting);
        const Cell fast = mover_cell(result, translating);
        const Touched touched =
            dimension == 2 ? count_cells<2>(request, cell) : count_cells<3>(request, cell);
        table.add({step, cell, scaled_cell(references_cell(reinserted), 1.0 / static_cast<double>(boxes)),
                   slow, fast, ratio_cell(slow, fast), touched.reinserting, touched.translating});
      }
    }
  }
  return tables;
}

/// One way of moving, from the boxes of fewest cells to those of most.
struct Line {
  std::vector<std::pair<double, double>> gains;  ///< cells a box, reinserting over translating
  double from = 0;  ///< cells a box from which on translating stays faster; 0 if it never is

  double single() const { return gains.front().second; }
  double most() const { return gains.back().second; }
};

Line line_of(const Table& table, const std::string& step) {
  const Table rows = table.where("step", step);
  Line line{.gains = rows.points("cells a box", "reinserting over translating")};
  if (line.gains.size() < 2)
    throw std::invalid_argument(fmt::format("table '{}': {} rows with times for steps of {}; expected two",
                                            table.name, line.gains.size(), step));
  std::ranges::sort(line.gains);
  std::vector<std::pair<double, double>> unit = line.gains;
  for (auto& [cells, gain] : unit) gain = 1 + margin;
  line.from = crossover(unit, line.gains).value_or(0);
  return line;
}

Finding judge(const std::vector<Table>& tables) {
  const std::array<std::string, 2> names = {"ways_2d", "ways_3d"};
  std::vector<Line> small;
  std::vector<Line> whole;
  double fewest_saved = INFINITY;
  double most_saved = 0;
  for (const std::string& name : names) {
    const Table& table = table_named(tables, name);
    small.push_back(line_of(table, small_step));
    whole.push_back(line_of(table, whole_step));
    for (const auto& [reinserting, translating] :
         table.points("cells touched by reinserting", "cells touched by translating")) {
      if (!(reinserting > 0))
        throw std::invalid_argument(
            fmt::format("table '{}': {} cells touched; expected more than 0", name, reinserting));
      const double saved = 1 - translating / reinserting;
      fewest_saved = std::min(fewest_saved, saved);
      most_saved = std::max(most_saved, saved);
    }
  }
  if (!std::isfinite(fewest_saved))
    throw std::invalid_argument(
        "tables 'ways_2d' and 'ways_3d': no cells touched; expected them in each row");
  // A step of a cell is what the sentence is about: its references have to go to neighbours.
  const bool wins_large = std::ranges::all_of(whole, [](const Line& line) { return line.from > 0; });
  const bool loses_single =
      std::ranges::all_of(whole, [](const Line& line) { return line.single() < 1 / (1 + margin); });
  const double from = std::max(whole[0].from, whole[1].from);

  Finding finding;
  finding.verdict = !wins_large    ? Verdict::does_not_hold
                    : loses_single ? Verdict::holds
                                   : Verdict::holds_when;
  if (finding.verdict == Verdict::holds_when)
    finding.condition = fmt::format(
        "a box spans {:.0f} cells or more; in a single cell reinserting is not the faster one", from);
  finding.reason = fmt::format(
      "With steps of a cell, translating is faster by more than {:.0f} % from {:.1f} cells a box on in 2D "
      "and {:.1f} in 3D, up to {:.2f} times in 2D; with boxes in {:.1f} cells, reinserting takes {:.2f} "
      "times as long. With steps of a tenth of a cell translating is {:.2f} times as fast even there, since "
      "most movers leave no cell, and up to {:.2f} times. It touches {:.0f} to {:.0f} % fewer cells, and "
      "never more. The comparison with what is near is the same for both and part of every time.",
      100 * margin, whole[0].from, whole[1].from, whole[0].most(), whole[0].gains.front().first,
      whole[0].single(), small[0].single(), small[0].most(), 100 * fewest_saved, 100 * most_saved);
  finding.figures = {{"single_cell_step_of_a_cell_2d", whole[0].single()},
                     {"single_cell_step_of_a_cell_3d", whole[1].single()},
                     {"single_cell_small_step_2d", small[0].single()},
                     {"single_cell_small_step_3d", small[1].single()},
                     {"most_cells_step_of_a_cell_2d", whole[0].most()},
                     {"most_cells_step_of_a_cell_3d", whole[1].most()},
                     {"most_cells_small_step_2d", small[0].most()},
                     {"most_cells_small_step_3d", small[1].most()},
                     {"most_cells_a_box_2d", whole[0].gains.back().first, "cells"},
                     {"most_cells_a_box_3d", whole[1].gains.back().first, "cells"},
                     {"translating_wins_from_2d", whole[0].from, "cells"},
                     {"translating_wins_from_3d", whole[1].from, "cells"},
                     {"least_share_of_cells_saved", 100 * fewest_saved, "%"},
                     {"greatest_share_of_cells_saved", 100 * most_saved, "%"}};
  return finding;
}

}  // namespace

Experiment grid_translation() {
  return {.number = 10,
          .name = "grid_translation",
          .title = "Grid: translating or reinserting",
          .claim =
              "If the change in position is greater than the offset then we can simply translate each "
              "reference of an object to its neighboring subcollection. This can be faster than reinserting "
              "if the object is large and spans many grids, else reinserting into a single subcollection "
              "will always be faster.",
          .section = "VI-B",
          .measured =
              "Our grid on uniform boxes of which a fifth moves, with cells from 16 times a box's size to an "
              "eighth of it (a quarter in 3D), all boxes on one level (span=16): time a mover and the cells "
              "whose lists it changes, with each way followed throughout. Steps of a cell leave cells, those "
              "of a tenth mostly do not.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

// Section III: the size of a grid's cells is a balancing act. Cells are told by the size that they have,
// which is not the one that was asked for where the grid would not fit (errata 2c and 3i).
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "broadside/algorithm.hpp"
#include "broadside/debug/outline.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/scenes/scene.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/laboratory.hpp"

namespace broadside::lab {
namespace {

/// What the verdict rests on; files are shown beside them where they are there.
const std::vector<std::string> generated_scenes = {"uniform", "power_law", "mixed", "clustered", "thin"};
const std::string file_scene = "bunny";

/// A grid in one of the dimensions, and the table of its curves.
struct Grid {
  std::string table;
  std::string algorithm;
  int dimension;
  std::string label;
};

const std::vector<Grid>& grids() {
  static const std::vector<Grid> list = {{"paper", "paper_grid", 2, "the paper's grid"},
                                         {"ours", "grid", 2, "our grid"},
                                         {"ours_3d", "grid", 3, "our grid in 3D"}};
  return list;
}

/// The mean length of a scene's boxes, and that of their world.
struct Lengths {
  double box = 0;
  double world = 0;
};

template <int D>
Lengths lengths_of(const std::string& scene, std::size_t count) {
  const std::vector<Box<D>> boxes = history_of<D>(scene, {.boxes = count}).boxes;
  const Box<D> bounds = bounds_of<D>(boxes);
  Lengths lengths;
  for (int axis = 0; axis < D; ++axis) {
    for (const Box<D>& box : boxes)
      lengths.box += (double{box.max[axis]} - double{box.min[axis]}) / D / static_cast<double>(boxes.size());
    lengths.world = std::max(lengths.world, double{bounds.max[axis]} - double{bounds.min[axis]});
  }
  return lengths;
}

/// The specs of a grid with cells from twice `size` boxes up to the whole world, by their size in boxes.
std::vector<std::pair<double, std::string>> sizes_of(const Grid& grid, const Lengths& lengths, double size) {
  std::vector<std::pair<double, std::string>> sizes;
  do {
    size *= 2;
    sizes.emplace_back(size, fmt::format("{}:cell={:.4g}", grid.algorithm, size * lengths.box));
  } while (size * lengths.box < lengths.world);
  return sizes;
}

/// What a grid lays over the boxes of the seeds that it was timed on, and counts there, in the mean.
struct Cells {
  double side = 0;  ///< in the coordinates' unit
  double references = 0;
  double tests = 0;
};

/// The side of a cell, by the cells that the algorithm lays over the boxes: most often that of most of them,
/// since the ones at the border end with the boxes.
template <int D>
double side_of(const std::string& algorithm, const std::vector<Box<D>>& boxes) {
  const Outline<D> cells = outline<D, float>(algorithm, boxes);
  const int axis = cells.swept_axis == 0 ? 1 : 0;
  std::vector<double> sides;
  for (const Box<D>& cell : cells.levels.at(0))
    sides.push_back(double{cell.max[axis]} - double{cell.min[axis]});
  return median(sides);
}

template <int D>
Cells cells_of(const Case& of, const std::string& scene, std::size_t boxes, const Measurement& measured) {
  Finder<D> finder(measured.algorithm);
  const std::size_t seeds = std::min(of.seeds.size(), measured.samples_ms.size());
  Cells cells;
  for (std::size_t i = 0; i < seeds; ++i) {
    const std::vector<Box<D>> some = history_of<D>(scene, {.boxes = boxes, .seed = of.seeds[i]}).boxes;
    PairCounter pairs;
    const Statistics statistics = finder.find(some, pairs).value();
    const auto share = 1 / static_cast<double>(seeds);
    cells.references += share * static_cast<double>(statistics.references);
    cells.tests += share * static_cast<double>(statistics.tests);
    cells.side += share * side_of<D>(measured.algorithm, some);
  }
  return cells;
}

/// Adds a scene's curve, and what the grid's own choice takes beside it.
void measure_scene(const Laboratory& laboratory, const std::string& scene, const Grid& grid, Table& curves,
                   Table& choices) {
  // As many as brute force in a single cell allows; of ours as many that looking for a size, which
  // takes as long for any number of boxes, is a small part of the search.
  const std::size_t boxes = grid.algorithm == "paper_grid" ? laboratory.either<std::size_t>(10'000, 4'000)
                                                           : laboratory.either<std::size_t>(40'000, 24'000);
  const Lengths lengths = grid.dimension == 2 ? lengths_of<2>(scene, boxes) : lengths_of<3>(scene, boxes);
  const auto sizes = sizes_of(grid, lengths, laboratory.either(0.0625, 0.125));
  std::string specs = grid.algorithm;
  for (const auto& [size, spec] : sizes) specs += "," + spec;
  const std::size_t asked = scene == file_scene ? 0 : boxes;
  const CaseResult result =
      laboratory.measure(specs, {.scene = scene, .dimension = grid.dimension, .boxes = asked});
  const auto cells_with = [&](const Measurement& measured) {
    laboratory.at(fmt::format("cells of {} on {}", measured.algorithm, scene));
    return grid.dimension == 2 ? cells_of<2>(result.of, scene, asked, measured)
                               : cells_of<3>(result.of, scene, asked, measured);
  };
  struct Point {
    const Measurement* measured;
    double size;  // asked for, in boxes
    Cells cells;
  };
  std::vector<Point> points;
  for (const auto& [size, spec] : sizes) {
    const Measurement& measured = measurement_of(result, spec);
    if (measured.samples_ms.empty()) continue;
    const Cells cells = cells_with(measured);
    // The same cells again, which are what the grid came to take: one time of them is enough.
    if (points.empty() || cells.side > 1.01 * points.back().cells.side)
      points.push_back({&measured, size, cells});
  }
  const Measurement& chosen = measurement_of(result, grid.algorithm);
  if (points.empty() || chosen.samples_ms.empty()) return;
  const auto time_of = [](const Point& point) { return median(point.measured->samples_ms); };
  const Point best = std::ranges::min(points, {}, time_of);
  const auto count = static_cast<double>(result.of.boxes);
  for (const Point& point : points) {
    std::vector<Cell> row = {scene,
                             point.cells.side / lengths.box,
                             point.size,
                             point.cells.references / count,
                             point.cells.tests / count,
                             time_of(point)};
    append(row, ratio_cells(result, *point.measured, *best.measured));
    curves.add(row);
  }
  std::vector<Cell> row = {
      scene,         grid.label,       best.cells.side / lengths.box, cells_with(chosen).side / lengths.box,
      time_of(best), time_cell(chosen)};
  append(row, ratio_cells(result, chosen, *best.measured));
  choices.add(row);
}

std::vector<Table> measure(const Laboratory& laboratory) {
  std::vector<std::string> scenes = generated_scenes;
  if (std::ranges::find(lab::scenes(), file_scene, &Scene::name) != lab::scenes().end())
    scenes.push_back(file_scene);
  Table choices{.name = "choices",
                .title = "The best size of those measured, and the grid's own choice",
                .columns = {{"scene"},
                            {"grid"},
                            {"best cell", "boxes"},
                            {"chosen cell", "boxes"},
                            {"time of the best", "ms"},
                            {"time of the chosen", "ms"}},
                .charts = {{.title = "Time with the cell that the grid chooses, over that with the best cell",
                            .kind = ChartKind::bars,
                            .x = "scene",
                            .y = "chosen over best",
                            .series = "grid"}}};
  append(choices.columns, ratio_columns("chosen over best"));
  std::vector<Table> tables;
  for (const Grid& grid : grids()) {
    Table curves{
        .name = grid.table,
        .title = fmt::format("Time of {} over the length of a cell, in mean lengths of a box", grid.label),
        .columns = {{"scene"},
                    {"cell", "boxes"},
                    {"cell asked for", "boxes"},
                    {"references a box"},
                    {"tests a box"},
                    {"time", "ms"}},
        .charts = {log_log_chart(fmt::format("Time of {} over the size of cells", grid.label), "cell", "time",
                                 "scene")}};
    append(curves.columns, ratio_columns("time over best"));
    for (const std::string& scene : scenes) measure_scene(laboratory, scene, grid, curves, choices);
    tables.push_back(std::move(curves));
  }
  tables.push_back(std::move(choices));
  return tables;
}

/// A curve that is this much above its least at both ends is a U; noise is a tenth.
constexpr double clearly = 1.25;

/// One scene's curve.
struct Valley {
  double size = 0;   ///< of the best cells
  RatioAt left{};    ///< the time with the smallest cells over the best
  RatioAt right{};   ///< with the largest
  double width = 0;  ///< the largest over the smallest of the sizes whose time is at most clearly the best

  bool is_u() const { return left.ratio >= clearly && right.ratio >= clearly; }
};

Valley valley_of(const Table& curves, const std::string& scene) {
  const std::vector<RatioAt> points = ratios_over(curves.where("scene", scene), "cell", "time over best");
  if (points.size() < 4)
    throw std::invalid_argument(fmt::format("table '{}' has {} sizes on {}; expected four at least",
                                            curves.name, points.size(), scene));
  const RatioAt best = std::ranges::min(points, {}, &RatioAt::ratio);
  double from = best.x;
  double to = best.x;
  for (const RatioAt& point : points) {
    if (point.ratio > clearly * best.ratio) continue;
    from = std::min(from, point.x);
    to = std::max(to, point.x);
  }
  if (!(from > 0))
    throw std::invalid_argument(
        fmt::format("table '{}': cells of {} boxes; expected more than 0", curves.name, from));
  return {best.x, points.front(), points.back(), to / from};
}

/// What a grid's own choice loses over the scenes that the verdict rests on.
struct Loss {
  double mean = 0;
  Interval interval{};  ///< of the mean: what the clock leaves open
  RatioAt worst{};
  std::string scene{};
};

Loss loss_of(const Table& choices, const std::string& grid) {
  Loss loss;
  std::vector<double> losses;
  double squares = 0;  // of the half widths of the intervals' logarithms
  for (const std::string& scene : generated_scenes) {
    const Table here = choices.where("grid", grid).where("scene", scene);
    const RatioAt ratio{
        .ratio = here.number("chosen over best"),
        .interval = {here.number("chosen over best low"), here.number("chosen over best high")}};
    losses.push_back(ratio.ratio);
    squares += std::pow(std::log(ratio.interval.high / ratio.interval.low) / 2, 2);
    if (ratio.ratio <= loss.worst.ratio) continue;
    loss.worst = ratio;
    loss.scene = scene;
  }
  loss.mean = geometric_mean(losses);
  const double width = std::exp(std::sqrt(squares) / static_cast<double>(losses.size()));
  loss.interval = {loss.mean / width, loss.mean * width};
  return loss;
}

Finding judge(const std::vector<Table>& tables) {
  Finding finding;
  std::vector<std::string> balanced;  // scenes in which the paper's grid has a U
  std::vector<std::string> optima;
  std::size_t own_balanced = 0;
  double narrowest = std::numeric_limits<double>::infinity();
  double widest = 0;
  for (const std::string& scene : generated_scenes) {
    const Valley paper = valley_of(table_named(tables, "paper"), scene);
    if (paper.is_u()) balanced.push_back(scene);
    optima.push_back(fmt::format("{} ({})", rounded(paper.size), scene));
    narrowest = std::min(narrowest, paper.width);
    widest = std::max(widest, paper.width);
    finding.figures.push_back({"best_cell_" + scene, paper.size, "boxes"});
    finding.figures.push_back({"smallest_over_best_" + scene, paper.left.ratio, "", paper.left.interval});
    finding.figures.push_back({"largest_over_best_" + scene, paper.right.ratio, "", paper.right.interval});
    for (const Grid& grid : grids()) {
      if (grid.algorithm != "paper_grid" && valley_of(table_named(tables, grid.table), scene).is_u())
        ++own_balanced;
    }
  }
  const Table& choices = table_named(tables, "choices");
  std::vector<std::string> losses;
  double mean_of_ours = 0;
  Loss worst_of_ours;
  for (const Grid& grid : grids()) {
    const Loss loss = loss_of(choices, grid.label);
    losses.push_back(fmt::format("{} {:.2f} times as long as with the best (at most {:.2f}, {})", grid.label,
                                 loss.mean, loss.worst.ratio, loss.scene));
    if (grid.algorithm != "paper_grid") {
      mean_of_ours = std::max(mean_of_ours, loss.mean);
      if (loss.worst.ratio > worst_of_ours.worst.ratio) worst_of_ours = loss;
    }
    finding.figures.push_back({grid.table + "_chosen_over_best", loss.mean, "", loss.interval});
    finding.figures.push_back(
        {grid.table + "_chosen_over_best_at_most", loss.worst.ratio, "", loss.worst.interval});
  }

  Statement balance{.name = "balance",
                    .text = "the size of a cell balances references against boxes in a cell",
                    .threshold = fmt::format("both the smallest and the largest cells take {} times the time "
                                             "of the best, or more, in each scene",
                                             clearly),
                    .evidence = {"scenes_with_both_ends_high", "narrowest_valley", "widest_valley"}};
  if (balanced.size() == generated_scenes.size()) {
    balance.verdict = Verdict::confirmed;
  } else if (!balanced.empty()) {
    balance.verdict = Verdict::within_bounds;
    balance.condition = fmt::format("boxes are as in {}", fmt::join(balanced, ", "));
  }
  // Where a rule finds the balance as well, it is no matter of hands.
  Statement by_hand{
      .name = "by_hand",
      .text = "so it is important to tune it by hand",
      .threshold = fmt::format("the size that a rule chooses takes more than {} times the time "
                               "of the best, as a mean; beyond noise in one scene, within bounds",
                               clearly),
      .evidence = {"ours_chosen_over_best", "ours_3d_chosen_over_best", "ours_chosen_over_best_at_most",
                   "ours_3d_chosen_over_best_at_most"}};
  if (mean_of_ours > clearly) {
    by_hand.verdict = Verdict::confirmed;
  } else if (worst_of_ours.worst.is_above(clearly)) {
    by_hand.verdict = Verdict::within_bounds;
    by_hand.condition = fmt::format(
        "boxes are as in {}, where the size that our grid chooses takes {:.2f} times as "
        "long as the best",
        worst_of_ours.scene, worst_of_ours.worst.ratio);
  }
  finding.statements = {balance, by_hand};
  finding.reason = fmt::format(
      "In {} of {} scenes both the smallest and the largest cells take the paper's grid more than {} times "
      "as long as the best, in lengths of a box: {}. Sizes that cost less than that span a factor "
      "of {} to {}. Of our grid's {} curves, {} have both ends as high. With the size that it chooses "
      "itself, a grid takes, as a mean: {}.",
      balanced.size(), generated_scenes.size(), clearly, fmt::join(optima, ", "), rounded(narrowest),
      rounded(widest), 2 * generated_scenes.size(), own_balanced, fmt::join(losses, "; "));
  finding.figures.push_back({"scenes_with_both_ends_high", static_cast<double>(balanced.size())});
  finding.figures.push_back({"own_curves_with_both_ends_high", static_cast<double>(own_balanced)});
  finding.figures.push_back({"narrowest_valley", narrowest});
  finding.figures.push_back({"widest_valley", widest});
  return finding;
}

}  // namespace

Experiment grid_cell_size() {
  return {
      .number = 5,
      .name = "grid_cell_size",
      .title = "The size of cells is a balancing act",
      .claim =
          "Thus it is important to hand tune the grid size so that the number of spanning calls are limited "
          "and the number of elements in the subcollections are kept to a minimum. This is a balancing act "
          "between the number of objects in a collection and the number of spanning calls are needed.",
      .section = "III",
      .measured =
          "The time of the paper's grid, on 10,000 boxes, and of ours, on 40,000, with cells from an eighth "
          "of a box up to the world, as far as the grid takes cells that small, and with the size that they "
          "choose, in five scenes; and on the bunny, where it is there. Cells are told by the size that they "
          "have; references and tests are those of the seeds that were timed.",
      .measure = measure,
      .judge = judge};
}

}  // namespace broadside::lab

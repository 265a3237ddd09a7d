// Section III: the size of a grid's cells is a balancing act.
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

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
  const CaseResult result = laboratory.measure(
      specs, {.scene = scene, .dimension = grid.dimension, .boxes = scene == file_scene ? 0 : boxes});
  const auto count = static_cast<double>(result.of.boxes);
  double best_size = 0;
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [size, spec] : sizes) {
    const Measurement& measured = measurement_of(result, spec);
    if (measured.samples_ms.empty()) continue;
    const double time = median(measured.samples_ms);
    curves.add(
        {scene, size, over(references_cell(measured), count), over(tests_cell(measured), count), time});
    if (time >= best) continue;
    best = time;
    best_size = size;
  }
  const Measurement& chosen = measurement_of(result, grid.algorithm);
  if (chosen.samples_ms.empty() || best_size == 0) return;
  choices.add({scene, grid.label, best_size, best, time_cell(chosen), median(chosen.samples_ms) / best});
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
                            {"time of the best", "ms"},
                            {"time of the chosen", "ms"},
                            {"chosen over best"}},
                .charts = {{.title = "Time with the cell that the grid chooses, over that with the best cell",
                            .kind = ChartKind::bars,
                            .x = "scene",
                            .y = "chosen over best",
                            .series = "grid"}}};
  std::vector<Table> tables;
  for (const Grid& grid : grids()) {
    Table curves{
        .name = grid.table,
        .title = fmt::format("Time of {} over the length of a cell, in mean lengths of a box", grid.label),
        .columns = {{"scene"}, {"cell", "boxes"}, {"references a box"}, {"tests a box"}, {"time", "ms"}},
        .charts = {log_log_chart(fmt::format("Time of {} over the size of cells", grid.label), "cell", "time",
                                 "scene")}};
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
  double left = 0;   ///< the time with the smallest cells over the best
  double right = 0;  ///< with the largest
  double width = 0;  ///< the largest over the smallest of the sizes whose time is at most clearly the best

  bool is_u() const { return left >= clearly && right >= clearly; }
};

Valley valley_of(const Table& curves, const std::string& scene) {
  const auto points = curves.where("scene", scene).points("cell", "time");
  if (points.size() < 4)
    throw std::invalid_argument(fmt::format("table '{}' has {} sizes on {}; expected four at least",
                                            curves.name, points.size(), scene));
  const auto& [size, best] = *std::ranges::min_element(points, {}, [](const auto& p) { return p.second; });
  Valley valley{size, points.front().second / best, points.back().second / best, 1};
  double from = size;
  double to = size;
  for (const auto& [cell, time] : points) {
    if (time > clearly * best) continue;
    from = std::min(from, cell);
    to = std::max(to, cell);
  }
  valley.width = to / from;
  return valley;
}

/// What a grid's own choice loses over the scenes that the verdict rests on.
struct Loss {
  double mean = 0;
  double worst = 0;
  std::string scene{};
};

Loss loss_of(const Table& choices, const std::string& grid) {
  Loss loss;
  std::vector<double> losses;
  for (const std::string& scene : generated_scenes) {
    const std::vector<double> here =
        choices.where("grid", grid).where("scene", scene).numbers("chosen over best");
    if (here.empty())
      throw std::invalid_argument(fmt::format("table 'choices' has nothing of {} on {}", grid, scene));
    losses.push_back(here.front());
    if (here.front() <= loss.worst) continue;
    loss.worst = here.front();
    loss.scene = scene;
  }
  loss.mean = geometric_mean(losses);
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
    finding.figures.push_back({"smallest_over_best_" + scene, paper.left});
    finding.figures.push_back({"largest_over_best_" + scene, paper.right});
    for (const Grid& grid : grids()) {
      if (grid.algorithm != "paper_grid" && valley_of(table_named(tables, grid.table), scene).is_u())
        ++own_balanced;
    }
  }
  const Table& choices = table_named(tables, "choices");
  std::vector<std::string> losses;
  double loss_of_ours = 0;
  for (const Grid& grid : grids()) {
    const Loss loss = loss_of(choices, grid.label);
    losses.push_back(fmt::format("{} {:.2f} times as long as with the best (at most {:.2f}, {})", grid.label,
                                 loss.mean, loss.worst, loss.scene));
    if (grid.algorithm != "paper_grid") loss_of_ours = std::max(loss_of_ours, loss.mean);
    finding.figures.push_back({grid.table + "_chosen_over_best", loss.mean});
    finding.figures.push_back({grid.table + "_chosen_over_best_at_most", loss.worst});
  }

  // Where a rule finds the balance as well, it is no matter of hands.
  if (balanced.size() == generated_scenes.size() && loss_of_ours > clearly) {
    finding.verdict = Verdict::holds;
  } else if (balanced.size() == generated_scenes.size()) {
    finding.verdict = Verdict::holds_when;
    finding.condition = fmt::format(
        "the hand may be a rule: with the size that our grid chooses, it takes {:.2f} times as long as with "
        "the best",
        loss_of_ours);
  } else if (!balanced.empty()) {
    finding.verdict = Verdict::holds_when;
    finding.condition = fmt::format("boxes are as in {}", fmt::join(balanced, ", "));
  }
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
          "of a box up to the world, and with the size that they choose, in five scenes; and on the bunny, "
          "where it is there.",
      .measure = measure,
      .judge = judge};
}

}  // namespace broadside::lab

// Section IV: sweep and prune needs no bounds of the world; and what the choice of its axis costs.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/sweep_worlds.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

const std::vector<std::string> sweeps = {"sweep_and_prune", "paper_sweep_and_prune"};
const std::vector<std::string> bounded_ones = {"paper_grid", "paper_quadtree"};

Table measure_worlds(const Laboratory& laboratory) {
  Table table{.name = "worlds",
              .title = "Uniform boxes in worlds without bounds, 2D",
              .columns = {{"world"},
                          {"algorithm"},
                          {"boxes"},
                          {"tests"},
                          {"time", "ms"},
                          {"memory", "bytes"},
                          {"bounded world"},
                          {"time over the bounded world's"}},
              .charts = {{.title = "Time over that in the same world with bounds",
                          .kind = ChartKind::bars,
                          .x = "world",
                          .y = "time over the bounded world's",
                          .series = "algorithm",
                          .log_y = true}}};
  const auto boxes = laboratory.either<std::size_t>(10'000, 4'000);
  const std::string algorithms = list_of(sweeps) + "," + list_of(bounded_ones);
  for (const SweepWorld& world : sweep_worlds()) {
    const Scene scene{
        .name = "world",
        .summary = {},
        .source = {},
        .boxes_2d = [&world](const Settings&, std::size_t count, std::uint64_t) { return world.make(count); },
        .fixed_seed = true};
    const CaseResult result = laboratory.measure(algorithms, scene, {.scene = "world", .boxes = boxes});
    for (const Measurement& measured : result.measurements) {
      const Table bounded = table.where("world", world.bounded).where("algorithm", measured.algorithm);
      const Cell time = time_cell(measured);
      Cell ratio;
      if (const double* const milliseconds = std::get_if<double>(&time)) {
        const std::vector<double> base = bounded.numbers("time");
        ratio = world.name == world.bounded ? Cell(1.0)
                : base.empty()              ? Cell()
                                            : Cell(*milliseconds / base[0]);
      }
      table.add({world.name, measured.algorithm, static_cast<double>(boxes), tests_cell(measured), time,
                 bytes_cell(measured), world.bounded, ratio});
    }
  }
  return table;
}

/// How a sweep chooses its axis, and as which spec.
struct Sweep {
  std::string text;
  std::string spec;
  int dimension = 0;  // 0: any
};

const std::string best_axis = "auto";
const std::string with_stripes = "auto, stripes";
const std::string paper = "paper, x";

const std::vector<Sweep>& ways() {
  static const std::vector<Sweep> all = {
      {"x", "sweep_and_prune:axis=x:axes=1"},    {"y", "sweep_and_prune:axis=y:axes=1"},
      {"z", "sweep_and_prune:axis=z:axes=1", 3}, {best_axis, "sweep_and_prune:axes=1"},
      {with_stripes, "sweep_and_prune"},         {paper, "paper_sweep_and_prune"}};
  return all;
}

bool is_there(std::string_view scene) {
  return std::ranges::find(scenes(), scene, &Scene::name) != scenes().end();
}

Table measure_axes(const Laboratory& laboratory) {
  Table table{
      .name = "axes",
      .title = "The sweep along each axis",
      .columns =
          {{"scene"}, {"sweep"}, {"boxes"}, {"tests a box"}, {"time", "ms"}, {"time over best axis's"}},
      .charts = {{.title = "Time of each axis",
                  .kind = ChartKind::bars,
                  .x = "scene",
                  .y = "time",
                  .series = "sweep",
                  .log_y = true}}};
  const Scene standing{
      .name = "towers", .summary = {}, .source = {}, .boxes_2d = towers<2>, .boxes_3d = towers<3>};
  const auto boxes = laboratory.either<std::size_t>(10'000, 3'000);
  const auto add = [&](const std::string& scene, int dimension) {
    std::vector<std::string> specs;
    for (const Sweep& way : ways()) {
      if (way.dimension == 0 || way.dimension == dimension) specs.push_back(way.spec);
    }
    const CaseRequest request{.scene = scene, .dimension = dimension, .boxes = boxes};
    const CaseResult result = scene == "towers" ? laboratory.measure(list_of(specs), standing, request)
                                                : laboratory.measure(list_of(specs), request);
    double best = std::numeric_limits<double>::infinity();
    for (const Measurement& measured : result.measurements) {
      const bool is_single = measured.algorithm.find(":axis=") != std::string::npos;
      if (is_single && !measured.samples_ms.empty()) best = std::min(best, median(measured.samples_ms));
    }
    for (const Sweep& way : ways()) {
      if (way.dimension != 0 && way.dimension != dimension) continue;
      const Measurement& measured = measurement_of(result, way.spec);
      const double count = static_cast<double>(result.of.boxes);
      const Cell time = time_cell(measured);
      const double* const timed = std::get_if<double>(&time);
      table.add({fmt::format("{} {}D", scene, dimension), way.text, count, over(tests_cell(measured), count),
                 time, timed != nullptr && best < 1e9 ? Cell(*timed / best) : Cell()});
    }
  };
  for (const char* const scene : {"uniform", "one_line", "thin", "clustered", "power_law", "towers"})
    add(scene, 2);
  for (const char* const scene : {"uniform", "one_line", "thin", "towers"}) add(scene, 3);
  if (is_there("bunny") && !laboratory.is_quick()) add("bunny", 3);
  return table;
}

Table measure_growth(const Laboratory& laboratory) {
  Table table{.name = "growth",
              .title = "Tests and time of the sweep on uniform boxes, by their number",
              .columns = {{"boxes"}, {"sweep"}, {"tests"}, {"time", "ms"}},
              .charts = {log_log_chart("Time over the number of boxes", "boxes", "time", "sweep")}};
  for (const int dimension : {2, 3}) {
    for (std::size_t boxes = 1'000; boxes <= laboratory.either<std::size_t>(32'000, 8'000); boxes *= 2) {
      const CaseResult result =
          laboratory.measure("sweep_and_prune:axes=1,sweep_and_prune,paper_sweep_and_prune",
                             {.scene = "uniform", .dimension = dimension, .boxes = boxes});
      for (const std::string way : {"sweep_and_prune:axes=1", "sweep_and_prune", "paper_sweep_and_prune"}) {
        const Measurement& measured = measurement_of(result, way);
        table.add({static_cast<double>(boxes), fmt::format("{} {}D", way, dimension), tests_cell(measured),
                   time_cell(measured)});
      }
    }
  }
  return table;
}

std::vector<Table> measure(const Laboratory& laboratory) {
  return {measure_worlds(laboratory), measure_axes(laboratory), measure_growth(laboratory)};
}

/// What costs fewer times than this is taken to cost nothing.
constexpr double much = 2;

/// What a world without bounds costs against the same with bounds: the most of `algorithms`.
struct Cost {
  double tests = 0;
  double memory = 0;
  double time = 0;

  /// Whether it does not grow with the world, which is a thousand times as wide and more.
  bool is_none() const { return tests < much && memory < much && time < much; }
};

Cost cost(const Table& worlds, const std::vector<std::string>& algorithms, bool of_infinite) {
  Cost most;
  for (const std::string& world : worlds.distinct_texts("world")) {
    const Table rows = worlds.where("world", world);
    const std::string bounded = rows.texts("bounded world").at(0);
    if (world == bounded || (world == infinite_world) != of_infinite) continue;
    for (const std::string& algorithm : algorithms) {
      const Table here = rows.where("algorithm", algorithm);
      const Table there = worlds.where("world", bounded).where("algorithm", algorithm);
      // A listing that was skipped for its time has none.
      const auto take = [&](std::string_view column, double& ratio) {
        const std::vector<double> without = here.numbers(column);
        const std::vector<double> with = there.numbers(column);
        if (!without.empty() && !with.empty()) ratio = std::max(ratio, without[0] / with[0]);
      };
      take("tests", most.tests);
      take("memory", most.memory);
      take("time", most.time);
    }
  }
  if (most.time == 0)
    throw std::invalid_argument("table 'worlds' has no world without bounds; expected some");
  return most;
}

/// How the choice of the axis shows in the times, over all scenes.
struct Choice {
  double worst_over_best = 0;
  std::string worst_scene;
  double paper_tests = 0;  // the most a box, of the listing
  std::vector<double> automatic;
  std::vector<double> stripes;
};

Choice choice(const Table& axes) {
  Choice choice;
  for (const std::string& scene : axes.distinct_texts("scene")) {
    const Table rows = axes.where("scene", scene);
    const auto of = [&rows](const std::string& sweep) { return rows.where("sweep", sweep); };
    for (const std::string axis : {"x", "y", "z"}) {
      for (const double ratio : of(axis).numbers("time over best axis's")) {
        if (ratio <= choice.worst_over_best) continue;
        choice.worst_over_best = ratio;
        choice.worst_scene = scene;
      }
    }
    for (const double tests : of(paper).numbers("tests a box"))
      choice.paper_tests = std::max(choice.paper_tests, tests);
    for (const double ratio : of(best_axis).numbers("time over best axis's"))
      choice.automatic.push_back(ratio);
    const std::vector<double> single = of(best_axis).numbers("time");
    const std::vector<double> striped = of(with_stripes).numbers("time");
    if (!single.empty() && !striped.empty()) choice.stripes.push_back(single[0] / striped[0]);
  }
  return choice;
}

Finding judge(const std::vector<Table>& tables) {
  const Table& worlds = table_named(tables, "worlds");
  const Cost far = cost(worlds, sweeps, false);
  const Cost endless = cost(worlds, sweeps, true);
  const Cost others = cost(worlds, bounded_ones, false);
  const Choice axes = choice(table_named(tables, "axes"));
  const Table& growth = table_named(tables, "growth");
  const auto grows = [&growth](const std::string& sweep) {
    return growth_of(growth.where("sweep", sweep).points("boxes", "tests"));
  };
  const double plane = grows("sweep_and_prune:axes=1 2D");
  const double space = grows("sweep_and_prune:axes=1 3D");
  const double stripes = grows("sweep_and_prune 2D");

  Finding finding;
  finding.statements = {
      {.name = "no_bounds",
       .text = "a sweep needs no bounds of the world",
       .verdict = !far.is_none()      ? Verdict::refuted
                  : endless.is_none() ? Verdict::confirmed
                                      : Verdict::within_bounds,
       .condition = far.is_none() && !endless.is_none() ? "no box is infinite" : "",
       .threshold =
           fmt::format("tests, memory and time less than {} times those in a world with bounds", much),
       .evidence = {"tests_without_bounds", "time_without_bounds", "tests_of_infinite_boxes"}},
      {.name = "one_axis",
       .text = "only one axis has been chosen, the x axis",
       .verdict = Verdict::not_testable,
       .condition = "a choice of the draft, which says nothing of its worth; what it costs is measured",
       .evidence = {"worst_axis_over_best"}}};
  finding.reason = fmt::format(
      "Boxes far away, or a world 1,000 times as wide, cost a sweep at most {:.2f} times the tests, {:.2f} "
      "times the memory and {:.2f} times the time; infinite boxes {:.2f} times the tests. The paper's grid "
      "or quadtree take up to {} times the tests. The axis matters more: the worst one takes up to {} times "
      "the best one's time ({}). With one axis tests grow as n^{:.2f} in 2D and n^{:.2f} in 3D; with stripes "
      "of a second one as n^{:.2f} in 2D.",
      far.tests, far.memory, far.time, endless.tests, rounded(others.tests), rounded(axes.worst_over_best),
      axes.worst_scene, plane, space, stripes);
  finding.figures = {{"tests_without_bounds", far.tests},
                     {"memory_without_bounds", far.memory},
                     {"time_without_bounds", far.time},
                     {"tests_of_infinite_boxes", endless.tests},
                     {"time_of_infinite_boxes", endless.time},
                     {"tests_without_bounds_of_grid_or_quadtree", others.tests},
                     {"time_without_bounds_of_grid_or_quadtree", others.time},
                     {"worst_axis_over_best", axes.worst_over_best},
                     {"most_tests_of_paper", axes.paper_tests, "tests a box"},
                     {"automatic_axis_over_best", geometric_mean(axes.automatic)},
                     {"worst_automatic_axis_over_best", std::ranges::max(axes.automatic)},
                     {"gain_of_stripes", geometric_mean(axes.stripes)},
                     {"growth_in_2d", plane},
                     {"growth_in_3d", space},
                     {"growth_with_stripes_in_2d", stripes}};
  return finding;
}

}  // namespace

Experiment sweep_axis() {
  return {.number = 6,
          .name = "sweep_axis",
          .title = "Sweep and prune needs no world, but an axis",
          .claim =
              "Sweep and Prune builds its collection based on the an objects bound itself. Thus there is no "
              "spatial bound on the world required when using Sweep and Prune. ... In this case ... only 1 "
              "axis has been chosen, the x axis.",
          .section = "IV",
          .measured =
              "Tests, time and memory where boxes are far away or infinite against the same world with "
              "bounds; the sweep along each axis, the one it chooses, and the paper's, on each scene.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

// Section V: a quadtree trades tests for references, which slow it down in dense worlds; larger leaves help.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

const std::string listing = "paper_quadtree";
const std::string own = "quadtree";

/// The capacity that the listing has where none is given, and the one of this experiment's judgement.
constexpr double usual_capacity = 8;

/// The own quadtree's standard in 2D.
constexpr double own_capacity = 128;

/// Up to this times the best time, a capacity is as good.
constexpr double as_good = 1.1;

/// Above this, a time is not only a disturbed one.
constexpr double notable = 1.25;

Table measure_capacities(const Laboratory& laboratory, const std::string& algorithm, std::size_t least,
                         std::size_t most) {
  Table table{.name = algorithm == listing ? "paper" : "own",
              .title = fmt::format("{} on uniform boxes in 2D, by density and capacity", algorithm),
              .columns = {{"density"},
                          {"neighbours"},
                          {"capacity"},
                          {"boxes"},
                          {"tests a box"},
                          {"references a box"},
                          {"time", "ms"}},
              .charts = {log_log_chart(fmt::format("Time of {} over the capacity of a leaf", algorithm),
                                       "capacity", "time over best", "density"),
                         log_log_chart(fmt::format("References of {} over the capacity of a leaf", algorithm),
                                       "capacity", "references a box", "density")}};
  append(table.columns, ratio_columns("time over best"));
  const auto boxes = laboratory.either<std::size_t>(10'000, 3'000);
  for (const double neighbours : {1.0, 4.0, 16.0, 64.0, 256.0}) {
    std::vector<std::string> specs;
    for (std::size_t capacity = least; capacity <= most; capacity *= 2)
      specs.push_back(fmt::format("{}:capacity={}", algorithm, capacity));
    const CaseResult result = laboratory.measure(
        list_of(specs), {.scene = fmt::format("uniform:neighbours={}", neighbours), .boxes = boxes});
    const auto count = static_cast<double>(boxes);
    const Measurement& best = std::ranges::min(result.measurements, {}, [](const Measurement& measured) {
      return measured.samples_ms.empty() ? INFINITY : median(measured.samples_ms);
    });
    std::size_t capacity = least;
    for (const Measurement& measured : result.measurements) {
      std::vector<Cell> row = {fmt::format("{} neighbours", neighbours),
                               neighbours,
                               static_cast<double>(capacity),
                               count,
                               over(tests_cell(measured), count),
                               over(references_cell(measured), count),
                               time_cell(measured)};
      append(row, ratio_cells(result, measured, best));
      table.add(std::move(row));
      capacity *= 2;
    }
  }
  return table;
}

std::vector<Table> measure(const Laboratory& laboratory) {
  return {measure_capacities(laboratory, listing, 2, laboratory.either<std::size_t>(1'024, 512)),
          measure_capacities(laboratory, own, 8, laboratory.either<std::size_t>(2'048, 1'024))};
}

/// What a table says at one density.
struct Density {
  double neighbours = 0;
  double best_capacity = 0;  // the smallest that is as good as the best
  double best_references = 0;
  double usual_references = 0;  // of the usual capacity, likewise below
  double usual_tests = 0;
  double fewest_tests = 0;
  RatioAt penalty{};  // time of the usual capacity over the best time
};

std::vector<Density> densities(const Table& table, double usual) {
  std::vector<Density> all;
  for (const double neighbours : table.distinct_numbers("neighbours")) {
    const Table rows = table.where("neighbours", neighbours);
    const std::vector<RatioAt> times = ratios_over(rows, "capacity", "time over best");
    const auto best = std::ranges::find_if(times, [](const RatioAt& at) { return at.ratio <= as_good; });
    const auto at = std::ranges::find(times, usual, &RatioAt::x);
    if (times.size() < 3 || best == times.end() || at == times.end()) {
      throw std::invalid_argument(fmt::format(
          "table '{}': {} times at {} neighbours; expected 3 or more, one of them the best and one "
          "of a capacity of {}",
          table.name, times.size(), neighbours, usual));
    }
    const Table at_best = rows.where("capacity", best->x);
    const Table at_usual = rows.where("capacity", usual);
    all.push_back({.neighbours = neighbours,
                   .best_capacity = best->x,
                   .best_references = at_best.number("references a box"),
                   .usual_references = at_usual.number("references a box"),
                   .usual_tests = at_usual.number("tests a box"),
                   .fewest_tests = std::ranges::min(rows.numbers("tests a box")),
                   .penalty = *at});
  }
  if (all.size() < 2)
    throw std::invalid_argument(
        fmt::format("table '{}': {} densities; expected 2 or more", table.name, all.size()));
  return all;
}

Finding judge(const std::vector<Table>& tables) {
  const Table& paper = table_named(tables, "paper");
  const std::vector<Density> listed = densities(paper, usual_capacity);
  const std::vector<Density> owned = densities(table_named(tables, "own"), own_capacity);

  // A world is dense where a box has so many times the references that it has in the sparsest one.
  constexpr double dense_times = 2;
  std::size_t dense = 0;
  std::size_t slowed_dense = 0;
  std::vector<double> slowed;
  const Density& worst =
      std::ranges::max(listed, {}, [](const Density& density) { return density.penalty.ratio; });
  for (const Density& density : listed) {
    const bool is_alleviated =
        density.best_capacity > usual_capacity && density.best_references < density.usual_references;
    const bool is_slowed = density.penalty.ratio >= notable && is_alleviated;
    if (is_slowed) slowed.push_back(density.neighbours);
    if (density.usual_references < dense_times * listed.front().usual_references) continue;
    ++dense;
    slowed_dense += is_slowed ? 1 : 0;
  }
  double own_worst = 0;
  for (const Density& density : owned) own_worst = std::max(own_worst, density.penalty.ratio);

  Finding finding;
  Statement larger{
      .name = "larger_leaves",
      .text = "these slow it down, and larger leaves alleviate that",
      .verdict = slowed_dense == 0       ? Verdict::refuted
                 : slowed_dense == dense ? Verdict::confirmed
                                         : Verdict::within_bounds,
      .threshold = fmt::format("in dense worlds leaves of {} take {} times the time of the best, "
                               "or more, and the best are larger and have fewer references",
                               usual_capacity, notable),
      .evidence = {"worst_time_over_best", "time_over_best_in_densest"}};
  if (larger.verdict == Verdict::within_bounds) {
    larger.condition =
        fmt::format("a box overlaps from {} to {} others; beyond, the pairs themselves take the time",
                    slowed.front(), slowed.back());
  }
  finding.statements = {
      {.name = "references",
       .text = "in a dense world a box has references in numerous nodes",
       .verdict = dense > 0 ? Verdict::confirmed : Verdict::refuted,
       .threshold = fmt::format("{} times the references of the sparsest world, or more", dense_times),
       .evidence = {"references_in_sparsest", "references_in_densest"}},
      larger};
  const Density& sparsest = listed.front();
  const Density& densest = listed.back();
  constexpr double margin = 100 * (as_good - 1);
  finding.reason = fmt::format(
      "Leaves of {} take the listing up to {:.2f} times the time of the best ones (at {} neighbours). From "
      "{} to {} neighbours a box's references in them grow from {:.1f} to {:.1f}, where our mending ends the "
      "splitting, and the smallest leaf within {:.0f} % of the best time from {} to {} boxes. In the densest "
      "world they take {} tests a box where {} would do{}. The own quadtree takes up to {:.2f} times its "
      "best time in leaves of {}; in the "
      "sparsest world the smallest leaf within {:.0f} % of it holds {}.",
      usual_capacity, worst.penalty.ratio, worst.neighbours, sparsest.neighbours, densest.neighbours,
      sparsest.usual_references, densest.usual_references, margin, sparsest.best_capacity,
      densest.best_capacity, rounded(densest.usual_tests), rounded(densest.fewest_tests),
      densest.usual_tests > 1.05 * densest.fewest_tests ? ", since a pair meets in many leaves" : "",
      own_worst, own_capacity, margin, owned.front().best_capacity);
  finding.figures = {{"worst_time_over_best", worst.penalty.ratio, "", worst.penalty.interval},
                     {"worst_at", worst.neighbours, "neighbours"},
                     {"references_in_sparsest", sparsest.usual_references, "references a box"},
                     {"references_in_densest", densest.usual_references, "references a box"},
                     {"references_of_best_in_densest", densest.best_references, "references a box"},
                     {"best_capacity_in_sparsest", sparsest.best_capacity, "boxes"},
                     {"best_capacity_in_densest", densest.best_capacity, "boxes"},
                     {"tests_in_densest", densest.usual_tests, "tests a box"},
                     {"fewest_tests_in_densest", densest.fewest_tests, "tests a box"},
                     {"time_over_best_in_densest", densest.penalty.ratio, "", densest.penalty.interval},
                     {"own_best_capacity_in_sparsest", owned.front().best_capacity, "boxes"},
                     {"own_best_capacity_in_densest", owned.back().best_capacity, "boxes"},
                     {"own_worst_standard_over_best", own_worst},
                     {"most_neighbours_slowed", slowed.empty() ? 0 : slowed.back(), "neighbours"}};
  return finding;
}

}  // namespace

Experiment quadtree_capacity() {
  return {.number = 8,
          .name = "quadtree_capacity",
          .title = "Larger leaves for denser worlds",
          .claim =
              "Although the number of pairwise collision tests a[re] lower, the amount of references "
              "belonging to a single object spans across numerous nodes, and the operations required to do "
              "that can slow the algorithm down. This would occur when there is an extremely large amount of "
              "elements for a relatively small world. This can be alleviated by setting a larger ... amount "
              "[of] elements allowed to be in a node.",
          .section = "V",
          .measured =
              "Tests, references and time of the listing and of the own quadtree over the capacity of a "
              "leaf, on uniform boxes that overlap 1 to 256 others, 2D.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

// Section III: with cells much smaller than boxes, a grid's time goes into adding boxes to cells.
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/grid_adding.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

std::vector<Table> measure(const Laboratory& laboratory) {
  Table grids{
      .name = "grids",
      .title = "What small cells cost 2,000 boxes (the mended grid takes no more than 65,536: erratum 2c)",
      .columns = {{"cells across a box"}, {"grid"}, {"references a box"}, {"tests a box"}, {"time", "ms"}},
      .charts = {log_log_chart("Time over the cells across a box", "cells across a box", "time", "grid")}};
  for (double across = 0.25; across <= 8; across *= 2) {
    const std::string cell = fmt::format(":cell={}", 1 / across);
    const CaseResult result =
        laboratory.measure("paper_grid" + cell + ",grid" + cell, {.scene = "uniform", .boxes = 2'000});
    for (const std::string grid : {"paper_grid", "grid"}) {
      const Measurement& measured = measurement_of(result, grid + cell);
      grids.add({across, grid, over(references_cell(measured), 2'000), over(tests_cell(measured), 2'000),
                 time_cell(measured)});
    }
  }
  return {measure_adding(laboratory), grids};
}

/// Of each density: the row of the smallest cells.
Table of_smallest_cells(const Table& shares) {
  Table smallest = shares;
  smallest.rows.clear();
  for (const std::string& scene : shares.distinct_texts("scene")) {
    const Table rows = shares.where("scene", scene);
    const std::vector<double> across = rows.numbers("cells across a box");
    if (across.empty()) continue;
    const Table last = rows.where("cells across a box", *std::ranges::max_element(across));
    smallest.rows.push_back(last.rows.back());
  }
  if (smallest.rows.size() < 2)
    throw std::invalid_argument(
        fmt::format("table 'shares' is of {} scenes; expected two at least", smallest.rows.size()));
  return smallest;
}

/// Below how many neighbours adding takes most of the time: nothing if it does for the most neighbours there
/// are, 0 if it does for none.
std::optional<double> limit_of(const Table& smallest, const std::string& share) {
  auto adding = smallest.points("neighbours", share);
  auto half = adding;
  for (auto& [neighbours, percent] : half) percent = 50;
  for (auto& [neighbours, percent] : adding) percent = std::max(percent, 0.01);
  const auto below = crossover(adding, half);
  return below && *below <= adding.front().first ? 0 : below;
}

std::vector<std::pair<double, double>> last_three(std::vector<std::pair<double, double>> points) {
  if (points.size() < 3)
    throw std::invalid_argument(
        fmt::format("table 'shares' has {} rows with 4 neighbours; expected three at least", points.size()));
  return {points.end() - 3, points.end()};
}

double time_of(const Table& grids, const std::string& grid) {
  const std::vector<double> times = grids.where("grid", grid).numbers("time");
  if (times.empty()) throw std::invalid_argument("table 'grids' has no time of " + grid + "; expected one");
  return times.front();
}

std::string shares_text(const Table& smallest, const std::string& share) {
  std::vector<std::string> parts;
  for (const auto& [neighbours, percent] : smallest.points("neighbours", share))
    parts.push_back(fmt::format("{:.0f} % with {:.0f}", percent, neighbours));
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// References over width times height: up to the first they are as many, up to the second nearly.
constexpr double exactly = 1.02;
constexpr double nearly = 1.25;

Finding judge(const std::vector<Table>& tables) {
  const Table& shares = table_named(tables, "shares");
  const Table smallest = of_smallest_cells(shares);
  const std::optional<double> kept = limit_of(smallest, "adding");
  const std::optional<double> fresh = limit_of(smallest, "adding to new cells");

  Statement adding{.name = "adding",
                   .text = "then most of the time is spent in adding references",
                   .threshold = "adding takes more than half of the time"};
  for (const double neighbours : smallest.numbers("neighbours"))
    append(adding.evidence, {fmt::format("adding_with_{:.0f}_neighbours", neighbours),
                             fmt::format("adding_to_new_cells_with_{:.0f}_neighbours", neighbours)});
  const auto fewer = [](const std::optional<double>& limit) {
    return limit ? fmt::format("a box touches fewer than about {} others", rounded(*limit)) : std::string();
  };
  if (!kept) {
    adding.verdict = Verdict::confirmed;
  } else if (*kept > 0) {
    adding.verdict = Verdict::within_bounds;
    adding.condition = fewer(kept);
  } else if (!fresh || *fresh > 0) {
    adding.verdict = Verdict::within_bounds;
    adding.condition = "each search makes its cells anew" + (fresh ? ", and " + fewer(fresh) : "");
  }

  // How both grow where boxes have as many neighbours as in the standard scene.
  const Table middle = shares.where("neighbours", 4.0);
  const double references = growth_of(last_three(middle.points("cells across a box", "references a box")));
  const double tests = growth_of(last_three(middle.points("cells across a box", "tests a box")));
  const auto [longest, of_longest] = middle.points("cells across a box", "references a box").back();
  const double over_product = of_longest / (longest * longest);

  Finding finding;
  Statement slots{
      .name = "slots",
      .text = "a box has a reference in its width times its height of cells",
      .threshold = fmt::format("at most {} times as many; up to {} times within bounds", exactly, nearly),
      .evidence = {"references_over_product"}};
  if (over_product < exactly) {
    slots.verdict = Verdict::confirmed;
  } else if (over_product < nearly) {
    slots.verdict = Verdict::within_bounds;
    slots.condition = fmt::format(
        "boxes are much longer than cells; {} cells long they are in {:.2f} times as many "
        "(erratum T3)",
        rounded(longest), over_product);
  }
  finding.statements = {slots, adding};
  finding.reason = fmt::format(
      "With boxes up to {:.0f} cells long, adding takes {} neighbours a box; where the cells' memory is made "
      "anew for each search, {}. For references grow with the length in cells to the power {:.2f}, as is "
      "said, but tests do so to the power {:.2f}: two boxes are tested in every cell that they share.",
      std::ranges::max(smallest.numbers("cells across a box")), shares_text(smallest, "adding"),
      shares_text(smallest, "adding to new cells"), references, tests);
  for (const std::vector<Cell>& row : smallest.rows) {
    const auto number = [&](std::string_view column) {
      return std::get<double>(row[smallest.column(column)]);
    };
    const std::string with = fmt::format("_with_{:.0f}_neighbours", number("neighbours"));
    finding.figures.push_back({"adding" + with, number("adding"), "%"});
    finding.figures.push_back({"adding_to_new_cells" + with, number("adding to new cells"), "%"});
  }
  finding.figures.push_back({"references_growth", references});
  finding.figures.push_back({"tests_growth", tests});
  finding.figures.push_back({"references_over_product", over_product});
  finding.figures.push_back(
      {"most_references_a_box", std::ranges::max(smallest.numbers("references a box"))});
  if (kept) finding.figures.push_back({"neighbours_below", *kept});
  if (fresh) finding.figures.push_back({"neighbours_below_with_new_cells", *fresh});
  // Four cells across a box are the most that the mended grid has for these many boxes.
  const Table four = table_named(tables, "grids").where("cells across a box", 4.0);
  const Table one = table_named(tables, "grids").where("cells across a box", 1.0);
  for (const std::string grid : {"paper_grid", "grid"}) {
    const double dear = time_of(four, grid);
    finding.figures.push_back({grid + "_time_with_4_cells_across", dear, "ms"});
    finding.figures.push_back({grid + "_time_over_1_cell_across", dear / time_of(one, grid)});
  }
  return finding;
}

}  // namespace

Experiment grid_spanning() {
  return {.number = 4,
          .name = "grid_spanning",
          .title = "Small cells and large boxes: the time goes into adding",
          .claim =
              "If we consider a grid size of a unit size of 1, and objects consisting of a height and width "
              "a large multiple of the unit size, then ... we must place a reference of the objects into its "
              "width times its height number of grid slots. If this is done over hundreds of objects, then "
              "most of computational time will be spent in the adding the element's spanning section.",
          .section = "III",
          .measured =
              "The time of the paper's grid up to its first pair, which lies in the first cell, less that of "
              "the same cells with nothing in them: in searches that keep the cells' memory, and in such "
              "that make it anew. 200 boxes of about 1 x 1 with 1 to 64 neighbours each.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

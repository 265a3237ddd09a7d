// Section III: with cells much smaller than boxes, a grid's time goes into adding boxes to cells.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "broadside/algorithm.hpp"

#include "lab/experiments/descriptions.hpp"
#include "lab/experiments/growth.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/scenes/scene.hpp"
#include "lab/verify.hpp"

namespace broadside::lab {
namespace {

/// "Hundreds of objects": so few that the mended grid may have cells as small as are asked for. It would take
/// larger ones beyond this many cells (erratum 2c) or references (erratum 3i).
constexpr std::size_t few_boxes = 200;
constexpr double most_cells = 1 << 16;
constexpr double most_references = 1 << 18;

/// Collects pairs, and notes when the first is written: it comes with its buffer full of what is no pair.
class FirstPairClock final : public PairSink {
 public:
  FirstPairClock() {
    for (std::size_t half = 0; half < 2; ++half) {
      std::fill_n(room(max_room), max_room, Pair{BoxId(0), BoxId(1)});
      commit(max_room);
    }
    pairs_.reserve(few_boxes * (few_boxes - 1) / 2);
    watch_ = {};
  }

  double first_ms() const { return first_ms_; }
  double all_ms() const { return watch_.milliseconds(); }
  const std::vector<Pair>& pairs() const { return pairs_; }

 private:
  void consume(std::span<const Pair> pairs) override {
    if (first_ms_ > 0)
      pairs_.insert(pairs_.end(), pairs.begin(), pairs.end());
    else
      first_ms_ = watch_.milliseconds();
  }

  std::vector<Pair> pairs_;
  double first_ms_ = 0;
  Stopwatch watch_;
};

/// What a search takes up to its first pair, which is in the first cell, and in all.
struct Times {
  std::vector<double> first_ms{};
  std::vector<double> all_ms{};

  void sample(PairFinder<2>& finder, std::span<const Box2> boxes, std::span<const Pair> expected) {
    FirstPairClock clock;
    finder.find(boxes, clock);
    all_ms.push_back(clock.all_ms());
    first_ms.push_back(clock.first_ms());
    if (const auto divergence = compare_pairs(clock.pairs(), expected))
      throw std::runtime_error("paper_grid: " + divergence->text);
  }
};

/// Boxes of about 1 x 1 and the world that they are in; the first two fill its corner.
struct World {
  std::vector<Box2> boxes;
  std::array<float, 2> low{};
  std::array<float, 2> extent{};

  World(const std::string& scene, std::uint64_t seed) {
    const NamedScene named = find_scene(scene);
    boxes = make_history<2>(named.scene, named.spec, {.boxes = few_boxes, .seed = seed}).boxes;
    Box2 bounds = boxes[0];
    for (const Box2& box : boxes) {
      for (int axis = 0; axis < 2; ++axis) {
        bounds.min[axis] = std::min(bounds.min[axis], box.min[axis]);
        bounds.max[axis] = std::max(bounds.max[axis], box.max[axis]);
      }
    }
    for (int axis = 0; axis < 2; ++axis) {
      low[axis] = bounds.min[axis];
      extent[axis] = bounds.max[axis] - bounds.min[axis];
    }
    boxes[0] = boxes[1] = {low, {low[0] + 1, low[1] + 1}};
  }

  std::unique_ptr<PairFinder<2>> make_grid(double cell) const {
    return make_finder<2>(fmt::format("paper_grid:cell={}:left={}:top={}:width={}:height={}", cell, low[0],
                                      low[1], extent[0], extent[1]));
  }

  double cells(double cell) const {
    return std::ceil(double{extent[0]} / cell) * std::ceil(double{extent[1]} / cell);
  }

  /// About as many as there will be.
  double references(double cell) const {
    double sum = 0;
    for (const Box2& box : boxes)
      sum += (1 + (box.max[0] - box.min[0]) / cell) * (1 + (box.max[1] - box.min[1]) / cell);
    return sum;
  }
};

/// A row of shares: where the time of the paper's grid goes. False if its cells would not be as asked.
bool measure_shares(const Laboratory& laboratory, double neighbours, double across, Table& table) {
  const std::string scene = fmt::format("uniform:neighbours={}", neighbours);
  const double cell = 1 / across;
  laboratory.at(fmt::format("paper_grid:cell={} on {}", cell, scene));
  std::vector<World> worlds;
  std::vector<std::vector<Pair>> expected;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    worlds.emplace_back(scene, seed);
    expected.push_back(reference_pairs<2>(worlds.back().boxes));
    if (worlds.back().cells(cell) > most_cells || worlds.back().references(cell) > 0.9 * most_references)
      return false;
  }
  Times kept;        // cells that have grown in earlier searches
  Times fresh;       // new ones
  Times kept_alone;  // likewise, with nothing but two points in the first cell
  Times fresh_alone;
  std::vector<std::unique_ptr<PairFinder<2>>> grids;
  for (const World& world : worlds) grids.push_back(world.make_grid(cell));
  const std::vector<Pair> pair = {{BoxId(0), BoxId(1)}};
  std::array<Statistics, 4> statistics;
  const Stopwatch watch;
  for (std::size_t round = 0;
       round < 12 || (round < 400 && watch.milliseconds() < laboratory.either(600, 100)); ++round) {
    const std::size_t i = round % worlds.size();
    kept.sample(*grids[i], worlds[i].boxes, expected[i]);
    statistics[i] = *grids[i]->statistics();
    const std::vector<Box2> points(2, Box2{worlds[i].low, worlds[i].low});
    kept_alone.sample(*grids[i], points, pair);
    fresh.sample(*worlds[i].make_grid(cell), worlds[i].boxes, expected[i]);
    fresh_alone.sample(*worlds[i].make_grid(cell), points, pair);
  }
  double references = 0;
  double tests = 0;
  for (const Statistics& one : statistics) {
    references += static_cast<double>(one.references) / few_boxes / statistics.size();
    tests += static_cast<double>(one.tests) / few_boxes / statistics.size();
  }
  const double all = median(kept.all_ms);
  const double cells_alone = median(kept_alone.first_ms);
  const double adding = std::max(0.0, median(kept.first_ms) - cells_alone);
  const double adding_fresh = std::max(0.0, median(fresh.first_ms) - median(fresh_alone.first_ms));
  table.add({scene, neighbours, across, references, tests, all, cells_alone, adding,
             all - median(kept.first_ms), adding / all * 100, adding_fresh / median(fresh.all_ms) * 100});
  return true;
}

std::vector<Table> measure(const Laboratory& laboratory) {
  const Chart chart{.title = "Share of the time that goes into adding, where cells are kept",
                    .x = "cells across a box",
                    .y = "adding",
                    .series = "scene",
                    .log_x = true};
  Chart chart_of_new = chart;
  chart_of_new.title = "Share of the time that goes into adding, where cells are made anew";
  chart_of_new.y = "adding to new cells";
  Table shares{.name = "shares",
               .title = "Where the time of the paper's grid goes, with 200 boxes",
               .columns = {{"scene"},
                           {"neighbours"},
                           {"cells across a box"},
                           {"references a box"},
                           {"tests a box"},
                           {"time", "ms"},
                           {"time of empty cells", "ms"},
                           {"time of adding", "ms"},
                           {"time of testing", "ms"},
                           {"adding", "%"},
                           {"adding to new cells", "%"}},
               .charts = {chart, chart_of_new}};
  for (const double neighbours : {1, 4, 16, 64}) {
    for (double across = 0.5; measure_shares(laboratory, neighbours, across, shares); across *= 2) {
    }
  }
  Table grids{
      .name = "grids",
      .title = "What small cells cost 2,000 boxes (the mended grid takes no more than 65,536: erratum 2c)",
      .columns = {{"cells across a box"}, {"grid"}, {"references a box"}, {"tests a box"}, {"time", "ms"}},
      .charts = {{.title = "Time over the cells across a box",
                  .x = "cells across a box",
                  .y = "time",
                  .series = "grid",
                  .log_x = true,
                  .log_y = true}}};
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
  return {shares, grids};
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

Finding judge(const std::vector<Table>& tables) {
  const Table& shares = table_named(tables, "shares");
  const Table smallest = of_smallest_cells(shares);
  const std::optional<double> kept = limit_of(smallest, "adding");
  const std::optional<double> fresh = limit_of(smallest, "adding to new cells");

  Finding finding;
  const auto fewer = [](const std::optional<double>& limit) {
    return limit ? fmt::format("a box touches fewer than about {} others", rounded(*limit)) : std::string();
  };
  if (!kept) {
    finding.verdict = Verdict::holds;
  } else if (*kept > 0) {
    finding.verdict = Verdict::holds_when;
    finding.condition = fewer(kept);
  } else if (!fresh || *fresh > 0) {
    finding.verdict = Verdict::holds_when;
    finding.condition = "each search makes its cells anew" + (fresh ? ", and " + fewer(fresh) : "");
  }

  // How both grow where boxes have as many neighbours as in the standard scene.
  const Table middle = shares.where("neighbours", 4.0);
  const double references = growth_of(last_three(middle.points("cells across a box", "references a box")));
  const double tests = growth_of(last_three(middle.points("cells across a box", "tests a box")));
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
  return {
      .number = 4,
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
          "the same cells with nothing in them: in searches that keep the cells' memory, and in such that "
          "make it anew. 200 boxes of about 1 x 1 with 1 to 64 neighbours each.",
      .measure = measure,
      .judge = judge};
}

}  // namespace broadside::lab

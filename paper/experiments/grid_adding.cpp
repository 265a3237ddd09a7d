// Where the time of the paper's grid goes: a clock stops at its first pair, with all boxes and with two only.
#include "paper/experiments/grid_adding.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "broadside/algorithm.hpp"

#include "lab/measure/samples.hpp"
#include "lab/verify/verify.hpp"
#include "paper/experiments/laboratory.hpp"

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
  Statistics statistics{};  ///< of the last search

  void sample(Finder<2>& finder, std::span<const Box2> boxes, std::span<const Pair> expected) {
    FirstPairClock clock;
    statistics = finder.find(boxes, clock).value();
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
    boxes = history_of<2>(scene, {.boxes = few_boxes, .seed = seed}).boxes;
    const Box2 bounds = bounds_of<2>(boxes);
    low = bounds.min;
    for (int axis = 0; axis < 2; ++axis) extent[axis] = bounds.max[axis] - bounds.min[axis];
    boxes[0] = boxes[1] = {low, {low[0] + 1, low[1] + 1}};
  }

  Finder<2> make_grid(double cell) const {
    return Finder<2>(fmt::format("paper_grid:cell={}:left={}:top={}:width={}:height={}", cell, low[0], low[1],
                                 extent[0], extent[1]));
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
  std::vector<Finder<2>> grids;
  for (const World& world : worlds) grids.push_back(world.make_grid(cell));
  const std::vector<Pair> pair = {{BoxId(0), BoxId(1)}};
  std::array<Statistics, 4> statistics;
  const Stopwatch watch;
  for (std::size_t round = 0;
       round < 12 || (round < 400 && watch.milliseconds() < laboratory.either(600, 100)); ++round) {
    const std::size_t i = round % worlds.size();
    kept.sample(grids[i], worlds[i].boxes, expected[i]);
    statistics[i] = kept.statistics;
    const std::vector<Box2> points(2, Box2{worlds[i].low, worlds[i].low});
    kept_alone.sample(grids[i], points, pair);
    Finder<2> new_grid = worlds[i].make_grid(cell);
    fresh.sample(new_grid, worlds[i].boxes, expected[i]);
    new_grid = worlds[i].make_grid(cell);
    fresh_alone.sample(new_grid, points, pair);
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

}  // namespace

Table measure_adding(const Laboratory& laboratory) {
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
  return shares;
}

}  // namespace broadside::lab

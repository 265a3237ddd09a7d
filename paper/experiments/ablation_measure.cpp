// The library's two fastest searches, held back and written plainly, in turns with each other.
#include "paper/experiments/ablation_measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "broadside/executor.hpp"

#include "lab/measure/paired_ratio.hpp"
#include "lab/numbers.hpp"
#include "paper/plain/plain.hpp"

namespace broadside::lab {
namespace {

/// A way to search, by its spec and by what it is called in the tables.
struct Way {
  std::string text;
  std::string spec;
};

/// A plain search's switches, each of which is left out alone.
struct Switch {
  std::string tunable;
  std::string without;  ///< what the search is called without it
};

const std::string all_at_once = "as the library has it";

std::vector<Way> ways(const std::string& own, const std::vector<Switch>& switches, const std::string& peer) {
  std::vector<Way> all = {{all_at_once, own}};
  for (const std::string& set : instruction_sets()) {
    if (set != instruction_set())
      all.push_back({"by " + set, fmt::format("held_back:search={}:simd={}", own, set)});
  }
  const std::string name = "plain_" + own;
  all.push_back({ablation_plain, name});
  std::string together = name;
  for (const Switch& left_out : switches) {
    all.push_back({ablation_but + left_out.without, fmt::format("{}:{}=no", name, left_out.tunable)});
    together += fmt::format(":{}=no", left_out.tunable);
  }
  all.push_back({ablation_nothing, together});
  if (!peer.empty()) all.push_back({peer, peer});
  return all;
}

std::vector<Way> ways_of_grid(const std::string& peer) {
  return ways("grid",
              {{"arrays", "an array of boxes"},
               {"branch_free", "a branch at each test"},
               {"buckets", "std::sort in each cell"},
               {"carry", "a copy in each cell"},
               {"sample", "no sample"}},
              peer);
}

std::vector<Way> ways_of_bvh(const std::string& peer) {
  return ways("bvh",
              {{"arrays", "an array of boxes"},
               {"branch_free", "a branch at each test"},
               {"buckets", "std::sort to pack"},
               {"join", "a query for each box"}},
              peer);
}

/// What the column of a dimension's times is called.
std::string time_in(int dimension) { return fmt::format("{}D", dimension); }

/// The logarithm of a ratio of two times over that of another one, in the rounds that all took part in.
/// Both ratios are drawn from the same seeds and rounds, so that what slowed a round counts once.
std::vector<Cell> share_cells(const CaseResult& result, const std::array<const Measurement*, 2>& part,
                              const std::array<const Measurement*, 2>& whole) {
  std::vector<std::vector<double>> times;
  std::size_t rounds = SIZE_MAX;
  for (const Measurement* const measurement : {part[0], part[1], whole[0], whole[1]}) {
    if (measurement->samples_ms.empty()) return {Cell(), Cell(), Cell()};
    times.push_back(round_times(*measurement));
    rounds = std::min(rounds, times.back().size());
  }
  for (std::vector<double>& some : times) some.resize(rounds);
  const RatiosBySeed of_part(times[0], times[1], result.of.seeds.size());
  const RatiosBySeed of_whole(times[2], times[3], result.of.seeds.size());
  if (!(of_whole.median() > 1)) return {Cell(), Cell(), Cell()};
  const double share = std::log(of_part.median()) / std::log(of_whole.median());
  if (!of_whole.interval()) return {share, Cell(), Cell()};
  constexpr std::size_t draws = 1'000;
  const std::vector<double> parts = of_part.replicates(draws, 1);
  const std::vector<double> wholes = of_whole.replicates(draws, 1);
  std::vector<double> shares;
  for (std::size_t i = 0; i < draws; ++i) {
    if (wholes[i] > 1) shares.push_back(std::log(parts[i]) / std::log(wholes[i]));
  }
  const Interval interval = middle_of(shares);
  return {share, interval.low, interval.high};
}

/// A quiet interval takes more rounds than most experiments have.
Effort effort_of(const Laboratory& laboratory) {
  Effort effort = laboratory.effort();
  if (laboratory.is_quick()) return effort;
  effort.share_seconds = 0.4;
  effort.least_rounds = 12;
  return effort;
}

Table measure_search(const Laboratory& laboratory, const Catalogue& catalogue, const std::string& own,
                     const std::string& scene, const std::vector<Way>& ways, Table& shares) {
  const auto boxes = laboratory.either<std::size_t>(100'000, 20'000);
  Table table{
      .name = ablation_table(own, scene),
      .title = fmt::format("{}, held back or written plainly: {} {} boxes", own, grouped(boxes), scene),
      .columns = {{"search"}}};
  std::vector<std::string> specs;
  std::vector<std::vector<Cell>> rows;
  std::string without_simd;
  std::string without_all;
  for (const Way& way : ways) {
    specs.push_back(way.spec);
    rows.push_back({way.text});
    if (way.text.starts_with("by ")) without_simd = way.spec;
    if (way.text == ablation_nothing) without_all = way.spec;
  }
  for (const int dimension : {2, 3}) {
    table.columns.push_back({time_in(dimension), "ms"});
    append(table.columns, ratio_columns(ablation_ratio(dimension)));
    table.charts.push_back(
        {.title = fmt::format("Time over that of {} in {}D: {} boxes", own, dimension, scene),
         .kind = ChartKind::bars,
         .x = "search",
         .y = ablation_ratio(dimension),
         .log_y = true});
    const CaseResult result =
        laboratory.measure(catalogue, list_of(specs),
                           {.scene = scene, .dimension = dimension, .boxes = boxes}, effort_of(laboratory));
    const Measurement& library = measurement_of(result, own);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const Measurement& measurement = measurement_of(result, specs[i]);
      rows[i].push_back(time_cell(measurement));
      append(rows[i], ratio_cells(result, measurement, library));
    }
    if (without_simd.empty()) continue;  // there is one instruction set only
    const Measurement& scalar = measurement_of(result, without_simd);
    const Measurement& none = measurement_of(result, without_all);
    std::vector<Cell> row = {own, scene, fmt::format("{}D", dimension)};
    append(row, share_cells(result, {&scalar, &library}, {&none, &library}));
    append(row, share_cells(result, {&none, &measurement_of(result, "plain_" + own)}, {&none, &library}));
    for (const Measurement* const other : {&scalar, &none}) {
      const bool has_peer = ways.back().text == ways.back().spec;
      append(row, has_peer ? ratio_cells(result, measurement_of(result, specs.back()), *other)
                           : std::vector<Cell>(3));
    }
    shares.add(std::move(row));
  }
  for (std::vector<Cell>& row : rows) table.add(std::move(row));
  return table;
}

}  // namespace

std::string ablation_table(const std::string& own, const std::string& scene) {
  return scene == ablation_scenes[0] ? own : fmt::format("{}_{}", own, scene);
}

std::string ablation_ratio(int dimension) { return fmt::format("{}D ratio", dimension); }

Table table_of_shares() {
  Table table{.name = "shares",
              .title =
                  "What SIMD gains, and what the other things do that can be left out, as shares of the "
                  "whole gain by logarithms; what is left is by writing the search once more",
              .columns = {{"search"}, {"scene"}, {"dimension"}}};
  for (const std::string& name : {simd_share, rest_share, peer_over_without_simd, peer_over_without_all})
    append(table.columns, ratio_columns(name));
  return table;
}

std::vector<Table> measure_ablation(const Laboratory& laboratory) {
  Catalogue catalogue;
  for (Algorithm& algorithm : plain::algorithms()) catalogue.add(std::move(algorithm));
  const bool has_peer = find_algorithm(ablation_peer, catalogue.algorithms()) != nullptr;
  const std::string peer = has_peer ? ablation_peer : "";
  Table shares = table_of_shares();
  std::vector<Table> tables;
  for (const std::string& scene : ablation_scenes) {
    tables.push_back(measure_search(laboratory, catalogue, "grid", scene, ways_of_grid(peer), shares));
    tables.push_back(measure_search(laboratory, catalogue, "bvh", scene, ways_of_bvh(peer), shares));
  }
  tables.push_back(std::move(shares));
  return tables;
}

}  // namespace broadside::lab

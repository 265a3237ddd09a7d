// Section VI-A: updating only what changed pays where few boxes move. Up to how many, for each algorithm.
#include <algorithm>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/following.hpp"
#include "paper/experiments/growth.hpp"

namespace broadside::lab {
namespace {

/// An algorithm's ways to follow movers, and the one that finds all pairs anew; as values of `update`.
struct Ways {
  std::string algorithm;
  std::vector<std::string> updating;
  std::string rebuilding;

  std::string spec(const std::string& way) const { return algorithm + ":update=" + way; }
};

const std::vector<Ways>& all_ways() {
  static const std::vector<Ways> list = {{"brute_force", {"changed"}, "all"},
                                         {"grid", {"reinsert", "translate"}, "rebuild"},
                                         {"sweep_and_prune", {"binary", "merge"}, "rebuild"},
                                         {"quadtree", {"root", "relative"}, "rebuild"},
                                         {"bvh", {"refit", "enlarge", "reinsert"}, "rebuild"}};
  return list;
}

/// Follows always and has no other way: for the last row, the best of all.
constexpr const char* follower = "hierarchical_grid";
constexpr const char* best_of_all = "best of all";

struct Timed {
  std::string way;
  std::optional<double> ms;

  void take(const std::string& other, const Cell& cell) {
    const auto* const time = std::get_if<double>(&cell);
    if (time == nullptr || (ms && *ms <= *time)) return;
    way = other;
    ms = *time;
  }
  Cell cell() const { return ms ? Cell(*ms) : Cell(); }
  Cell text() const { return ms ? Cell(way) : Cell(); }
};

Table make_table(int dimension, std::size_t boxes) {
  const std::string axes = dimension_text(dimension);
  return {.name = fmt::format("times_{}d", dimension),
          .title = fmt::format("A frame of {} uniform boxes in {}: the best way to update what changed, all "
                               "pairs anew, and what the algorithm chooses",
                               grouped(boxes), axes),
          .columns = {{"algorithm"},
                      {"moving", "%"},
                      {"updating", "ms"},
                      {"by"},
                      {"rebuilding", "ms"},
                      {"updating over rebuilding"},
                      {"left to itself", "ms"}},
          .charts = {log_log_chart(
              "Updating over rebuilding, by the boxes that move: below 1 updating wins; " + axes, "moving",
              "updating over rebuilding", "algorithm")}};
}

void add_rows(Table& table, const CaseResult& result, double moving) {
  Timed best_update;
  Timed best_rebuild;
  for (const Ways& ways : all_ways()) {
    Timed update;
    for (const std::string& way : ways.updating)
      update.take(way, time_cell(measurement_of(result, ways.spec(way))));
    const Cell rebuild = time_cell(measurement_of(result, ways.spec(ways.rebuilding)));
    const Cell choice = time_cell(measurement_of(result, ways.algorithm));
    table.add({ways.algorithm, 100 * moving, update.cell(), update.text(), rebuild,
               ratio_cell(update.cell(), rebuild), choice});
    best_update.take(ways.algorithm, update.cell());
    best_rebuild.take(ways.algorithm, rebuild);
  }
  best_update.take(follower, time_cell(measurement_of(result, follower)));
  table.add({best_of_all, 100 * moving, best_update.cell(), best_update.text(), best_rebuild.cell(),
             ratio_cell(best_update.cell(), best_rebuild.cell()), time_cell(measurement_of(result, "auto"))});
}

std::vector<Table> measure(const Laboratory& laboratory) {
  std::string algorithms = fmt::format("{},auto", follower);
  for (const Ways& ways : all_ways()) {
    algorithms += fmt::format(",{},{}", ways.algorithm, ways.spec(ways.rebuilding));
    for (const std::string& way : ways.updating) algorithms += "," + ways.spec(way);
  }
  const auto fractions = laboratory.either<std::vector<double>>({0.001, 0.003, 0.01, 0.03, 0.1, 0.2, 0.5, 1},
                                                                {0.001, 0.1, 0.3, 1});
  const std::size_t boxes = laboratory.either<std::size_t>(10'000, 6'000);
  Effort effort = effort_to_follow(laboratory);
  effort.share_seconds /= 2;
  std::vector<Table> tables;
  for (const int dimension : {2, 3}) {
    Table& table = tables.emplace_back(make_table(dimension, boxes));
    for (const double moving : fractions) {
      const CaseResult result = laboratory.measure(algorithms,
                                                   {.scene = "uniform",
                                                    .dimension = dimension,
                                                    .boxes = boxes,
                                                    .moving = moving,
                                                    .frames = laboratory.either<std::size_t>(15, 5)},
                                                   effort);
      add_rows(table, result, moving);
    }
  }
  return tables;
}

/// Up to which fraction updating pays, of one algorithm.
struct Limit {
  std::string algorithm;
  int dimension;
  double percent = 100;  ///< 0 if it does not even where the fewest move
  bool is_always = false;
  double gain = 0;         ///< rebuilding over updating where the fewest move
  double loss_at_all = 0;  ///< updating over rebuilding where the most move
};

Limit limit_of(const Table& table, const std::string& algorithm, int dimension) {
  const Table rows = table.where("algorithm", algorithm);
  const auto ratios = rows.points("moving", "updating over rebuilding");
  if (ratios.size() < 2)
    throw std::invalid_argument(fmt::format("table '{}': {} rows with both times of '{}'; expected two",
                                            table.name, ratios.size(), algorithm));
  const auto from = crossover_in(rows, "moving", "rebuilding", "updating");
  Limit limit{.algorithm = algorithm,
              .dimension = dimension,
              .is_always = !from,
              .gain = 1 / ratios.front().second,
              .loss_at_all = ratios.back().second};
  if (from) limit.percent = *from > ratios.front().first ? *from : 0;
  return limit;
}

/// The most that an algorithm left to itself loses against the better of its ways; and where.
std::pair<double, std::string> worst_choice(const std::vector<Table>& tables) {
  std::pair<double, std::string> worst{0, ""};
  for (const int dimension : {2, 3}) {
    const Table& table = table_named(tables, fmt::format("times_{}d", dimension));
    for (const std::vector<Cell>& row : table.rows) {
      const auto* const name = std::get_if<std::string>(&row[table.column("algorithm")]);
      const auto* const moving = std::get_if<double>(&row[table.column("moving")]);
      const auto* const updating = std::get_if<double>(&row[table.column("updating")]);
      const auto* const rebuilding = std::get_if<double>(&row[table.column("rebuilding")]);
      const auto* const choice = std::get_if<double>(&row[table.column("left to itself")]);
      if (name == nullptr || moving == nullptr || updating == nullptr || rebuilding == nullptr ||
          choice == nullptr)
        continue;
      const double loss = *choice / std::min(*updating, *rebuilding);
      if (loss > worst.first)
        worst = {loss, fmt::format("{} in {}D, {} %", *name, dimension, rounded(*moving))};
    }
  }
  if (!(worst.first > 0))
    throw std::invalid_argument("no times of algorithms left to themselves; expected some");
  return worst;
}

Finding judge(const std::vector<Table>& tables) {
  std::vector<Limit> limits;
  std::vector<Limit> best;
  for (const int dimension : {2, 3}) {
    const Table& table = table_named(tables, fmt::format("times_{}d", dimension));
    for (const std::string& algorithm : table.distinct_texts("algorithm"))
      (algorithm == best_of_all ? best : limits).push_back(limit_of(table, algorithm, dimension));
  }
  if (limits.empty() || best.size() != 2)
    throw std::invalid_argument(
        "tables 'times_2d' and 'times_3d' miss algorithms; expected some, and best of all");
  const auto [least, most] = std::ranges::minmax_element(limits, {}, &Limit::percent);

  Finding finding;
  if (least->percent == 0) {
    finding.verdict = Verdict::does_not_hold;
  } else if (std::ranges::all_of(limits, &Limit::is_always)) {
    finding.verdict = Verdict::holds;
  } else {
    finding.verdict = Verdict::holds_when;
    finding.condition = fmt::format("less than {:.0f} % of the boxes move", least->percent);
  }
  std::string list;
  for (const Limit& limit : limits) {
    list += fmt::format("{}{} in {}D {}", list.empty() ? "" : ", ", limit.algorithm, limit.dimension,
                        limit.is_always      ? "at any"
                        : limit.percent == 0 ? "never"
                                             : fmt::format("{:.0f} %", limit.percent));
  }
  const auto gains = std::ranges::minmax(limits, {}, &Limit::gain);
  const auto losses = std::ranges::minmax(limits, {}, &Limit::loss_at_all);
  const auto [loss, where] = worst_choice(tables);
  finding.reason = fmt::format(
      "Updating pays up to this fraction of moving boxes: {}. Where the fewest move it is {} to {} times as "
      "fast; where all move it takes {:.2f} to {:.2f} times as long. The best way to update beats the best "
      "rebuilding of all up to {:.0f} % in 2D and {:.0f} % in 3D. An algorithm left to itself takes at most "
      "{:.2f} times the better of its ways ({}).",
      list, rounded(gains.min.gain), rounded(gains.max.gain), losses.min.loss_at_all, losses.max.loss_at_all,
      best[0].percent, best[1].percent, loss, where);
  for (const Limit& limit : limits)
    finding.figures.push_back(
        {fmt::format("{}_{}d_pays_up_to", limit.algorithm, limit.dimension), limit.percent, "%"});
  finding.figures.insert(finding.figures.end(), {{"least_crossover", least->percent, "%"},
                                                 {"greatest_crossover", most->percent, "%"},
                                                 {"least_gain_where_fewest_move", gains.min.gain},
                                                 {"greatest_gain_where_fewest_move", gains.max.gain},
                                                 {"greatest_loss_where_all_move", losses.max.loss_at_all},
                                                 {"best_of_all_2d_pays_up_to", best[0].percent, "%"},
                                                 {"best_of_all_3d_pays_up_to", best[1].percent, "%"},
                                                 {"worst_choice_over_better_way", loss}});
  return finding;
}

}  // namespace

Experiment update_fraction() {
  return {.number = 9,
          .name = "update_fraction",
          .title = "Updating only what changed",
          .claim =
              "For all algorithms we can append a flag to each object to check if it has been changed ... If "
              "it has been changed, we then reposition its reference within a collection. If it has not been "
              "changed then we do not need to rebuild the collection, and only change a subset of objects.",
          .section = "VI-A",
          .measured =
              "A frame of each of our algorithms on uniform boxes that drift by a fifth of themselves: the "
              "fastest of its ways to update what changed, kept at any fraction, against all pairs found "
              "anew and compared with those of the frame before; and what it does left to itself. The "
              "sweep's slower ways are in numbers 12 and 13.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

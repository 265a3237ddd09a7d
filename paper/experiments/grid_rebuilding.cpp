// Section VI-B: where most boxes move, a grid is rebuilt faster than they are reinserted into it.
#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/mending.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

const std::vector<std::string> specs = {"paper_grid:update=reinsert", "paper_grid:update=translate",
                                        "paper_grid:update=rebuild"};

/// "Most objects are moving": more than half of them.
constexpr double most = 50;

struct Case {
  std::size_t boxes;
  double drift;
};

std::vector<Table> measure(const Laboratory& laboratory) {
  Table table{
      .name = "times",
      .title =
          "The cells of the paper's grid: movers reinserted, their references translated, or all boxes "
          "added to empty cells; and the whole frame, which is then searched",
      .columns = {{"case"},
                  {"boxes"},
                  {"drift", "of a box"},
                  {"moving", "%"},
                  {"detecting", "ms"},
                  {"reinserting", "ms"},
                  {"translating", "ms"},
                  {"rebuilding", "ms"},
                  {"searching", "ms"},
                  {"frame reinserting", "ms"},
                  {"frame rebuilding", "ms"},
                  {"entries looked at by reinserting"},
                  {"entries looked at by rebuilding"}},
      .charts = {
          log_log_chart("Reinserting over rebuilding, by the boxes that move: below 1 reinserting wins",
                        "moving", "reinserting over rebuilding", "case")}};
  append(table.columns, ratio_columns("reinserting over rebuilding"));
  append(table.columns, ratio_columns("frames reinserting over rebuilding"));
  const auto fractions =
      laboratory.either<std::vector<double>>({0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1}, {0.1, 0.3, 1});
  const std::size_t many = laboratory.either<std::size_t>(50'000, 10'000);
  for (const Case& of : {Case{1'000, 0.2}, Case{5'000, 0.2}, Case{many, 0.2}, Case{5'000, 2}}) {
    const std::string name = fmt::format("{} boxes, drift {}", grouped(of.boxes), of.drift);
    for (const double moving : fractions) {
      const std::vector<MendingCost> costs =
          measure_mending<2>(laboratory, specs,
                             {.scene = "uniform",
                              .boxes = of.boxes,
                              .moving = moving,
                              .frames = laboratory.either<std::size_t>(12, 4),
                              .drift = of.drift});
      const MendingCost& reinserted = costs[0];
      const MendingCost& rebuilt = costs[2];
      // Building adds each reference to the end of its cell: it looks at what it writes, of all boxes.
      std::vector<Cell> row = {name,
                               static_cast<double>(of.boxes),
                               of.drift,
                               100 * moving,
                               reinserted.detecting.median(),
                               reinserted.mending.median(),
                               costs[1].mending.median(),
                               rebuilt.mending.median(),
                               rebuilt.searching.median(),
                               reinserted.frame.median(),
                               rebuilt.frame.median(),
                               reinserted.visited * reinserted.movers,
                               rebuilt.moved * rebuilt.movers};
      append(row, ratio_cells(reinserted.mending, rebuilt.mending));
      append(row, ratio_cells(reinserted.frame, rebuilt.frame));
      table.add(std::move(row));
    }
  }
  return {table};
}

/// What one case comes to.
struct Race {
  std::string name;
  std::string figure;   ///< what its crossing is called among the figures
  Crossing crossing{};  ///< the % that move from which on rebuilding wins
  RatioAt at_all{};     ///< reinserting over rebuilding where all move
  RatioAt frame_at_all{};
  double looks = 0;  ///< entries looked at, likewise

  double time() const { return at_all.ratio; }
  double from() const { return crossing.at.value_or(200); }
};

Race race_of(const Table& table, const std::string& name) {
  const Table rows = table.where("case", name);
  const std::vector<RatioAt> ratios = ratios_over(rows, "moving", "reinserting over rebuilding");
  const std::vector<RatioAt> frames = ratios_over(rows, "moving", "frames reinserting over rebuilding");
  const auto looks = rows.points("entries looked at by rebuilding", "entries looked at by reinserting");
  if (looks.empty() || !(looks.back().first > 0))
    throw std::invalid_argument(
        fmt::format("table 'times' has no entries looked at in '{}'; expected some", name));
  return {.name = name,
          .figure = fmt::format("crossover_{:.0f}_boxes_drift_{:.0f}_percent", rows.number("boxes"),
                                100 * rows.number("drift")),
          .crossing = rises_above(1, ratios),
          .at_all = ratios.back(),
          .frame_at_all = frames.back(),
          .looks = looks.back().second / looks.back().first};
}

/// Two hashes against one, in words of a ratio.
constexpr double two = 2;

/// What lies closer to it than this is two.
constexpr double about = 0.2;

/// The verdict on a statement that something is twice as much where all boxes move.
template <typename Value>
Statement judge_two(const std::vector<Race>& races, Statement statement, const Value& value) {
  std::vector<std::string> names;
  for (const Race& race : races) {
    if (std::abs(std::invoke(value, race) - two) <= about) names.push_back(race.name);
  }
  if (names.size() == races.size()) {
    statement.verdict = Verdict::confirmed;
  } else if (!names.empty()) {
    statement.verdict = Verdict::within_bounds;
    statement.condition = fmt::format("there are {}", fmt::join(names, " or "));
  }
  return statement;
}

Finding judge(const std::vector<Table>& tables) {
  const Table& table = table_named(tables, "times");
  std::vector<Race> races;
  for (const std::string& name : table.distinct_texts("case")) races.push_back(race_of(table, name));
  if (races.empty()) throw std::invalid_argument("table 'times' has no rows; expected two a case");
  const auto [first, last] = std::ranges::minmax_element(races, {}, &Race::from);
  const auto at_all = [](const Race& race) { return race.at_all.ratio; };
  const auto frame_at_all = [](const Race& race) { return race.frame_at_all.ratio; };
  const auto [least, greatest] = std::ranges::minmax_element(races, {}, at_all);
  const auto [least_frame, greatest_frame] = std::ranges::minmax_element(races, {}, frame_at_all);
  const auto [fewest_looks, most_looks] = std::ranges::minmax_element(races, {}, &Race::looks);

  Finding finding;
  Statement rebuilding{.name = "rebuilding",
                       .text = "where most objects move, rebuilding is faster than reinserting",
                       .threshold = fmt::format("it is faster wherever more than {:.0f} % move", most),
                       .evidence = {"earliest_crossover", "latest_crossover"}};
  if (last->from() <= most) {
    rebuilding.verdict = Verdict::confirmed;
  } else if (last->from() <= 100) {
    rebuilding.verdict = Verdict::within_bounds;
    std::vector<std::string> bounds;
    for (const Race& race : races) bounds.push_back(fmt::format("{:.0f} % of {}", race.from(), race.name));
    rebuilding.condition = fmt::format("more of the boxes move than {}", fmt::join(bounds, ", "));
  }
  const Statement work =
      judge_two(races,
                {.name = "two_hashes",
                 .text = "since reinserting takes two hashes and rebuilding one, twice as much work",
                 .threshold = fmt::format("{} times the entries looked at, give or take {}", two, about),
                 .evidence = {"least_entries_ratio_where_all_move", "greatest_entries_ratio_where_all_move"}},
                &Race::looks);
  const Statement time =
      judge_two(races,
                {.name = "two_hashes_time",
                 .text = "and so twice the time",
                 .threshold = fmt::format("{} times the time, give or take {}", two, about),
                 .evidence = {"least_ratio_where_all_move", "greatest_ratio_where_all_move"}},
                &Race::time);
  finding.statements = {rebuilding, work, time};
  finding.reason = fmt::format(
      "Building all cells anew is faster than reinserting from {:.0f} % moving boxes on ({}) at the earliest "
      "and {} at the latest. Where all move, reinserting takes {:.2f} ({}) to {:.2f} times ({}) as long, and "
      "looks "
      "at {:.2f} to {:.2f} times as many entries: besides the two hashes, a reference has to be found among "
      "the "
      "others of its cell, and there is one in each cell of a box. Whole frames take {:.2f} to {:.2f} times "
      "as "
      "long, since both search all cells.",
      first->from(), first->name,
      last->from() <= 100 ? fmt::format("{:.0f} % ({})", last->from(), last->name)
                          : fmt::format("never ({})", last->name),
      least->at_all.ratio, least->name, greatest->at_all.ratio, greatest->name, fewest_looks->looks,
      most_looks->looks, least_frame->frame_at_all.ratio, greatest_frame->frame_at_all.ratio);
  const auto crossover = [](const std::string& name, const Race& race) {
    return Figure{name, std::min(race.from(), 100.0), "%", race.crossing.interval(100)};
  };
  const auto ratio = [](const std::string& name, const RatioAt& at) {
    return Figure{name, at.ratio, "", at.interval};
  };
  finding.figures = {crossover("earliest_crossover", *first),
                     crossover("latest_crossover", *last),
                     ratio("least_ratio_where_all_move", least->at_all),
                     ratio("greatest_ratio_where_all_move", greatest->at_all),
                     ratio("least_ratio_of_frames_where_all_move", least_frame->frame_at_all),
                     ratio("greatest_ratio_of_frames_where_all_move", greatest_frame->frame_at_all),
                     {"least_entries_ratio_where_all_move", fewest_looks->looks},
                     {"greatest_entries_ratio_where_all_move", most_looks->looks}};
  for (const Race& race : races) finding.figures.push_back(crossover(race.figure, race));
  return finding;
}

}  // namespace

Experiment grid_rebuilding() {
  return {
      .number = 11,
      .name = "grid_rebuilding",
      .title = "Grid: reinserting or rebuilding",
      .claim =
          "As a whole if most objects are moving objects, then rebuilding the entire subcollections "
          "would be faster as reinserting requires one hash to find an object and another hash to place "
          "it. Whereas rebuilding requires only one hash to place an object.",
      .section = "VI-B",
      .measured =
          "The time to mend the cells of the paper's grid on uniform boxes, by the fraction that moves: each "
          "mover found by one hash and placed by another (paper_grid:update=reinsert), or all boxes added to "
          "empty cells (update=rebuild); and the entries that both look at. To find out by a flag which "
          "boxes moved "
          "and to search all cells are timed apart; both ways do the same of them.",
      .measure = measure,
      .judge = judge};
}

}  // namespace broadside::lab

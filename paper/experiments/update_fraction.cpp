// Section VI-A: updating only what changed pays where few boxes move. Up to how many, for each structure;
// what it costs to know which changed; and whether it is enough to search them, delete them and insert them
// again.
#include <algorithm>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/mending.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

/// A structure of the paper, and the ways to mend it; as values of `update`.
struct Structure {
  std::string algorithm;
  std::vector<std::string> updates;
};

/// VI-A: the object is searched in all cells, deleted and inserted.
const std::string searching = "search_once";

const std::vector<Structure>& structures() {
  static const std::vector<Structure> list = {
      {"paper_grid", {searching, "reinsert", "translate"}},
      {"paper_sweep_and_prune", {"heap", "insertion", "binary"}},
      {"paper_quadtree", {"root", "relative", "siblings", "cousins"}}};
  return list;
}

const std::vector<std::string> detections = {"flag", "compare"};

/// Of the boxes, where detection is compared: few, so that it weighs.
constexpr double few = 0.01;

/// The times of one way to follow boxes, and of building the structure anew in each frame.
struct Costs {
  MendingCost mended;
  MendingCost built;
};

const std::vector<Column> parts_columns = {{"detecting", "ms"}, {"mending", "ms"}, {"building", "ms"},
                                           {"searching", "ms"}, {"frame", "ms"},   {"frame building", "ms"}};

std::vector<Cell> parts_cells(const Costs& costs) {
  return {costs.mended.detecting.median(), costs.mended.mending.median(), costs.built.mending.median(),
          costs.mended.searching.median(), costs.mended.frame.median(),   costs.built.frame.median()};
}

/// A row: what is compared, its times, and the ratios of mending alone and of whole frames.
std::vector<Cell> row_of(std::vector<Cell> row, const Costs& costs) {
  append(row, parts_cells(costs));
  append(row, ratio_cells(costs.mended.mending, costs.built.mending));
  append(row, ratio_cells(costs.mended.frame, costs.built.frame));
  return row;
}

std::vector<Column> columns_after(std::vector<Column> columns) {
  append(columns, parts_columns);
  append(columns, ratio_columns("mending over building"));
  append(columns, ratio_columns("updating over rebuilding"));
  return columns;
}

const std::string detecting_and_mending = "detecting and mending over building";

std::vector<Cell> detection_row(std::vector<Cell> row, const Costs& costs) {
  append(row, parts_cells(costs));
  append(row, ratio_cells(costs.mended.detecting + costs.mended.mending, costs.built.mending));
  return row;
}

std::vector<Table> measure(const Laboratory& laboratory) {
  const auto fractions = laboratory.either<std::vector<double>>({0.001, 0.003, 0.01, 0.03, 0.1, 0.2, 0.5, 1},
                                                                {0.001, 0.1, 0.3, 1});
  const std::size_t boxes = laboratory.either<std::size_t>(10'000, 3'000);
  const auto history = [&](double moving) {
    return CaseRequest{.scene = "uniform",
                       .boxes = boxes,
                       .moving = moving,
                       .frames = laboratory.either<std::size_t>(12, 4)};
  };
  Table times{.name = "times",
              .title = fmt::format(
                  "A frame of {} uniform boxes in 2D: the structure mended in the way whose frame is the "
                  "fastest, or built anew, and then searched",
                  grouped(boxes)),
              .columns = columns_after({{"algorithm"}, {"moving", "%"}, {"by"}}),
              .charts = {log_log_chart("Whole frames: updating over rebuilding, by the boxes that move",
                                       "moving", "updating over rebuilding", "algorithm"),
                         log_log_chart("The structure alone: mending over building, by the boxes that move",
                                       "moving", "mending over building", "algorithm")}};
  Table search{
      .name = "search",
      .title = "The paper's grid: all cells searched for the boxes that changed, these deleted and inserted",
      .columns = columns_after({{"moving", "%"}, {"entries looked at a mover"}})};
  Table detection{.name = "detection",
                  .title = "What it costs to know which boxes changed, where one in a hundred did",
                  .columns = {{"algorithm"}, {"detection"}}};
  append(detection.columns, parts_columns);
  append(detection.columns, ratio_columns(detecting_and_mending));
  for (const Structure& structure : structures()) {
    std::vector<std::string> specs = {structure.algorithm + ":update=rebuild"};
    for (const std::string& update : structure.updates)
      specs.push_back(structure.algorithm + ":update=" + update);
    for (const double moving : fractions) {
      const std::vector<MendingCost> costs = measure_mending<2>(laboratory, specs, history(moving));
      const auto best = std::ranges::min_element(costs.begin() + 1, costs.end(), {},
                                                 [](const MendingCost& cost) { return cost.frame.median(); });
      const std::string& by = structure.updates[static_cast<std::size_t>(best - costs.begin()) - 1];
      times.add(row_of({structure.algorithm, 100 * moving, by}, {*best, costs[0]}));
      if (structure.updates[0] == searching)
        search.add(row_of({100 * moving, costs[1].visited}, {costs[1], costs[0]}));
    }
    specs.resize(1);
    for (const std::string& detect : detections)
      specs.push_back(
          fmt::format("{}:update={}:detect={}", structure.algorithm, structure.updates.back(), detect));
    const std::vector<MendingCost> costs = measure_mending<2>(laboratory, specs, history(few));
    for (std::size_t i = 0; i < detections.size(); ++i)
      detection.add(detection_row({structure.algorithm, detections[i]}, {costs[i + 1], costs[0]}));
  }
  return {times, search, detection};
}

/// Up to which fraction of moving boxes a ratio to building anew stays below 1.
struct Limit {
  std::string name;
  std::vector<RatioAt> ratios{};
  Crossing crossing{};

  const RatioAt& fewest() const { return ratios.front(); }
  const RatioAt& most() const { return ratios.back(); }
  bool never() const { return !fewest().is_below(1); }
  bool always() const {
    return !never() && std::ranges::none_of(ratios, [](const RatioAt& at) { return at.is_above(1); });
  }
  double percent() const { return never() ? 0 : always() ? 100 : crossing.at.value_or(100); }

  std::string text() const {
    return name + (never() ? " never" : always() ? " at any" : fmt::format(" {:.0f} %", percent()));
  }
};

Limit limit_of(const Table& rows, const std::string& name, const std::string& ratio) {
  Limit limit{.name = name, .ratios = ratios_over(rows, "moving", ratio)};
  limit.crossing = rises_above(1, limit.ratios);
  return limit;
}

Figure figure_of(const std::string& name, const Limit& limit) {
  const bool is_crossing = !limit.never() && !limit.always();
  return {name, limit.percent(), "%",
          is_crossing ? std::optional(limit.crossing.interval(100)) : std::nullopt};
}

/// The verdict on a statement that following pays, for one structure or for several.
void judge_limits(const std::vector<Limit>& limits, Statement& statement) {
  std::vector<std::string> payers;
  double least = 100;
  for (const Limit& limit : limits) {
    if (limit.never()) continue;
    payers.push_back(limit.name);
    least = std::min(least, limit.percent());
  }
  if (payers.empty()) return;
  std::vector<std::string> bounds;
  if (payers.size() < limits.size())
    bounds.push_back(fmt::format("the structure is that of {}", fmt::join(payers, " or ")));
  const auto always = [](const Limit& limit) { return limit.never() || limit.always(); };
  if (!std::ranges::all_of(limits, always))
    bounds.push_back(fmt::format("less than {:.0f} % of the boxes move", least));
  statement.verdict = bounds.empty() ? Verdict::confirmed : Verdict::within_bounds;
  statement.condition = fmt::format("{}", fmt::join(bounds, " and "));
}

/// Whether it costs less to know what changed, in each way, and to mend that, than to build the structure
/// anew.
Statement judge_detection(const Table& table, std::vector<Figure>& figures) {
  Statement statement{
      .name = "detection",
      .text = "a flag, or a previous state, tells what changed",
      .threshold = fmt::format("where {:.0f} % move, detecting and mending take less time than "
                               "building, beyond noise",
                               100 * few)};
  std::vector<std::string> paying;
  for (const std::string& detect : detections) {
    const Table rows = table.where("detection", detect);
    double greatest_share = 0;
    RatioAt worst;
    for (const std::string& algorithm : rows.distinct_texts("algorithm")) {
      const Table row = rows.where("algorithm", algorithm);
      const RatioAt ratio{.ratio = row.number(detecting_and_mending),
                          .interval = {row.number(detecting_and_mending + " low"),
                                       row.number(detecting_and_mending + " high")}};
      if (ratio.ratio >= worst.ratio) worst = ratio;
      greatest_share = std::max(greatest_share, 100 * row.number("detecting") / row.number("frame"));
    }
    if (worst.ratio == 0)
      throw std::invalid_argument(fmt::format("table 'detection' has no row of '{}'; expected some", detect));
    if (worst.is_below(1)) paying.push_back(detect);
    figures.push_back({detect + "_and_mending_over_building", worst.ratio, "", worst.interval});
    figures.push_back({detect + "_greatest_share_of_a_frame", greatest_share, "%"});
    append(statement.evidence,
           {detect + "_and_mending_over_building", detect + "_greatest_share_of_a_frame"});
  }
  if (paying.size() == detections.size()) {
    statement.verdict = Verdict::confirmed;
  } else if (!paying.empty()) {
    statement.verdict = Verdict::within_bounds;
    statement.condition = paying[0] == "flag" ? "it is a flag" : "it is a previous state";
  }
  return statement;
}

Finding judge(const std::vector<Table>& tables) {
  const Table& table = table_named(tables, "times");
  std::vector<Limit> frames;
  std::vector<Limit> mending;
  for (const std::string& algorithm : table.distinct_texts("algorithm")) {
    frames.push_back(limit_of(table.where("algorithm", algorithm), algorithm, "updating over rebuilding"));
    mending.push_back(limit_of(table.where("algorithm", algorithm), algorithm, "mending over building"));
  }
  if (frames.empty()) throw std::invalid_argument("table 'times' has no rows; expected two an algorithm");
  const Limit search = limit_of(table_named(tables, "search"), "search", "mending over building");
  const Limit search_frames = limit_of(table_named(tables, "search"), "search", "updating over rebuilding");

  Finding finding;
  Statement structure{.name = "structure",
                      .text = "where only a subset changed, the collection need not be rebuilt",
                      .threshold = "the fastest way of mending takes less time than building"};
  Statement frame{.name = "frames",
                  .text = "so whole frames, with the search of all that was kept, take less time",
                  .threshold = "a frame by the fastest way takes less time than one that builds anew"};
  Statement reinsertion{
      .name = "search_delete_reinsert",
      .text =
          "all of this can be done by searching, deleting and reinserting the object (with one "
          "search for all that moved, erratum T10)",
      .threshold = "that takes less time than building",
      .evidence = {"search_pays_up_to", "search_gain_where_fewest_move"}};
  judge_limits(mending, structure);
  judge_limits(frames, frame);
  judge_limits({search}, reinsertion);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    finding.figures.push_back(figure_of(mending[i].name + "_mending_pays_up_to", mending[i]));
    finding.figures.push_back(figure_of(frames[i].name + "_pays_up_to", frames[i]));
    structure.evidence.push_back(mending[i].name + "_mending_pays_up_to");
    frame.evidence.push_back(frames[i].name + "_pays_up_to");
  }
  const auto fewest = [](const Limit& limit) { return limit.fewest().ratio; };
  const auto most = [](const Limit& limit) { return limit.most().ratio; };
  const auto add = [&](const std::string& name, const RatioAt& at) {
    finding.figures.push_back({name, at.ratio, "", at.interval});
  };
  // The time of building over that of mending.
  const auto add_gain = [&](const std::string& name, const RatioAt& at) {
    finding.figures.push_back({name, 1 / at.ratio, "", Interval{1 / at.interval.high, 1 / at.interval.low}});
  };
  add_gain("least_gain_where_fewest_move", std::ranges::max(frames, {}, fewest).fewest());
  add_gain("greatest_gain_where_fewest_move", std::ranges::min(frames, {}, fewest).fewest());
  add_gain("least_mending_gain_where_fewest_move", std::ranges::max(mending, {}, fewest).fewest());
  add_gain("greatest_mending_gain_where_fewest_move", std::ranges::min(mending, {}, fewest).fewest());
  add("greatest_mending_ratio_where_all_move", std::ranges::max(mending, {}, most).most());
  add("least_ratio_where_all_move", std::ranges::min(frames, {}, most).most());
  add("greatest_ratio_where_all_move", std::ranges::max(frames, {}, most).most());
  finding.figures.push_back(figure_of("search_pays_up_to", search));
  finding.figures.push_back(figure_of("search_frames_pay_up_to", search_frames));
  add_gain("search_gain_where_fewest_move", search.fewest());
  append(structure.evidence,
         {"least_mending_gain_where_fewest_move", "greatest_mending_gain_where_fewest_move"});
  append(frame.evidence, {"least_gain_where_fewest_move", "greatest_gain_where_fewest_move"});
  const Statement detection = judge_detection(table_named(tables, "detection"), finding.figures);
  finding.statements = {structure, frame, detection, reinsertion};

  const auto list_text = [](const std::vector<Limit>& limits) {
    std::vector<std::string> texts;
    for (const Limit& limit : limits) texts.push_back(limit.text());
    return fmt::format("{}", fmt::join(texts, ", "));
  };
  const auto figure = [&](const std::string& name) {
    return std::ranges::find(finding.figures, name, &Figure::name)->value;
  };
  finding.reason = fmt::format(
      "Mending the structure pays up to this fraction of moving boxes: {}; updating pays in whole frames: "
      "{}. Where "
      "the fewest move, mending is {} to {} times as fast as building, but a frame, which searches "
      "everything "
      "either way, only {:.2f} to {:.2f} times; where all move, a frame takes {:.2f} to {:.2f} times as "
      "long. To "
      "look at each flag takes at most {:.1f} % of a frame in which one in a hundred moves, to compare each "
      "box "
      "{:.1f} %. To look through all cells of the grid for the boxes that moved pays against building them: "
      "{}.",
      list_text(mending), list_text(frames), rounded(figure("least_mending_gain_where_fewest_move")),
      rounded(figure("greatest_mending_gain_where_fewest_move")), figure("least_gain_where_fewest_move"),
      figure("greatest_gain_where_fewest_move"), figure("least_ratio_where_all_move"),
      figure("greatest_ratio_where_all_move"), figure("flag_greatest_share_of_a_frame"),
      figure("compare_greatest_share_of_a_frame"), search.text());
  return finding;
}

}  // namespace

Experiment update_fraction() {
  return {
      .number = 9,
      .name = "update_fraction",
      .title = "Updating only what changed",
      .claim =
          "For all algorithms we can append a flag to each object to check if it has been changed and/or "
          "keep a "
          "previous state of the object in addition to its current state. If it has been changed, we then "
          "reposition its reference within a collection. If it has not been changed then we do not need to "
          "rebuild the collection, and only change a subset of objects. All of this can be done by simply "
          "searching the object, deleting it, and reinserting the object into the collection based off of "
          "its "
          "new position.",
      .section = "VI-A",
      .measured =
          "A frame of the paper's grid, sweep and quadtree on uniform boxes that drift by a fifth of "
          "themselves, its parts timed apart: to detect the changed boxes, to mend the structure in the "
          "fastest "
          "of its ways or to build it anew, to search all of it as the listing does; and the whole frame, "
          "with "
          "the comparison with the pairs of the frame before. Then the same with changes detected by a flag "
          "and by comparing each box with its previous state, and with the grid's cells searched for what "
          "changed.",
      .measure = measure,
      .judge = judge};
}

}  // namespace broadside::lab

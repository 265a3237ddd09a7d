// Section VI-D: a box that moves in a quadtree is reinserted relative to where it was, by way of siblings and
// cousins, or from the root; and what that means for boxes that span many leaves.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/mending.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

constexpr double moving = 0.1;
constexpr double usual_drift = 0.2;

/// What is less than this faster is as fast.
constexpr double margin = 0.1;

struct Trial {
  std::size_t boxes;
  int capacity;
  double neighbours;
  double drift;
};

/// The ways that do not begin at the root, by the columns in which they are compared with it. The last one
/// follows the claim to its end.
const std::string relative_gain = "from the root over relative";
const std::string siblings_gain = "from the root over siblings";
const std::string cousins_gain = "from the root over cousins";

/// What varies, and then what the ways cost.
std::vector<Column> columns_after(std::vector<Column> first) {
  first.insert(first.end(), {{"leaves a box"},
                             {"from the root", "ns"},
                             {"relative", "ns"},
                             {"siblings", "ns"},
                             {"cousins", "ns"},
                             {"nodes looked at from the root"},
                             {"detecting", "ms"},
                             {"mending from the root", "ms"},
                             {"searching", "ms"},
                             {"frame from the root", "ms"}});
  for (const std::string& gain : {relative_gain, siblings_gain, cousins_gain})
    append(first, ratio_columns(gain));
  return first;
}

std::vector<Cell> row_of(const Laboratory& laboratory, const Trial& trial, std::vector<Cell> first) {
  std::vector<std::string> specs;
  for (const char* const update : {"root", "relative", "siblings", "cousins"})
    specs.push_back(fmt::format("paper_quadtree:capacity={}:update={}", trial.capacity, update));
  const std::vector<MendingCost> costs =
      measure_mending<2>(laboratory, specs,
                         {.scene = fmt::format("uniform:neighbours={}", trial.neighbours),
                          .boxes = trial.boxes,
                          .moving = moving,
                          .frames = laboratory.either<std::size_t>(12, 4),
                          .drift = trial.drift});
  const MendingCost& root = costs[0];
  first.emplace_back(root.references);
  for (const MendingCost& cost : costs) first.emplace_back(cost.mover_ns());
  append(first, {root.visited, root.detecting.median(), root.mending.median(), root.searching.median(),
                 root.frame.median()});
  for (std::size_t i = 1; i < costs.size(); ++i) append(first, ratio_cells(root.mending, costs[i].mending));
  return first;
}

Chart chart_of(const std::string& title, const std::string& x, const std::string& gain) {
  return {.title = fmt::format("{}: {}, above 1 the root loses", title, gain),
          .x = x,
          .y = gain,
          .series = "tree",
          .log_x = true};
}

std::vector<Table> measure(const Laboratory& laboratory) {
  Table depth{.name = "depth",
              .title =
                  "A mover reinserted, by the number of boxes: the deeper the tree, the longer the way "
                  "from the root",
              .columns = columns_after({{"tree"}, {"boxes"}}),
              .charts = {chart_of("By the number of boxes", "boxes", cousins_gain)}};
  Table step{.name = "step",
             .title = "A mover reinserted, by how far it goes in a frame",
             .columns = columns_after({{"tree"}, {"drift", "of a box"}}),
             .charts = {chart_of("By how far a mover goes", "drift", cousins_gain)}};
  Table spanning{.name = "spanning",
                 .title =
                     "A mover reinserted, by the leaves that a box is in: neighbours make boxes larger "
                     "against leaves",
                 .columns = columns_after({{"tree"}, {"neighbours"}}),
                 .charts = {chart_of("By the leaves a box is in", "leaves a box", cousins_gain),
                            chart_of("By the leaves a box is in", "leaves a box", relative_gain)}};
  const auto many =
      laboratory.either<std::vector<std::size_t>>({1'000, 4'000, 16'000, 64'000}, {2'000, 8'000});
  const std::size_t boxes = laboratory.either<std::size_t>(8'000, 3'000);
  for (const int capacity : {8, 2}) {
    const std::string tree = fmt::format("capacity {}", capacity);
    for (const std::size_t count : many)
      depth.add(row_of(laboratory, {count, capacity, 4, usual_drift}, {tree, static_cast<double>(count)}));
    for (const double neighbours : laboratory.either<std::vector<double>>({0.5, 2, 8, 32, 128}, {0.5, 4, 32}))
      spanning.add(row_of(laboratory, {boxes, capacity, neighbours, usual_drift}, {tree, neighbours}));
  }
  for (const double drift : laboratory.either<std::vector<double>>({0.02, 0.1, 0.5, 2, 10}, {0.05, 5}))
    step.add(row_of(laboratory, {boxes, 8, 4, drift}, {"capacity 8", drift}));
  return {depth, step, spanning};
}

/// A way in a tree, from the boxes in the fewest leaves to those in the most.
struct Line {
  std::string tree;
  std::vector<RatioAt> gains;  ///< by leaves a box: from the root over this way
  double until = 0;            ///< leaves a box from which on it is not faster by the margin

  const RatioAt& fewest() const { return gains.front(); }
  const RatioAt& most() const { return gains.back(); }
  /// Where it gains least.
  RatioAt worst() const { return std::ranges::min(gains, {}, &RatioAt::ratio); }
  double fewest_ratio() const { return fewest().ratio; }
  double most_ratio() const { return most().ratio; }
  double least_ratio() const { return worst().ratio; }
  bool pays() const { return fewest().is_above(1 + margin); }
  bool always_pays() const { return worst().is_above(1 + margin); }
};

std::vector<Line> lines_of(const Table& table, const std::string& gain) {
  std::vector<Line> lines;
  for (const std::string& tree : table.distinct_texts("tree")) {
    Line line{.tree = tree, .gains = ratios_over(table.where("tree", tree), "leaves a box", gain)};
    std::vector<std::pair<double, double>> gains;
    std::vector<std::pair<double, double>> enough;
    for (const RatioAt& at : line.gains) {
      gains.emplace_back(at.x, at.ratio);
      enough.emplace_back(at.x, 1 + margin);
    }
    line.until = crossover(gains, enough).value_or(line.gains.back().x);
    lines.push_back(line);
  }
  if (lines.empty())
    throw std::invalid_argument(fmt::format("table '{}' has no rows; expected two a tree", table.name));
  return lines;
}

/// The verdict on a way that is to be faster than the one from the root.
Statement judge_way(std::string name, std::string text, const std::vector<Line>& lines) {
  Statement statement{
      .name = std::move(name),
      .text = std::move(text),
      .threshold = fmt::format("more than {:.0f} % faster, the interval too, in both trees and "
                               "wherever boxes are in several leaves",
                               100 * margin)};
  double until = INFINITY;
  std::vector<std::string> trees;
  for (const Line& line : lines) {
    if (!line.pays()) continue;
    trees.push_back(line.tree);
    if (!line.always_pays()) until = std::min(until, line.until);
  }
  if (trees.empty()) return statement;
  std::vector<std::string> bounds;
  if (trees.size() < lines.size())
    bounds.push_back(fmt::format("leaves are of {}", fmt::join(trees, " or ")));
  if (std::isfinite(until))
    bounds.push_back(fmt::format("boxes are in fewer than {:.1f} leaves on average", until));
  statement.verdict = bounds.empty() ? Verdict::confirmed : Verdict::within_bounds;
  statement.condition = fmt::format("{}", fmt::join(bounds, " and "));
  return statement;
}

/// "capacity_8" of "capacity 8".
std::string figure_name(const std::string& tree) {
  std::string name = tree;
  std::ranges::replace(name, ' ', '_');
  return name;
}

/// From the least to the greatest of what lines gain.
std::string range_text(const std::vector<Line>& lines, double (Line::*gain)() const) {
  const auto [least, most] = std::ranges::minmax(lines, {}, gain);
  return fmt::format("{:.2f} ({}) to {:.2f} ({})", (least.*gain)(), least.tree, (most.*gain)(), most.tree);
}

Finding judge(const std::vector<Table>& tables) {
  const Table& depth = table_named(tables, "depth");
  const Table& step = table_named(tables, "step");
  const Table& spanning = table_named(tables, "spanning");
  const std::vector<Line> across = lines_of(spanning, cousins_gain);
  const std::vector<Line> common = lines_of(spanning, relative_gain);
  const std::vector<Line> near = lines_of(spanning, siblings_gain);

  const Line worst_line = std::ranges::min(across, {}, &Line::least_ratio);
  const RatioAt worst = worst_line.worst();
  const double slowdown = 1 / worst.ratio;
  const std::string first = depth.distinct_texts("tree").at(0);
  const std::vector<RatioAt> by_depth = ratios_over(depth.where("tree", first), "boxes", cousins_gain);
  const std::vector<RatioAt> by_step =
      ratios_over(step.where("tree", step.distinct_texts("tree").at(0)), "drift", cousins_gain);

  Finding finding;
  Statement relative =
      judge_way("relative", "inserting relative to the old place is faster than from the root", common);
  Statement translating =
      judge_way("translating", "so is translating references across to siblings and cousins", across);
  for (const Line& line : common)
    relative.evidence.push_back("relative_fewest_leaves_" + figure_name(line.tree));
  for (const Line& line : across)
    translating.evidence.push_back("cousins_fewest_leaves_" + figure_name(line.tree));
  finding.statements = {relative,
                        translating,
                        {.name = "spanning",
                         .text = "that is a horrible idea for spanning elements",
                         .verdict = Verdict::not_testable,
                         .condition = "no number is horrible; the greatest loss is measured",
                         .evidence = {"worst_slowdown"}}};
  finding.reason = fmt::format(
      "Times as fast as from the root, the references of a mover that are carried across to siblings and "
      "cousins: with "
      "boxes in the fewest leaves {}, in the most {}. At its worst, in {:.1f} leaves ({}), it takes {:.2f} "
      "times as long "
      "as from the root. The way by the one node that holds the new place is {} "
      "times as "
      "fast in the fewest leaves, and {} in the most. Across to siblings and cousins, steps of {} of a box "
      "gain {:.2f} "
      "times, those of {} boxes {:.2f}; from {} to {} boxes the gain goes from {:.2f} to {:.2f} ({}).",
      range_text(across, &Line::fewest_ratio), range_text(across, &Line::most_ratio), worst.x,
      worst_line.tree, slowdown, range_text(common, &Line::fewest_ratio),
      range_text(common, &Line::most_ratio), rounded(by_step.front().x), by_step.front().ratio,
      rounded(by_step.back().x), by_step.back().ratio, whole(by_depth.front().x), whole(by_depth.back().x),
      by_depth.front().ratio, by_depth.back().ratio, first);
  const auto add_ratio = [&](const std::string& name, const RatioAt& at) {
    finding.figures.push_back({name, at.ratio, "", at.interval});
  };
  const auto add_gains = [&](const std::string& way, const std::vector<Line>& lines) {
    for (const Line& line : lines) {
      add_ratio(way + "_fewest_leaves_" + figure_name(line.tree), line.fewest());
      add_ratio(way + "_most_leaves_" + figure_name(line.tree), line.most());
    }
  };
  add_gains("cousins", across);
  add_gains("siblings", near);
  add_gains("relative", common);
  finding.figures.push_back({"worst_leaves", worst.x, "leaves"});
  finding.figures.push_back(
      {"worst_slowdown", slowdown, "", Interval{1 / worst.interval.high, 1 / worst.interval.low}});
  add_ratio("gain_least_drift", by_step.front());
  add_ratio("gain_greatest_drift", by_step.back());
  add_ratio("gain_fewest_boxes", by_depth.front());
  add_ratio("gain_most_boxes", by_depth.back());
  return finding;
}

}  // namespace

Experiment quadtree_siblings() {
  return {.number = 14,
          .name = "quadtree_siblings",
          .title = "Quadtree: by way of siblings or from the root",
          .claim =
              "So instead of reinserting at the root which can take O(lg(n)) time to search for the correct "
              "node for each element ..., we can insert based on relative position. ... we can insert "
              "references to siblings ... If sibling is not available then we can go to the cousin by "
              "traversing through the parent. This, however is a horrible idea for spanning elements.",
          .section = "VI-D",
          .measured =
              "The time to mend the paper's quadtree, apart from detecting and searching, for each of the "
              "uniform boxes that move, a tenth of "
              "them: inserted from "
              "the root (update=root); from the least node above its leaf that holds it (update=relative); "
              "or by the claim's "
              "words: each reference whose leaf the box has left goes up to the parent and down to the "
              "leaves that the box "
              "is in now, and where that is not enough the box is inserted from the root (update=siblings), "
              "or the "
              "reference goes further up (update=cousins). By the number of boxes, by how far they go, and "
              "by how many "
              "leaves they are in.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

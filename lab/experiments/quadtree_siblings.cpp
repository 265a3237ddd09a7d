// Section VI-D: a box that moves in a quadtree is filed anew relative to where it was, by way of siblings and
// cousins, or from the root; and what that means for boxes that span many leaves.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "lab/experiments/descriptions.hpp"
#include "lab/experiments/following.hpp"
#include "lab/experiments/growth.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab {
namespace {

constexpr double moving = 0.1;
constexpr double usual_drift = 0.2;

/// What is less than this faster is as fast.
constexpr double margin = 0.1;

struct Trial {
  int dimension;
  std::size_t boxes;
  int capacity;
  double neighbours;
  double drift;
};

/// What varies, and then what both ways cost.
std::vector<Column> columns_after(std::vector<Column> first) {
  first.insert(first.end(), {{"leaves a box"},
                             {"from the root", "ns"},
                             {"relative", "ns"},
                             {"from the root over relative"},
                             {"tests a mover"}});
  return first;
}

std::vector<Cell> row_of(const Laboratory& laboratory, const Trial& trial, std::vector<Cell> first) {
  const std::string root = fmt::format("quadtree:capacity={}:update=root", trial.capacity);
  const std::string relative = fmt::format("quadtree:capacity={}:update=relative", trial.capacity);
  const CaseResult result =
      laboratory.measure(root + "," + relative,
                         {.scene = fmt::format("uniform:neighbours={}", trial.neighbours),
                          .dimension = trial.dimension,
                          .boxes = trial.boxes,
                          .moving = moving,
                          .frames = laboratory.either<std::size_t>(15, 5),
                          .drift = trial.drift},
                         effort_to_follow(laboratory));
  const Cell slow = mover_cell(result, root);
  const Cell fast = mover_cell(result, relative);
  const Measurement& measured = measurement_of(result, relative);
  const auto boxes = static_cast<double>(trial.boxes);
  first.insert(first.end(),
               {scaled_cell(references_cell(measured), 1 / boxes), slow, fast, ratio_cell(slow, fast),
                scaled_cell(tests_cell(measured), 1 / (moving * boxes))});
  return first;
}

Chart chart_of(const std::string& title, const std::string& x) {
  return {.title = title + ": from the root over relative, above 1 relative wins",
          .x = x,
          .y = "from the root over relative",
          .series = "tree",
          .log_x = true};
}

std::vector<Table> measure(const Laboratory& laboratory) {
  Table depth{.name = "depth",
              .title =
                  "A mover filed anew, by the number of boxes: the deeper the tree, the longer the way "
                  "from the root",
              .columns = columns_after({{"tree"}, {"boxes"}}),
              .charts = {chart_of("By the number of boxes", "boxes")}};
  Table step{.name = "step",
             .title = "A mover filed anew, by how far it goes in a frame",
             .columns = columns_after({{"tree"}, {"drift", "of a box"}}),
             .charts = {chart_of("By how far a mover goes", "drift")}};
  Table spanning{.name = "spanning",
                 .title =
                     "A mover filed anew, by the leaves that a box is in: neighbours make boxes larger "
                     "against leaves",
                 .columns = columns_after({{"tree"}, {"neighbours"}}),
                 .charts = {chart_of("By the leaves a box is in", "leaves a box")}};
  for (const int dimension : {2, 3}) {
    const auto many =
        laboratory.either<std::vector<std::size_t>>({1'000, 6'000, 25'000, 100'000}, {6'000, 25'000});
    for (const int capacity : {32, 4}) {
      const std::string tree = fmt::format("{}, capacity {}", dimension_text(dimension), capacity);
      for (const std::size_t boxes : many)
        depth.add(row_of(laboratory, {dimension, boxes, capacity, 4, usual_drift},
                         {tree, static_cast<double>(boxes)}));
    }
    const std::string tree = fmt::format("{}, capacity 32", dimension_text(dimension));
    const std::size_t boxes = laboratory.either<std::size_t>(10'000, 6'000);
    for (const double drift : laboratory.either<std::vector<double>>({0.02, 0.1, 0.5, 2, 10}, {0.05, 5}))
      step.add(row_of(laboratory, {dimension, boxes, 32, 4, drift}, {tree, drift}));
    for (const int capacity : {32, 4}) {
      const std::string small = fmt::format("{}, capacity {}", dimension_text(dimension), capacity);
      for (const double neighbours :
           laboratory.either<std::vector<double>>({0.5, 2, 8, 32, 128}, {0.5, 2, 8, 32}))
        spanning.add(
            row_of(laboratory, {dimension, boxes, capacity, neighbours, usual_drift}, {small, neighbours}));
    }
  }
  return {depth, step, spanning};
}

/// A tree, from the boxes in the fewest leaves to those in the most.
struct Line {
  std::string tree;
  std::vector<std::pair<double, double>> gains;  ///< leaves a box, from the root over relative
  double until = 0;  ///< leaves a box from which on relative is not faster by the margin

  double fewest() const { return gains.front().second; }
  double most() const { return gains.back().second; }
  bool pays() const { return fewest() > 1 + margin; }
};

std::vector<std::pair<double, double>> gains_over(const Table& table, const std::string& x) {
  auto gains = table.points(x, "from the root over relative");
  if (gains.size() < 2)
    throw std::invalid_argument(
        fmt::format("table '{}': {} rows with both times; expected two a tree", table.name, gains.size()));
  std::ranges::sort(gains);
  return gains;
}

Line line_of(const Table& table, const std::string& tree) {
  Line line{.tree = tree, .gains = gains_over(table.where("tree", tree), "leaves a box")};
  std::vector<std::pair<double, double>> enough = line.gains;
  for (auto& [leaves, gain] : enough) gain = 1 + margin;
  line.until = crossover(line.gains, enough).value_or(line.gains.back().first);
  return line;
}

/// "2d_capacity_32" of "2D, capacity 32".
std::string figure_name(const std::string& tree) {
  std::string name;
  for (const char letter : tree) {
    if (letter == ' ') name += '_';
    if (letter != ' ' && letter != ',') name += letter == 'D' ? 'd' : letter;
  }
  return name;
}

Finding judge(const std::vector<Table>& tables) {
  const Table& depth = table_named(tables, "depth");
  const Table& step = table_named(tables, "step");
  const Table& spanning = table_named(tables, "spanning");
  std::vector<Line> lines;
  for (const std::string& tree : spanning.distinct_texts("tree")) lines.push_back(line_of(spanning, tree));
  if (lines.empty()) throw std::invalid_argument("table 'spanning' has no rows; expected two a tree");

  double until = INFINITY;
  for (const Line& line : lines) {
    if (line.pays()) until = std::min(until, line.until);
  }
  const auto fewest = std::ranges::minmax(lines, {}, &Line::fewest);
  const auto most = std::ranges::minmax(lines, {}, &Line::most);
  const double most_leaves = most.min.gains.back().first;
  const bool is_horrible = most.min.most() < 1 / (1 + margin);
  const std::string shallow = depth.distinct_texts("tree").at(0);
  const auto by_depth = gains_over(depth.where("tree", shallow), "boxes");
  const auto by_step = gains_over(step.where("tree", step.distinct_texts("tree").at(0)), "drift");

  Finding finding;
  if (std::ranges::none_of(lines, &Line::pays)) {
    finding.verdict = Verdict::does_not_hold;
  } else if (is_horrible) {
    finding.verdict = Verdict::holds;
  } else {
    finding.verdict = Verdict::holds_when;
    finding.condition = fmt::format(
        "boxes are in fewer than {:.1f} leaves on average; in more it gains nothing, but is not horrible",
        until);
  }
  finding.reason = fmt::format(
      "With boxes in {:.1f} leaves, filing a mover from where it was is {:.2f} times as fast as from the "
      "root "
      "({}), and from {:.2f} times in the tree that gains least ({}). With boxes in {:.1f} leaves it is "
      "{:.2f} "
      "times as fast ({}). Steps of {} of a box gain {:.2f} times, those of {} boxes {:.2f}. From {} to {} "
      "boxes the gain goes from {:.2f} to {:.2f} ({}): the way down grows, and so does all else.{}",
      fewest.max.gains.front().first, fewest.max.fewest(), fewest.max.tree, fewest.min.fewest(),
      fewest.min.tree, most_leaves, most.min.most(), most.min.tree, rounded(by_step.front().first),
      by_step.front().second, rounded(by_step.back().first), by_step.back().second,
      grouped(static_cast<std::uint64_t>(by_depth.front().first)),
      grouped(static_cast<std::uint64_t>(by_depth.back().first)), by_depth.front().second,
      by_depth.back().second, shallow,
      is_horrible
          ? ""
          : " Our tree climbs once, to the first node that holds all of the old and the new box: for a "
            "box in many leaves that is often the root. It does not carry each reference to a sibling "
            "by itself.");
  for (const Line& line : lines) {
    finding.figures.push_back({"gain_fewest_leaves_" + figure_name(line.tree), line.fewest()});
    finding.figures.push_back({"gain_most_leaves_" + figure_name(line.tree), line.most()});
  }
  finding.figures.insert(finding.figures.end(), {{"pays_below", std::isfinite(until) ? until : 0, "leaves"},
                                                 {"most_leaves", most_leaves, "leaves"},
                                                 {"gain_least_drift", by_step.front().second},
                                                 {"gain_greatest_drift", by_step.back().second},
                                                 {"gain_fewest_boxes", by_depth.front().second},
                                                 {"gain_most_boxes", by_depth.back().second}});
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
              "A mover of our quadtree, kept from frame to frame, on uniform boxes of which a tenth moves: "
              "filed anew from the root (update=root), or from its leaf up to the first node that holds its "
              "old and its new box and down from there (update=relative). By the number of boxes, by how far "
              "they go, and by how many leaves they are in.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

// Section V: unit-size boxes suit the quadtree; large ones propagate up to fourfold a level.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "lab/numbers.hpp"
#include "lab/scenes/random.hpp"
#include "lab/verify/verify.hpp"
#include "paper/experiments/descriptions.hpp"

namespace broadside::lab {
namespace {

/// A small box in each unit square of a world of side x side. None touches another or a square's border, so
/// that a tree over them has leaves of one size, which depends on the capacity alone.
std::vector<Box2> small_boxes(std::size_t side, Random& random) {
  std::vector<Box2> boxes;
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      const auto left = static_cast<float>(static_cast<double>(x) + random.between(0.01, 0.49));
      const auto top = static_cast<float>(static_cast<double>(y) + random.between(0.01, 0.49));
      boxes.push_back({{left, top}, {left + 0.5F, top + 0.5F}});
    }
  }
  return boxes;
}

/// A square box of `size`, anywhere in the world.
Box2 square_box(double size, std::size_t side, Random& random) {
  const double most = static_cast<double>(side) - size;
  const auto left = static_cast<float>(random.between(0, most));
  const auto top = static_cast<float>(random.between(0, most));
  const auto extent = static_cast<float>(size);
  return {{left, top}, {left + extent, top + extent}};
}

/// How many leaves the last of the boxes is in, by the references of a tree with and without it.
double leaves_of_last(Finder<2>& finder, const std::vector<Box2>& boxes) {
  std::vector<Pair> found;
  std::vector<Pair> expected;
  const auto last = BoxId(boxes.size() - 1);
  for (std::size_t i = 0; i + 1 < boxes.size(); ++i) {
    if (overlap(boxes[i], boxes.back())) expected.push_back({BoxId(i), last});
  }
  PairCollector collector(found);
  const Statistics statistics = finder.find(boxes, collector).value();
  if (const auto divergence = compare_pairs(found, expected))
    throw std::runtime_error("paper_quadtree: " + divergence->text);
  // Each of the small boxes is in one leaf.
  return static_cast<double>(statistics.references) - static_cast<double>(boxes.size() - 1);
}

Table measure_levels(const Laboratory& laboratory) {
  Table table{.name = "levels",
              .title = "Leaves that a box is in, by the depth of the tree (paper_quadtree)",
              .columns = {{"box"},
                          {"size", "units"},
                          {"levels"},
                          {"side of a leaf", "units"},
                          {"leaves"},
                          {"leaves over the level above"},
                          {"(1 + size / side)^2"}},
              .charts = {{.title = "Leaves of a box over the levels of the tree",
                          .x = "levels",
                          .y = "leaves",
                          .series = "box",
                          .log_y = true}}};
  const auto side = laboratory.either<std::size_t>(128, 64);
  const auto places = laboratory.either<std::size_t>(64, 24);
  Random random(1);
  std::vector<Box2> boxes = small_boxes(side, random);
  boxes.emplace_back();
  for (double size = 0.25; size <= static_cast<double>(side) / 2; size *= 4) {
    double above = 0;
    int levels = 2;
    for (std::size_t leaf = side / 4; leaf >= 1; leaf /= 2, ++levels) {
      laboratory.at(fmt::format("quadtree_sizes: a box of {} units in leaves of {}", size, leaf));
      // Two boxes for each that a leaf holds: another one does not make it split.
      Finder<2> finder(fmt::format("paper_quadtree:capacity={0}:left=0:top=0:width={1}:height={1}",
                                   2 * leaf * leaf, side));
      double leaves = 0;
      for (std::size_t place = 0; place < places; ++place) {
        Random there(1 + place);
        boxes.back() = square_box(size, side, there);
        leaves += leaves_of_last(finder, boxes) / static_cast<double>(places);
      }
      const auto length = static_cast<double>(leaf);
      table.add({fmt::format("{} units", size), size, static_cast<double>(levels), length, leaves,
                 above > 0 ? Cell(leaves / above) : Cell(), std::pow(1 + size / length, 2)});
      above = leaves;
    }
  }
  return table;
}

const std::string listing = "paper_quadtree";
const std::string own = "quadtree";
const std::vector<std::string> measured_ones = {listing, own, "paper_grid", "grid", "sweep_and_prune"};

Table measure_sizes(const Laboratory& laboratory) {
  Table table{.name = "sizes",
              .title = "One box in a hundred is large, the others are half a unit long, one a unit square",
              .columns = {{"size of a large box", "units"},
                          {"algorithm"},
                          {"boxes"},
                          {"pairs a box"},
                          {"tests a box"},
                          {"references a box"},
                          {"time", "ms"},
                          {"peak memory", "bytes"}},
              .charts = {log_log_chart("References over the size of the large boxes", "size of a large box",
                                       "references a box", "algorithm"),
                         log_log_chart("Time over the size of the large boxes", "size of a large box", "time",
                                       "algorithm")}};
  const auto side = laboratory.either<std::size_t>(100, 64);
  for (double size = 0.5; size <= 32; size *= 2) {
    const auto make = [size, side](const Settings&, std::size_t, std::uint64_t seed) {
      Random random(seed);
      std::vector<Box2> boxes = small_boxes(side, random);
      for (std::size_t i = 50; i < boxes.size(); i += 100) {
        // Where it stood, as far as the world goes.
        const double most = static_cast<double>(side) - size;
        const auto extent = static_cast<float>(size);
        for (int axis = 0; axis < 2; ++axis) {
          boxes[i].min[axis] = std::min(boxes[i].min[axis], static_cast<float>(most));
          boxes[i].max[axis] = boxes[i].min[axis] + extent;
        }
      }
      return boxes;
    };
    const Scene scene{.name = "large", .summary = {}, .source = {}, .boxes_2d = make, .fixed_count = true};
    const CaseResult result = laboratory.measure(list_of(measured_ones), scene, {.scene = "large"});
    const auto boxes = static_cast<double>(result.of.boxes);
    for (const Measurement& measured : result.measurements) {
      table.add({size, measured.algorithm, boxes,
                 measured.pairs ? Cell(static_cast<double>(*measured.pairs) / boxes) : Cell(),
                 over(tests_cell(measured), boxes), over(references_cell(measured), boxes),
                 time_cell(measured),
                 measured.peak_bytes ? Cell(static_cast<double>(*measured.peak_bytes)) : Cell()});
    }
  }
  return table;
}

std::vector<Table> measure(const Laboratory& laboratory) {
  return {measure_levels(laboratory), measure_sizes(laboratory)};
}

/// Of an algorithm: a column's last number over its first, the boxes growing in between.
double growth_over_sizes(const Table& sizes, const std::string& algorithm, std::string_view column) {
  const std::vector<double> numbers = sizes.where("algorithm", algorithm).numbers(column);
  if (numbers.size() < 2)
    throw std::invalid_argument(
        fmt::format("table 'sizes', column '{}': {} numbers of {}; expected 2 or more", column,
                    numbers.size(), algorithm));
  return numbers.back() / numbers.front();
}

/// The first size at which one box in a hundred doubles the references; the last one if none does.
double doubling_size(const Table& sizes) {
  const auto points = sizes.where("algorithm", listing).points("size of a large box", "references a box");
  for (const auto& [size, references] : points) {
    if (references >= 2 * points.front().second) return size;
  }
  return points.back().first;
}

/// Fourfold a level is what a box comes to that covers whole nodes; a box of a leaf's size stays well below.
constexpr double suits = 2.5;
constexpr double least_fourfold = 3;
constexpr double most_fourfold = 4.05;

/// So many times the references are a burden.
constexpr double burden = 2;

Finding judge(const std::vector<Table>& tables) {
  const Table& levels = table_named(tables, "levels");
  const Table& sizes = table_named(tables, "sizes");
  double largest_factor = 0;
  double unit_factor = 0;
  double most_leaves = 0;
  double unit_leaves = 0;
  double deviation = 0;
  for (const double size : levels.distinct_numbers("size")) {
    const Table rows = levels.where("size", size);
    for (const double factor : rows.numbers("leaves over the level above")) {
      largest_factor = std::max(largest_factor, factor);
      if (size <= 1) unit_factor = std::max(unit_factor, factor);
    }
    for (const auto& [leaves, expected] : rows.points("leaves", "(1 + size / side)^2")) {
      most_leaves = std::max(most_leaves, leaves);
      if (size <= 1) unit_leaves = std::max(unit_leaves, leaves);
      deviation = std::max(deviation, std::abs(leaves / expected - 1));
    }
  }
  if (!(largest_factor > 0) || !(unit_factor > 0))
    throw std::invalid_argument("table 'levels' has no two levels of a small and a large box; expected some");
  const double references = growth_over_sizes(sizes, listing, "references a box");
  const double own_references = growth_over_sizes(sizes, own, "references a box");
  const double time = growth_over_sizes(sizes, listing, "time");

  if (sizes.numbers("size of a large box").empty() ||
      sizes.where("algorithm", listing).numbers("pairs a box").empty())
    throw std::invalid_argument("table 'sizes' has no sizes or no pairs a box; expected both");

  const bool is_fourfold = largest_factor > least_fourfold && largest_factor < most_fourfold;
  const bool is_burden = references >= burden;
  Finding finding;
  finding.statements = {{.name = "unit_size",
                         .text = "boxes of a unit size suit the tree",
                         .verdict = unit_factor < suits ? Verdict::confirmed : Verdict::refuted,
                         .threshold = fmt::format("with a level more, a box of a unit or less is in fewer "
                                                  "than {} times as many leaves",
                                                  suits),
                         .evidence = {"factor_a_level_of_small_boxes"}},
                        {.name = "fourfold",
                         .text = "large boxes propagate up to fourfold with each level",
                         .verdict = is_fourfold ? Verdict::confirmed : Verdict::refuted,
                         .threshold = fmt::format("{} to {} times as many leaves a level, at most",
                                                  least_fourfold, most_fourfold),
                         .evidence = {"factor_a_level"}},
                        {.name = "book_keeping",
                         .text = "that adds unnecessary book keeping",
                         .verdict = is_burden ? Verdict::confirmed : Verdict::within_bounds,
                         .condition = is_burden ? "" : "more than one box in a hundred is large",
                         .threshold = fmt::format("the references grow {} times, or more", burden),
                         .evidence = {"references_growth", "own_references_growth", "time_growth"}}};
  finding.reason = fmt::format(
      "With each level a large box is in up to {:.2f} times as many leaves, one of a unit or less in up to "
      "{:.2f} times; a box s leaves long is in (1 + s)^2 of them. Where one box in a hundred grows from half "
      "a unit to {} units, the listing's references grow {:.1f} times and its time {:.1f} times; of the own "
      "quadtree, which keeps at a node what covers its middle, they grow {:.1f} times and {:.1f} times.",
      largest_factor, unit_factor, rounded(sizes.numbers("size of a large box").back()), references, time,
      own_references, growth_over_sizes(sizes, own, "time"));
  finding.figures = {
      {"factor_a_level", largest_factor},
      {"factor_a_level_of_small_boxes", unit_factor},
      {"most_leaves", most_leaves},
      {"most_leaves_of_small_boxes", unit_leaves},
      {"deviation_from_formula", 100 * deviation, "%"},
      {"references_growth", references},
      {"own_references_growth", own_references},
      {"time_growth", time},
      {"own_time_growth", growth_over_sizes(sizes, own, "time")},
      {"grid_time_growth", growth_over_sizes(sizes, "grid", "time")},
      {"sweep_time_growth", growth_over_sizes(sizes, "sweep_and_prune", "time")},
      {"pairs_a_box_at_largest", sizes.where("algorithm", listing).numbers("pairs a box").back()},
      {"memory_growth", growth_over_sizes(sizes, listing, "peak memory")},
      {"size_that_doubles_references", doubling_size(sizes), "units"}};
  return finding;
}

}  // namespace

Experiment quadtree_sizes() {
  return {.number = 7,
          .name = "quadtree_sizes",
          .title = "Large boxes fill a quadtree",
          .claim =
              "For Quad Trees ... the objects that should be placed in the nodes should have a unit size "
              "dimension ... This can be a problem when many objects with large dimensions are added to the "
              "tree such that they can propagate 4-fold for each height in the tree. This adds unnecessary "
              "book keeping for the Quad Tree.",
          .section = "V",
          .measured =
              "The leaves that one box of each size is in, in trees of known depth; then references, tests, "
              "time and memory as one box in a hundred becomes larger, 2D.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

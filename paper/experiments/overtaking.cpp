// Section II: each other algorithm is brute force on smaller collections, and overtakes it once these pay.
#include <algorithm>
#include <span>
#include <stdexcept>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

/// Algorithms that are compared with each other, and one of them that the others are to overtake.
struct Field {
  std::string table;
  std::string title;
  int dimension;
  std::string brute_force;
  std::vector<std::string> others;
};

const std::vector<Field>& fields() {
  static const std::vector<std::string> ours = {"grid", "sweep_and_prune", "quadtree", "bvh"};
  static const std::vector<Field> list = {{"paper",
                                           "The paper's algorithms, in 2D",
                                           2,
                                           "paper_brute_force",
                                           {"paper_grid", "paper_sweep_and_prune", "paper_quadtree"}},
                                          {"ours", "Our algorithms, in 2D", 2, "brute_force", ours},
                                          {"ours_3d", "Our algorithms, in 3D", 3, "brute_force", ours}};
  return list;
}

std::vector<Table> measure(const Laboratory& laboratory) {
  std::vector<Table> tables;
  for (const Field& field : fields()) {
    Table table{.name = field.table,
                .title = field.title + ": time and tests by the number of boxes",
                .columns = {{"boxes"}, {"algorithm"}, {"tests a box"}, {"time", "ms"}, {"time a box", "ns"}},
                .charts = {log_log_chart(field.title + ": time a box over the number of boxes", "boxes",
                                         "time a box", "algorithm"),
                           log_log_chart(field.title + ": tests a box over the number of boxes", "boxes",
                                         "tests a box", "algorithm")}};
    std::vector<std::string> algorithms = {field.brute_force};
    algorithms.insert(algorithms.end(), field.others.begin(), field.others.end());
    for (std::size_t boxes = 8; boxes <= laboratory.either<std::size_t>(8'192, 2'048); boxes *= 2) {
      const CaseResult result = laboratory.measure(
          list_of(algorithms), {.scene = "uniform", .dimension = field.dimension, .boxes = boxes});
      const auto n = static_cast<double>(boxes);
      for (const std::string& algorithm : algorithms) {
        const Measurement& measured = measurement_of(result, algorithm);
        if (!measured.statistics || measured.samples_ms.empty()) continue;
        const double time = median(measured.samples_ms);
        table.add({n, algorithm, static_cast<double>(measured.statistics->tests) / n, time, time / n * 1e6});
      }
    }
    tables.push_back(std::move(table));
  }
  return tables;
}

/// One algorithm against brute force.
struct Overtaking {
  std::string algorithm;
  double growth = 0;           ///< of its tests a box
  double most_tests = 0;       ///< a box, with the most boxes
  std::optional<double> from;  ///< boxes; empty: it never overtakes
};

struct FieldFinding {
  double growth = 0;  ///< of brute force's tests a box
  double most_boxes = 0;
  double most_tests = 0;
  std::vector<Overtaking> others{};
};

FieldFinding judge_field(const Field& field, const Table& table) {
  const auto rows_of = [&](const std::string& algorithm) {
    Table rows = table.where("algorithm", algorithm);
    if (rows.rows.size() < 3)
      throw std::invalid_argument(fmt::format("table '{}' has {} rows of {}; expected three at least",
                                              table.name, rows.rows.size(), algorithm));
    return rows;
  };
  const Table brute_force = rows_of(field.brute_force);
  FieldFinding finding{.growth = growth_of(brute_force.points("boxes", "tests a box")),
                       .most_boxes = brute_force.numbers("boxes").back(),
                       .most_tests = brute_force.numbers("tests a box").back()};
  for (const std::string& other : field.others) {
    const Table rows = rows_of(other);
    finding.others.push_back(
        {.algorithm = other,
         .growth = growth_of(rows.points("boxes", "tests a box")),
         .most_tests = rows.numbers("tests a box").back(),
         .from = crossover(rows.points("boxes", "time"), brute_force.points("boxes", "time"))});
  }
  return finding;
}

std::string crossovers_text(const FieldFinding& finding) {
  std::vector<std::string> parts;
  for (const Overtaking& other : finding.others) {
    const std::string from = other.from ? fmt::format("from {:.0f} on", *other.from) : std::string("never");
    parts.push_back(fmt::format("{} {}", other.algorithm, from));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<Figure> figures_of(const std::vector<FieldFinding>& found) {
  std::vector<Figure> figures;
  for (std::size_t i = 0; i < found.size(); ++i) {
    const bool is_paper = i == 0;
    for (const Overtaking& other : found[i].others) {
      const std::string name = other.algorithm + (fields()[i].dimension == 3 ? "_3d" : "");
      if (other.from) figures.push_back({name + "_from", *other.from, "boxes"});
      if (is_paper) figures.push_back({name + "_tests_growth", other.growth});
      if (is_paper) figures.push_back({name + "_tests_a_box", other.most_tests});
    }
  }
  return figures;
}

double last_time(const Table& table, const std::string& algorithm) {
  return table.where("algorithm", algorithm).numbers("time").back();
}

/// Tests a box grow with all boxes where collections do; this much less of the exponent is no chance, since
/// tests are counted.
constexpr double clearly = 0.25;

Finding judge(const std::vector<Table>& tables) {
  std::vector<FieldFinding> found;
  for (const Field& field : fields()) found.push_back(judge_field(field, table_named(tables, field.table)));

  const FieldFinding& paper = found[0];
  bool overtake = true;
  double from = 0;
  std::vector<std::string> smaller;
  std::vector<std::string> growths;
  for (const Overtaking& other : paper.others) {
    if (other.growth < paper.growth - clearly) smaller.push_back(other.algorithm);
    overtake = overtake && other.from;
    from = std::max(from, other.from.value_or(0));
    growths.push_back(fmt::format("{:.2f} ({})", other.growth, other.algorithm));
  }

  Finding finding;
  finding.figures = figures_of(found);
  Statement collections{.name = "collections",
                        .text =
                            "the collections of the other algorithms stay smaller as boxes are added (that "
                            "each is brute force on collections is a definition)",
                        .threshold = fmt::format("the exponent of tests a box over n is at least {} below "
                                                 "that of brute force, in each",
                                                 clearly),
                        .evidence = {"brute_force_tests_growth"}};
  for (const Overtaking& other : paper.others)
    collections.evidence.push_back(other.algorithm + "_tests_growth");
  if (smaller.size() == paper.others.size()) {
    collections.verdict = Verdict::confirmed;
  } else if (!smaller.empty()) {
    collections.verdict = Verdict::within_bounds;
    collections.condition = fmt::format("the algorithm is {}", fmt::join(smaller, " or "));
  }
  Statement overtaking{.name = "overtaking",
                       .text = "so they overtake brute force, as we read it, as boxes are added",
                       .threshold =
                           "each of the listings takes less time than brute force from some "
                           "number of boxes on"};
  if (overtake) {
    const bool is_always = from <= table_named(tables, "paper").numbers("boxes").front();
    overtaking.verdict = is_always ? Verdict::confirmed : Verdict::within_bounds;
    if (!is_always) overtaking.condition = fmt::format("there are more than about {:.0f} boxes", from);
    overtaking.evidence = {"all_from"};
  } else {
    overtaking.evidence = {"most_boxes"};
  }
  finding.statements = {collections,
                        {.name = "quadratic",
                         .text = "the tests of brute force grow quadratically with its collection",
                         .verdict = Verdict::not_testable,
                         .condition = "a tautology, as in claim 1",
                         .evidence = {"brute_force_tests_growth"}},
                        overtaking};
  const double faster = last_time(table_named(tables, "paper"), "paper_brute_force") /
                        last_time(table_named(tables, "ours"), "brute_force");
  finding.reason = fmt::format(
      "With the number of boxes, tests a box grow to the power {:.2f} in brute force, and {} in the others. "
      "In time they overtake it so: {}. Our brute force, with SIMD, is {:.1f} times as fast as the paper's; "
      "our others overtake it later, in 2D {}; in 3D {}.",
      paper.growth, fmt::join(growths, ", "), crossovers_text(paper), faster, crossovers_text(found[1]),
      crossovers_text(found[2]));
  if (overtake) finding.figures.push_back({"all_from", from, "boxes"});
  finding.figures.push_back({"most_boxes", paper.most_boxes, "boxes"});
  finding.figures.push_back({"brute_force_tests_growth", paper.growth});
  finding.figures.push_back({"brute_force_tests_a_box", paper.most_tests});
  finding.figures.push_back({"simd_brute_force_faster", faster});
  return finding;
}

}  // namespace

Experiment overtaking() {
  return {.number = 2,
          .name = "overtaking",
          .title = "The others are brute force on smaller collections",
          .claim =
              "The difference between the brute force algorithm and the other collision detection algorithms "
              "is how the other algorithms manage the size of the collection. ... when brute force is called "
              "the number of pairs of objects that need to be tested grow quadratically with respect to the "
              "size of the collection.",
          .section = "II",
          .measured =
              "Tests a box and time of the paper's algorithms in 2D and of ours in 2D and 3D, on uniform "
              "boxes from a handful on, and from how many boxes on each stays faster than brute force.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

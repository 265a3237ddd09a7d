// Beyond the draft: what makes the library's two fastest searches fast, each thing left out alone.
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "broadside/executor.hpp"

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/laboratory.hpp"
#include "paper/experiments/plain.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

/// A way to search, by its spec and by what it is called in the tables.
struct Way {
  std::string text;
  std::string spec;
};

/// A plain search's switches in the order in which they are left out one after the other.
struct Switch {
  std::string tunable;
  std::string without;  ///< what the search is called without it
};

const std::string all_at_once = "as the library has it";
const std::string plain = "plain, without SIMD";
const std::string nothing = "without all of these";

std::vector<Way> ways(const std::string& own, const std::vector<Switch>& switches, const std::string& peer) {
  std::vector<Way> all = {{all_at_once, own}};
  for (const std::string& set : instruction_sets()) {
    if (set != instruction_set())
      all.push_back({"by " + set, fmt::format("held_back:search={}:simd={}", own, set)});
  }
  const std::string name = "plain_" + own;
  all.push_back({plain, name});
  std::string together = name;
  for (const Switch& left_out : switches) {
    all.push_back({"and " + left_out.without, fmt::format("{}:{}=no", name, left_out.tunable)});
    together += fmt::format(":{}=no", left_out.tunable);
  }
  all.push_back({nothing, together});
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

/// What the columns of a dimension are called.
std::string time_in(int dimension) { return fmt::format("{}D", dimension); }
std::string ratio_in(int dimension) { return fmt::format("{}D ratio", dimension); }

Table measure_search(const Laboratory& laboratory, const Catalogue& catalogue, const std::string& own,
                     const std::vector<Way>& ways) {
  const auto boxes = laboratory.either<std::size_t>(100'000, 20'000);
  Table table{.name = own,
              .title = fmt::format("What makes {} fast, each thing left out alone: {} uniform boxes", own,
                                   grouped(boxes)),
              .columns = {{"search"}}};
  std::vector<std::string> specs;
  std::vector<std::vector<Cell>> rows;
  for (const Way& way : ways) {
    specs.push_back(way.spec);
    rows.push_back({way.text});
  }
  for (const int dimension : {2, 3}) {
    table.columns.push_back({time_in(dimension), "ms"});
    append(table.columns, ratio_columns(ratio_in(dimension)));
    table.charts.push_back({.title = fmt::format("Time over that of {} in {}D", own, dimension),
                            .kind = ChartKind::bars,
                            .x = "search",
                            .y = ratio_in(dimension),
                            .log_y = true});
    const CaseResult result = laboratory.measure(
        catalogue, list_of(specs), {.scene = "uniform", .dimension = dimension, .boxes = boxes});
    const Measurement& library = measurement_of(result, own);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const Measurement& measurement = measurement_of(result, specs[i]);
      rows[i].push_back(time_cell(measurement));
      append(rows[i], ratio_cells(result, measurement, library));
    }
  }
  for (std::vector<Cell>& row : rows) table.add(std::move(row));
  return table;
}

/// A peer that looks for one box after the other, without SIMD.
const std::string simple_peer = "boost_rtree";

std::vector<Table> measure(const Laboratory& laboratory) {
  Catalogue catalogue;
  for (Algorithm algorithm : {plain_grid(), plain_bvh(), held_back()}) catalogue.add(std::move(algorithm));
  const bool has_peer = find_algorithm(simple_peer, catalogue.algorithms()) != nullptr;
  const std::string peer = has_peer ? simple_peer : "";
  return {measure_search(laboratory, catalogue, "grid", ways_of_grid(peer)),
          measure_search(laboratory, catalogue, "bvh", ways_of_bvh(peer))};
}

/// The ratios of one search in one dimension.
class Ratios {
 public:
  Ratios(const Table& table, int dimension) : table_(table), column_(ratio_in(dimension)) {}

  /// The time over that of the library's. Throws std::invalid_argument if the table lacks it.
  double of(const std::string& search) const { return table_.where("search", search).number(column_); }

  bool has(const std::string& search) const {
    return !table_.where("search", search).numbers(column_).empty();
  }

  Figure figure(std::string name, const std::string& search) const {
    const Table row = table_.where("search", search);
    Figure figure{std::move(name), of(search)};
    const std::vector<double> low = row.numbers(column_ + " low");
    const std::vector<double> high = row.numbers(column_ + " high");
    if (!low.empty() && !high.empty()) figure.interval = Interval{low[0], high[0]};
    return figure;
  }

  /// The searches whose names begin so.
  std::vector<std::string> that_begin_with(std::string_view beginning) const {
    std::vector<std::string> searches = table_.distinct_texts("search");
    std::erase_if(searches, [&](const std::string& text) { return !text.starts_with(beginning); });
    return searches;
  }

  /// The one by the instruction set of the fewest lanes: the last.
  std::string without_simd() const {
    const std::vector<std::string> sets = that_begin_with("by ");
    if (sets.empty())
      throw std::invalid_argument(
          fmt::format("table '{}' has one instruction set; expected several", table_.name));
    return sets.back();
  }

 private:
  const Table& table_;
  std::string column_;
};

/// A text as the name of a figure.
std::string figure_name(std::string text) {
  std::ranges::replace_if(
      text, [](char c) { return c == ' ' || c == ':'; }, '_');
  return text;
}

Finding judge(const std::vector<Table>& tables) {
  Finding finding;
  Statement simd{.name = "simd", .text = "most of what these searches gain, they gain by SIMD"};
  std::vector<std::string> reasons;
  std::vector<std::string> mostly_simd;
  for (const std::string& own : {std::string("grid"), std::string("bvh")}) {
    const Table& table = table_named(tables, own);
    for (const int dimension : {2, 3}) {
      const Ratios ratios(table, dimension);
      const double without_simd = ratios.of(ratios.without_simd());
      const double without_all = ratios.of(nothing);
      if (!(without_all > 1))
        throw std::invalid_argument(
            fmt::format("table '{}': {} it takes {} times as long in {}D; expected more than 1", own, nothing,
                        without_all, dimension));
      // Gains multiply, so that their shares are of logarithms.
      const double share = std::log(without_simd) / std::log(without_all);
      const std::string search = fmt::format("{} in {}D", own, dimension);
      const std::string prefix = fmt::format("{}_{}d_", own, dimension);
      append(finding.figures,
             {ratios.figure(prefix + "without_simd", ratios.without_simd()),
              ratios.figure(prefix + "plain", plain), ratios.figure(prefix + "without_all", nothing),
              Figure{prefix + "share_of_simd", share}});
      for (const std::string& text : ratios.that_begin_with("and "))
        finding.figures.push_back({prefix + figure_name(text), ratios.of(text) / ratios.of(plain)});
      std::string reason = fmt::format("{} takes {:.1f} times as long without SIMD and {:.1f} times {}",
                                       search, without_simd, without_all, nothing);
      if (ratios.has(simple_peer)) {
        append(finding.figures,
               {ratios.figure(prefix + "boost", simple_peer),
                Figure{prefix + "boost_over_without_simd", ratios.of(simple_peer) / without_simd},
                Figure{prefix + "boost_over_without_all", ratios.of(simple_peer) / without_all}});
        reason += fmt::format(", Boost's tree {:.1f} times", ratios.of(simple_peer));
      }
      reasons.push_back(std::move(reason));
      simd.evidence.push_back(prefix + "share_of_simd");
      if (share > 0.5) mostly_simd.push_back(search);
    }
  }
  if (mostly_simd.size() == reasons.size()) {
    simd.verdict = Verdict::confirmed;
  } else if (!mostly_simd.empty()) {
    simd.verdict = Verdict::within_bounds;
    simd.condition = fmt::format("it is {}", fmt::join(mostly_simd, " or "));
  }
  finding.statements = {simd};
  finding.reason = fmt::format("On uniform boxes, {}.", fmt::join(reasons, "; "));
  return finding;
}

}  // namespace

Experiment ablation() {
  return {.number = 2,
          .name = "ablation",
          .title = "What makes the fastest searches fast",
          .claim =
              "Most of what the grid that carries boxes from cell to cell and the packed join gain, they "
              "gain by SIMD.",
          .section = "beyond",
          .measured =
              "grid and bvh with each instruction set that the processor has; the same algorithms written "
              "plainly, without SIMD, and then without one more thing each, and without all of them: the "
              "memory layout, output without branches, sorting by buckets, carrying boxes on (or joining "
              "the tree with itself), and choosing by a sample. Beside them Boost's R-tree.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

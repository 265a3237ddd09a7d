// Beyond the draft: what makes the library's two fastest searches fast, each thing left out alone.
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "paper/experiments/ablation_measure.hpp"
#include "paper/experiments/descriptions.hpp"

namespace broadside::lab {
namespace {

/// With what rows of a single switch began in results of a former version.
const std::string former_but = "and ";

/// The ratios of one search in one dimension.
class Ratios {
 public:
  Ratios(const Table& table, int dimension) : table_(table), column_(ablation_ratio(dimension)) {}

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

/// A ratio whose interval is known where both of its parts' are: as wide as they allow.
struct Bounded {
  double value = 0;
  std::optional<Interval> interval{};

  Figure figure(std::string name) const { return {std::move(name), value, "", interval}; }
};

/// By the table of shares, in which both ratios are of the same rounds; results of a former version have
/// none.
std::optional<Bounded> measured_share(const Table& row, const std::string& column) {
  const std::vector<double> value = row.numbers(column);
  if (value.empty()) return std::nullopt;
  const std::vector<double> low = row.numbers(column + " low");
  const std::vector<double> high = row.numbers(column + " high");
  if (low.empty() || high.empty()) return Bounded{value[0]};
  return Bounded{value[0], Interval{low[0], high[0]}};
}

Bounded quotient(const Figure& a, const Figure& b) {
  Bounded all{a.value / b.value};
  if (a.interval && b.interval)
    all.interval = Interval{a.interval->low / b.interval->high, a.interval->high / b.interval->low};
  return all;
}

/// Gains multiply, so that their shares are of logarithms.
Bounded share_of(const Figure& part, const Figure& whole) {
  Bounded share{std::log(part.value) / std::log(whole.value)};
  if (part.interval && whole.interval && whole.interval->low > 1)
    share.interval = Interval{std::log(part.interval->low) / std::log(whole.interval->high),
                              std::log(part.interval->high) / std::log(whole.interval->low)};
  return share;
}

/// The rows of a search in the table of shares, if there is one.
Table shares_of(const std::vector<Table>& tables, const std::string& own, const std::string& scene,
                int dimension) {
  const auto found = std::ranges::find(tables, std::string("shares"), &Table::name);
  const Table shares = found == tables.end() ? table_of_shares() : *found;
  return shares.where("search", own).where("scene", scene).where("dimension", fmt::format("{}D", dimension));
}

/// Most of the gain.
constexpr double most = 0.5;

/// What became of the claim in one search, on one scene and in one dimension.
struct Part {
  std::string text;
  std::optional<Interval> share{};

  bool is_most() const { return share && share->low > most; }
  bool is_less() const { return share && share->high < most; }
};

void judge_search(const std::vector<Table>& tables, const std::string& own, const std::string& scene,
                  Finding& finding, Statement& simd, std::vector<Part>& parts,
                  std::vector<std::string>& reasons) {
  const Table& table = table_named(tables, ablation_table(own, scene));
  for (const int dimension : {2, 3}) {
    const Ratios ratios(table, dimension);
    const std::string prefix = fmt::format("{}_{}d_", table.name, dimension);
    const Figure without_simd = ratios.figure(prefix + "without_simd", ratios.without_simd());
    const Figure without_all = ratios.figure(prefix + "without_all", ablation_nothing);
    const Figure written_plainly = ratios.figure(prefix + "plain", ablation_plain);
    if (!(without_all.value > 1))
      throw std::invalid_argument(
          fmt::format("table '{}': {} it takes {} times as long in {}D; expected more than 1", table.name,
                      ablation_nothing, without_all.value, dimension));
    const Table shares = shares_of(tables, own, scene, dimension);
    const Bounded share = measured_share(shares, simd_share).value_or(share_of(without_simd, without_all));
    const Bounded rest =
        measured_share(shares, rest_share)
            .value_or(share_of(quotient(without_all, written_plainly).figure(""), without_all));
    append(finding.figures,
           {without_simd, written_plainly, without_all, share.figure(prefix + "share_of_simd"),
            rest.figure(prefix + "share_of_the_rest"),
            quotient(written_plainly, without_simd).figure(prefix + "plain_over_without_simd"),
            quotient(without_all, written_plainly).figure(prefix + "without_all_over_plain")});
    for (const std::string& beginning : {ablation_but, former_but}) {
      for (const std::string& text : ratios.that_begin_with(beginning))
        finding.figures.push_back(quotient(ratios.figure("", text), written_plainly)
                                      .figure(prefix + "but_" + figure_name(text.substr(beginning.size()))));
    }
    const std::string search = fmt::format("{} on {} boxes in {}D", own, scene, dimension);
    std::string reason = fmt::format(
        "{} takes {:.1f} times as long without SIMD, {:.1f} times written plainly and {:.1f} times {}",
        search, without_simd.value, written_plainly.value, without_all.value, ablation_nothing);
    if (ratios.has(ablation_peer)) {
      const Figure boost = ratios.figure(prefix + "boost", ablation_peer);
      const auto over = [&](const std::string& column, const Figure& other) {
        return measured_share(shares, column).value_or(quotient(boost, other));
      };
      append(finding.figures,
             {boost, over(peer_over_without_simd, without_simd).figure(prefix + "boost_over_without_simd"),
              over(peer_over_without_all, without_all).figure(prefix + "boost_over_without_all")});
      reason += fmt::format(", Boost's tree {:.1f} times", boost.value);
    }
    reasons.push_back(std::move(reason));
    simd.evidence.push_back(prefix + "share_of_simd");
    parts.push_back({search, share.interval});
  }
}

std::string names_of(const std::vector<Part>& parts, bool (Part::*is)() const) {
  std::vector<std::string> names;
  for (const Part& part : parts) {
    if ((part.*is)()) names.push_back(part.text);
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

Finding judge(const std::vector<Table>& tables) {
  Finding finding;
  Statement simd{.name = "simd",
                 .text = "most of what these searches gain, they gain by SIMD",
                 .threshold = fmt::format("the interval of SIMD's share of the whole gain, by logarithms, is "
                                          "above {}",
                                          most)};
  std::vector<std::string> reasons;
  std::vector<Part> parts;
  for (const std::string& scene : ablation_scenes) {
    for (const std::string& own : {std::string("grid"), std::string("bvh")}) {
      // Results of a former version have one scene.
      const bool is_there =
          std::ranges::find(tables, ablation_table(own, scene), &Table::name) != tables.end();
      if (scene == ablation_scenes[0] || is_there)
        judge_search(tables, own, scene, finding, simd, parts, reasons);
    }
  }
  const auto how_many = [&](bool (Part::*is)() const) {
    return static_cast<std::size_t>(
        std::ranges::count_if(parts, [is](const Part& part) { return (part.*is)(); }));
  };
  const std::size_t confirmed = how_many(&Part::is_most);
  const std::size_t refuted = how_many(&Part::is_less);
  if (confirmed == parts.size()) {
    simd.verdict = Verdict::confirmed;
  } else if (confirmed > 0) {
    simd.verdict = Verdict::within_bounds;
    simd.condition = fmt::format("it is {}", names_of(parts, &Part::is_most));
    if (refuted > 0) simd.condition += fmt::format("; not {}", names_of(parts, &Part::is_less));
    if (confirmed + refuted < parts.size()) simd.condition += "; the others are open";
  } else if (refuted == 0) {
    simd.verdict = Verdict::not_testable;
    simd.condition = "each interval holds one half";
  }
  finding.statements = {simd};
  finding.figures.push_back({"confirmed_in", static_cast<double>(confirmed)});
  finding.figures.push_back({"refuted_in", static_cast<double>(refuted)});
  finding.figures.push_back({"parts", static_cast<double>(parts.size())});
  finding.reason = fmt::format("{}.", fmt::join(reasons, "; "));
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
              "once more, plainly and without SIMD, then without one thing each, the others left in, and "
              "without all of them: the "
              "memory layout, output without branches, sorting by buckets, carrying boxes on (or joining "
              "the tree with itself), and choosing by a sample. Beside them Boost's R-tree. On uniform and "
              "on clustered boxes.",
          .measure = measure_ablation,
          .judge = judge};
}

}  // namespace broadside::lab

// Section II: brute force takes n (n - 1) / 2 tests, since unique pairs halve n^2.
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

std::vector<Table> measure(const Laboratory& laboratory) {
  Table table{.name = "tests",
              .title = "Tests and time of the paper's brute force, by the number of boxes",
              .columns = {{"boxes"}, {"all pairs"}, {"unique pairs"}, {"tests"}, {"time", "ms"}},
              .charts = {log_log_chart("Time over the number of boxes", "boxes", "time")}};
  for (std::size_t boxes = 250; boxes <= laboratory.either<std::size_t>(16'000, 4'000); boxes *= 2) {
    const CaseResult result = laboratory.measure("paper_brute_force", {.scene = "uniform", .boxes = boxes});
    const Measurement& measured = measurement_of(result, "paper_brute_force");
    const auto n = static_cast<double>(boxes);
    table.add({n, n * n, n * (n - 1) / 2, tests_cell(measured), time_cell(measured)});
  }
  return {table};
}

/// How far an exponent may be from the one that is claimed.
constexpr double about = 0.2;

Finding judge(const std::vector<Table>& tables) {
  const Table& table = table_named(tables, "tests");
  std::size_t exact = 0;
  double share = 0;
  for (const auto& [unique, tests] : table.points("unique pairs", "tests")) exact += unique == tests ? 1 : 0;
  for (const auto& [all, tests] : table.points("all pairs", "tests")) share = tests / all;
  const auto times = table.points("boxes", "time");
  const double growth = growth_of(times);
  const std::vector<double> boxes = table.numbers("boxes");

  Finding finding;
  const bool is_exact = exact == table.rows.size() && std::abs(share - 0.5) < 0.01;
  finding.statements = {
      {.name = "unique_pairs",
       .text = "n items have n^2 pairs, of which about half are unique",
       .verdict = is_exact ? Verdict::not_testable : Verdict::refuted,
       .condition =
           is_exact ? "a tautology, n (n - 1) / 2 is what is meant by unique pairs; the count shows that the "
                      "mended listing tests these"
                    : "",
       .evidence = {"share_of_all_pairs"}},
      {.name = "quadratic",
       .text = "with unique pairs, too, the running time is quadratic",
       .verdict = std::abs(growth - 2) < about ? Verdict::confirmed : Verdict::refuted,
       .threshold = fmt::format("time grows as n to the power 2, give or take {}", about),
       .evidence = {"growth"}}};
  finding.reason = fmt::format(
      "{} of {} numbers of boxes took exactly n (n - 1) / 2 tests; with {} boxes that is {:.4f} of n^2, and "
      "time grows as n^{:.2f}.",
      exact, table.rows.size(), whole(boxes.back()), share, growth);
  finding.figures = {{"most_boxes", boxes.back(), "boxes"},
                     {"share_of_all_pairs", share},
                     {"growth", growth, "", growth_interval_of(times)}};
  return finding;
}

}  // namespace

Experiment brute_force_tests() {
  return {
      .number = 1,
      .name = "brute_force_tests",
      .title = "Brute force tests every unique pair",
      .claim =
          "To test all pairs of objects in a collection would require n^2 tests for n items in a "
          "collection. We can drop that amount by roughly half by only testing unique pairs of objects. "
          "... Even with the reduction, both methods result in a running time of O(n^2) for n objects in a "
          "collection.",
      .section = "II",
      .measured = "The tests that the mended Algorithm 1 counts, and its time, on uniform boxes in 2D.",
      .measure = measure,
      .judge = judge};
}

}  // namespace broadside::lab

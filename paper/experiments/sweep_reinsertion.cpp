// Section VI-C: k reinsertions by binary search, O(k lg n) or not, and the heap.
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/mending.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

const std::string nearby = "a fifth of their size";
const std::string anywhere = "anywhere";

Table measure_growth(const Laboratory& laboratory) {
  Table table{.name = "growth",
              .title = "One reinsertion into the paper's sweep by binary search, of 256 in a frame",
              .columns = {{"boxes go"}, {"boxes"}, {"comparisons"}, {"places moved"}, {"time", "ns"}},
              .charts = {log_log_chart("Time of one reinsertion over the number of boxes", "boxes", "time",
                                       "boxes go")}};
  constexpr double movers = 256;
  for (const std::string& go : {nearby, anywhere}) {
    for (std::size_t boxes = 1'000; boxes <= laboratory.either<std::size_t>(256'000, 64'000); boxes *= 4) {
      const auto count = static_cast<double>(boxes);
      const MendingCost cost = measure_mending<2>(laboratory, sweeps_by({"binary"}),
                                                  {.scene = "uniform",
                                                   .boxes = boxes,
                                                   .moving = movers / count,
                                                   .frames = laboratory.either<std::size_t>(10, 4),
                                                   .teleport = go == anywhere ? 1.0 : 0.0})
                                   .front();
      table.add({go, count, cost.visited, cost.moved, 1e6 * cost.structure_ms / movers});
    }
  }
  return table;
}

const std::vector<std::string> updates = {"binary", "insertion", "heap", "rebuild"};

Table measure_frames(const Laboratory& laboratory) {
  Table table{
      .name = "frames",
      .title = "Frames of the paper's sweep where k boxes move: uniform boxes in 2D",
      .columns =
          {{"boxes go"}, {"k"}, {"update"}, {"boxes"}, {"mending", "ms"}, {"sweeping", "ms"}, {"time", "ms"}},
      .charts = {log_log_chart("Time of mending where k boxes jump anywhere", "k", "mending", "update",
                               {{"boxes go", anywhere}}),
                 log_log_chart("Time of mending where k boxes go a fifth of their size", "k", "mending",
                               "update", {{"boxes go", nearby}})}};
  const auto boxes = laboratory.either<std::size_t>(20'000, 5'000);
  for (const std::string& go : {nearby, anywhere}) {
    for (std::size_t k = 1; k <= boxes; k *= 10) {
      const std::vector<MendingCost> costs =
          measure_mending<2>(laboratory, sweeps_by(updates),
                             {.scene = "uniform",
                              .boxes = boxes,
                              .moving = static_cast<double>(k) / static_cast<double>(boxes),
                              .frames = laboratory.either<std::size_t>(10, 4),
                              .teleport = go == anywhere ? 1.0 : 0.0});
      for (std::size_t i = 0; i < updates.size(); ++i)
        table.add({go, static_cast<double>(k), updates[i], static_cast<double>(boxes), costs[i].mending_ms,
                   costs[i].searching_ms, costs[i].frame_ms});
    }
  }
  return table;
}

std::vector<Table> measure(const Laboratory& laboratory) {
  return {measure_growth(laboratory), measure_frames(laboratory)};
}

/// The time at the first number of boxes of `rows`, as it would grow with the logarithm of that number.
std::vector<std::pair<double, double>> logarithmic(const std::vector<std::pair<double, double>>& rows) {
  std::vector<std::pair<double, double>> grown;
  for (const auto& [boxes, time] : rows)
    grown.emplace_back(boxes, rows.front().second * std::log(boxes) / std::log(rows.front().first));
  return grown;
}

/// The number of boxes from which on a reinsertion takes more than twice the time that the logarithm gives;
/// empty if it does not at the last.
std::optional<double> boxes_beyond_logarithm(const std::vector<std::pair<double, double>>& times) {
  auto twice = logarithmic(times);
  for (auto& [boxes, time] : twice) time *= 2;
  return crossover(twice, times);
}

/// Up to how many boxes that jump mending by `first` takes less than by `second`, as far as was measured.
double most_movers(const Table& frames, const std::string& first, const std::string& second) {
  std::vector<std::pair<double, double>> one;
  std::vector<std::pair<double, double>> other;
  const Table rows = frames.where("boxes go", anywhere);
  for (const double k : rows.distinct_numbers("k")) {
    const Table row = rows.where("k", k);
    const std::vector<double> here = row.where("update", first).numbers("mending");
    const std::vector<double> there = row.where("update", second).numbers("mending");
    if (here.empty() || there.empty()) continue;
    one.emplace_back(k, here[0]);
    other.emplace_back(k, there[0]);
  }
  const std::optional<double> end = crossover(other, one);
  return end.value_or(other.back().first);
}

/// The time of frames by a heap over that of frames by another update, where `k` boxes jump.
double heap_over(const Table& frames, double k, const std::string& update) {
  const Table rows = frames.where("boxes go", anywhere).where("k", k);
  return rows.where("update", "heap").number("time") / rows.where("update", update).number("time");
}

Finding judge(const std::vector<Table>& tables) {
  const Table& growth = table_named(tables, "growth");
  const Table& frames = table_named(tables, "frames");
  const Table far = growth.where("boxes go", anywhere);
  const auto far_times = far.points("boxes", "time");
  const auto near_times = growth.where("boxes go", nearby).points("boxes", "time");
  const double far_growth = growth_of(far_times);
  const double near_growth = growth_of(near_times);
  const std::optional<double> from = boxes_beyond_logarithm(far_times);
  const std::optional<double> near_from = boxes_beyond_logarithm(near_times);
  const auto [most, time] = far_times.back();
  const double beyond = time / logarithmic(far_times).back().second;
  const Table largest = far.where("boxes", most);
  const double comparisons = largest.number("comparisons") / 2;
  const std::vector<double> movers = frames.where("boxes go", anywhere).distinct_numbers("k");
  if (movers.empty())
    throw std::invalid_argument("table 'frames' has no boxes that jump; expected rows with some");
  const double heap_over_rebuild = heap_over(frames, movers.back(), "rebuild");
  const double heap_over_binary = heap_over(frames, movers.front(), "binary");

  Finding finding;
  finding.verdict = from ? Verdict::holds_when : Verdict::holds;
  if (from)
    finding.condition = fmt::format("there are fewer than about {} boxes{}", rounded(*from),
                                    near_from ? "" : ", or boxes stay near their places");
  finding.reason = fmt::format(
      "A search takes {:.1f} comparisons among {} boxes, as lg n does; but a box that jumps anywhere makes "
      "{} others give way, and its reinsertion takes {} times as long as lg n predicts. The time of one "
      "such reinsertion grows as n^{:.2f}, of boxes that go a fifth of their size as n^{:.2f}. By a heap, a "
      "frame in which one of {} boxes jumps takes {} times as long as by binary search, and one in which {} "
      "jump {:.2f} times as long as if all are sorted. Binary search mends the order faster than a sort of "
      "all boxes up to about {} boxes that jump.",
      comparisons, whole(most), whole(largest.number("places moved")), rounded(beyond), far_growth,
      near_growth, whole(frames.number("boxes")), rounded(heap_over_binary), whole(movers.back()),
      heap_over_rebuild, rounded(most_movers(frames, "binary", "rebuild")));
  finding.figures = {
      {"comparisons_a_search", comparisons},
      {"places_moved_anywhere", largest.number("places moved"), "places"},
      {"time_over_logarithm", beyond},
      {"growth_anywhere", far_growth},
      {"growth_nearby", near_growth},
      {"time_anywhere", time, "ns"},
      {"time_nearby", near_times.back().second, "ns"},
      {"boxes_beyond_logarithm", from.value_or(most), "boxes"},
      {"most_boxes", most, "boxes"},
      {"heap_frame_over_rebuild", heap_over_rebuild},
      {"heap_frame_over_binary", heap_over_binary},
      {"movers_up_to_which_binary_beats_insertion", most_movers(frames, "binary", "insertion"), "boxes"},
      {"movers_up_to_which_binary_beats_rebuild", most_movers(frames, "binary", "rebuild"), "boxes"}};
  return finding;
}

}  // namespace

Experiment sweep_reinsertion() {
  return {
      .number = 13,
      .name = "sweep_reinsertion",
      .title = "Reinsertion by binary search, and the heap",
      .claim =
          "For Sweep and Prune, the straight forward method would be to keep the objects in a heap and "
          "extract the minimum when needed. ... Inserting only a subset of k objects using an insertion "
          "sort with binary search would result in a worse case of O(k lg(n)) time, where each binary "
          "search would take O(lg(n)) time.",
      .section = "VI-C",
      .measured =
          "paper_sweep_and_prune: comparisons, places moved and time of one reinsertion by binary search "
          "(update=binary), over the number of boxes and how far they go; and frames over the number k of "
          "boxes that move, the kept order mended (update=binary, insertion or heap) or sorted anew "
          "(update=rebuild) and then swept once.",
      .measure = measure,
      .judge = judge};
}

}  // namespace broadside::lab

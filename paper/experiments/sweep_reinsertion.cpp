// Section VI-C: k reinsertions by binary search cost O(k lg n), or does moving the array dominate; and the
// heap.
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "lab/scenes/random.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/growth.hpp"
#include "paper/experiments/mending.hpp"
#include "paper/experiments/sweep_orders.hpp"

namespace broadside::lab {
namespace {

const std::string nearby = "a fifth of their size";
const std::string anywhere = "anywhere";

Table measure_growth(const Laboratory& laboratory) {
  Table table{.name = "growth",
              .title = "One reinsertion into a sorted array by binary search, of 256",
              .columns = {{"boxes go"},
                          {"boxes"},
                          {"comparisons"},
                          {"places moved"},
                          {"searching", "ns"},
                          {"moving", "ns"},
                          {"time", "ns"}},
              .charts = {log_log_chart("Time of one reinsertion over the number of boxes", "boxes", "time",
                                       "boxes go")}};
  constexpr std::size_t count = 256;
  const std::size_t times = laboratory.either<std::size_t>(21, 9);
  for (const bool is_near : {true, false}) {
    for (std::size_t boxes = 1'000; boxes <= laboratory.either<std::size_t>(1'024'000, 256'000); boxes *= 4) {
      laboratory.at(fmt::format("sweep_reinsertion: into {} boxes", boxes));
      Random random(1);
      const std::vector<SweptBox> order = order_of(boxes, random);
      const std::vector<Reinsertion> all = reinsertions(order, count, is_near, random);
      Work work;
      std::vector<SweptBox> moved;
      const double whole = sorting_ms(order, times, [&](std::vector<SweptBox>& some) {
        work = reinsert(some, all);
        std::swap(moved, some);
      });
      if (!std::is_sorted(moved.begin(), moved.end()))
        throw std::runtime_error("reinsertion: boxes out of order; expected them sorted");
      std::uint64_t seen = 0;
      const double searching = sorting_ms(
          order, times, [&](std::vector<SweptBox>& some) { seen += search_only(some, all).places; });
      if (seen == 0) throw std::runtime_error("reinsertion: no box goes anywhere; expected some");
      const auto each = [](double number) { return number / static_cast<double>(count); };
      const double total = each(whole * 1e6);
      const double search = std::min(total, each(searching * 1e6));
      table.add({is_near ? nearby : anywhere, static_cast<double>(boxes),
                 each(static_cast<double>(work.comparisons)), each(static_cast<double>(work.places)), search,
                 total - search, total});
    }
  }
  return table;
}

Table measure_heap(const Laboratory& laboratory) {
  Table table{.name = "heap",
              .title = "The whole order anew: from a heap, or sorted",
              .columns = {{"sort"}, {"boxes"}, {"time a box", "ns"}},
              .charts = {log_log_chart("Time of the whole order over the number of boxes", "boxes",
                                       "time a box", "sort")}};
  for (std::size_t boxes = 1'000; boxes <= laboratory.either<std::size_t>(256'000, 64'000); boxes *= 4) {
    laboratory.at(fmt::format("sweep_reinsertion: a heap of {} boxes", boxes));
    Random random(1);
    std::vector<SweptBox> mixed = order_of(boxes, random);
    const std::vector<SweptBox> sorted = mixed;
    random.shuffle(mixed, mixed.size());
    std::vector<SweptBox> space;
    const std::size_t times = laboratory.either<std::size_t>(11, 5);
    const auto a_box = [boxes](double milliseconds) {
      return milliseconds * 1e6 / static_cast<double>(boxes);
    };
    const auto count = static_cast<double>(boxes);
    const auto checked = [&sorted](const std::vector<SweptBox>& some) {
      if (some != sorted) throw std::runtime_error("sort: boxes out of order; expected them sorted");
    };
    std::vector<SweptBox> last;
    const double by_heap = sorting_ms(mixed, times, [&](std::vector<SweptBox>& some) {
      sort_by_heap(some, space);
      std::swap(last, some);
    });
    checked(last);
    const double by_sort = sorting_ms(mixed, times, [&](std::vector<SweptBox>& some) {
      std::sort(some.begin(), some.end());
      std::swap(last, some);
    });
    checked(last);
    table.add({"heap", count, a_box(by_heap)});
    table.add({"sort", count, a_box(by_sort)});
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
  std::vector<std::string> specs;
  for (const std::string& update : updates) specs.push_back("paper_sweep_and_prune:update=" + update);
  const auto boxes = laboratory.either<std::size_t>(20'000, 5'000);
  for (const std::string& go : {nearby, anywhere}) {
    for (std::size_t k = 1; k <= boxes; k *= 10) {
      const std::vector<MendingCost> costs =
          measure_mending<2>(laboratory, specs,
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
  return {measure_growth(laboratory), measure_heap(laboratory), measure_frames(laboratory)};
}

/// The number of boxes from which on moving takes longer than searching; empty if it does not at the last.
std::optional<double> boxes_from_which_moving_dominates(const Table& rows) {
  const auto searching = rows.points("boxes", "searching");
  auto moving = rows.points("boxes", "moving");
  // Moving is what is left of the time, which may be nothing; of that there is no logarithm.
  for (auto& [boxes, time] : moving) time = std::max(time, 1e-3);
  return crossover(searching, moving);
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

Finding judge(const std::vector<Table>& tables) {
  const Table& growth = table_named(tables, "growth");
  const Table& heap = table_named(tables, "heap");
  const Table& frames = table_named(tables, "frames");
  const Table far = growth.where("boxes go", anywhere);
  const Table near = growth.where("boxes go", nearby);
  const double far_growth = growth_of(far.points("boxes", "time"));
  const double near_growth = growth_of(near.points("boxes", "time"));
  const double search_growth = growth_of(far.points("boxes", "searching"));
  const std::optional<double> from = boxes_from_which_moving_dominates(far);
  const std::optional<double> near_from = boxes_from_which_moving_dominates(near);
  const std::vector<double> numbers = far.numbers("boxes");
  const double most = std::ranges::max(numbers);
  const Table largest = far.where("boxes", most);
  const double share = largest.number("moving") / largest.number("time");
  const double given_way = largest.number("places moved");
  const double comparisons = largest.number("comparisons") / 2;
  const auto heaped = heap.where("sort", "heap").points("boxes", "time a box");
  const auto sorted = heap.where("sort", "sort").points("boxes", "time a box");
  const Table few_jump = frames.where("boxes go", anywhere).where("k", frames.number("k"));
  const double heap_frame = few_jump.where("update", "heap").number("time");
  const double binary_frame = few_jump.where("update", "binary").number("time");
  if (heaped.empty() || sorted.empty())
    throw std::invalid_argument("table 'heap' has no times of heap and sort; expected some");

  Finding finding;
  const bool is_few = from && *from > std::ranges::min(numbers);
  if (!from) {
    finding.verdict = Verdict::holds;
  } else if (is_few || !near_from) {
    finding.verdict = Verdict::holds_when;
    const std::string few = is_few ? fmt::format("there are fewer than about {} boxes", rounded(*from)) : "";
    const std::string close = near_from ? "" : "boxes stay near their places";
    finding.condition = few + (few.empty() || close.empty() ? "" : ", or ") + close;
  } else {
    finding.verdict = Verdict::does_not_hold;
  }
  finding.reason = fmt::format(
      "A search takes {:.1f} comparisons among {} boxes, as lg n does; but a box that jumps anywhere makes "
      "{} others give way, and moving them is {:.0f} % of its time. The time of one such reinsertion grows "
      "as n^{:.2f}, of boxes that go a fifth of their size as n^{:.2f}. A heap takes {:.2f} times as long as "
      "a sort of {} boxes, and a frame in which one of {} jumps {} times as long by a heap as by binary "
      "search. "
      "Binary search mends the order faster than a sort of all boxes up to about {} boxes that jump.",
      comparisons, whole(most), whole(given_way), 100 * share, far_growth, near_growth,
      heaped.back().second / sorted.back().second, whole(heaped.back().first), whole(frames.number("boxes")),
      rounded(heap_frame / binary_frame), rounded(most_movers(frames, "binary", "rebuild")));
  finding.figures = {
      {"comparisons_a_search", comparisons},
      {"places_moved_anywhere", largest.number("places moved"), "places"},
      {"share_of_moving", 100 * share, "%"},
      {"growth_anywhere", far_growth},
      {"growth_nearby", near_growth},
      {"growth_of_searching", search_growth},
      {"time_anywhere", largest.number("time"), "ns"},
      {"time_nearby", near.where("boxes", most).number("time"), "ns"},
      {"boxes_from_which_moving_dominates", from.value_or(most), "boxes"},
      {"most_boxes", most, "boxes"},
      {"heap_over_sort", heaped.back().second / sorted.back().second},
      {"heap_frame_over_binary", heap_frame / binary_frame},
      {"movers_up_to_which_binary_beats_insertion", most_movers(frames, "binary", "insertion"), "boxes"},
      {"movers_up_to_which_binary_beats_rebuild", most_movers(frames, "binary", "rebuild"), "boxes"}};
  return finding;
}

}  // namespace

Experiment sweep_reinsertion() {
  return {.number = 13,
          .name = "sweep_reinsertion",
          .title = "Reinsertion by binary search, and the heap",
          .claim =
              "For Sweep and Prune, the straight forward method would be to keep the objects in a heap and "
              "extract the minimum when needed. ... Inserting only a subset of k objects using an insertion "
              "sort with binary search would result in a worse case of O(k lg(n)) time, where each binary "
              "search would take O(lg(n)) time.",
          .section = "VI-C",
          .measured =
              "Comparisons, places moved and time of reinserting boxes into a sorted array, over its length "
              "and how far they go; a heap against a sort; and frames of paper_sweep_and_prune over k, its "
              "kept order mended "
              "(update=binary, insertion or heap) or sorted anew (update=rebuild) and swept once.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

// Section VI-C: insertion sort is linear when order is nearly kept; how far may it be disturbed?
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "paper/experiments/boxes.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/growth.hpp"
#include "paper/experiments/mending.hpp"
#include "paper/experiments/sweep_orders.hpp"

namespace broadside::lab {
namespace {

const std::string insertion = "insertion";
const std::string anew = "sort anew";
const std::string heap = "heap";

/// What came of one step of all boxes, for their order along an axis.
struct Disturbance {
  double places_a_box = 0;
  double insertion_ms = 0;
  double anew_ms = 0;
  double heap_ms = 0;
};

template <int D>
Disturbance disturb(const std::string& scene, int axis, const SceneRequest& request, std::size_t times) {
  const History<D> history = history_of<D>(scene, request);
  std::vector<SweptBox> order;
  for (std::uint32_t i = 0; i < history.boxes.size(); ++i) order.push_back({history.boxes[i].min[axis], i});
  std::sort(order.begin(), order.end());
  std::vector<Box<D>> boxes = history.boxes;
  apply(history.steps.at(0), boxes);
  for (SweptBox& box : order) box.min = boxes[box.id].min[axis];

  std::vector<SweptBox> expected = order;
  std::sort(expected.begin(), expected.end());
  std::vector<SweptBox> space;
  Disturbance found;
  const auto check = [&expected](const std::vector<SweptBox>& sorted, const std::string& by) {
    if (sorted != expected) throw std::runtime_error(by + ": boxes out of order; expected them sorted");
  };
  found.insertion_ms = sorting_ms(order, times, [&](std::vector<SweptBox>& some) {
    found.places_a_box = static_cast<double>(sort_by_insertion(some)) / static_cast<double>(some.size());
  });
  found.anew_ms =
      sorting_ms(order, times, [](std::vector<SweptBox>& some) { std::sort(some.begin(), some.end()); });
  found.heap_ms = sorting_ms(order, times, [&](std::vector<SweptBox>& some) { sort_by_heap(some, space); });
  std::vector<SweptBox> sorted = order;
  sort_by_insertion(sorted);
  check(sorted, insertion);
  sorted = order;
  sort_by_heap(sorted, space);
  check(sorted, heap);
  return found;
}

/// How far all boxes go in a frame, in their own sizes; the last motion is a jump anywhere.
struct Motion {
  std::string text;
  double drift = 0;
  double teleport = 0;
};

std::vector<Motion> motions() {
  std::vector<Motion> all;
  for (const double drift : {0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0})
    all.push_back({fmt::format("{} sizes", drift), drift});
  all.push_back({"anywhere", 1, 1});
  return all;
}

Table measure_sorting(const Laboratory& laboratory) {
  Table table{.name = "sorting",
              .title = "Mending a sweep's order where all boxes move: uniform boxes in 2D",
              .columns = {{"motion"}, {"sort"}, {"boxes"}, {"places moved a box"}, {"time a box", "ns"}},
              .charts = {log_log_chart("Time to mend the order over how far it is disturbed",
                                       "places moved a box", "time a box", "sort")}};
  const auto boxes = laboratory.either<std::size_t>(10'000, 4'000);
  for (const Motion& motion : motions()) {
    laboratory.at("sweep_insertion: sorting, " + motion.text);
    const Disturbance found = disturb<2>(
        "uniform", 0,
        {.boxes = boxes, .frames = 1, .moving = 1, .drift = motion.drift, .teleport = motion.teleport},
        laboratory.either<std::size_t>(21, 9));
    const auto count = static_cast<double>(boxes);
    const auto add = [&](const std::string& sort, double milliseconds) {
      table.add({motion.text, sort, count, found.places_a_box, milliseconds * 1e6 / count});
    };
    add(insertion, found.insertion_ms);
    add(anew, found.anew_ms);
    add(heap, found.heap_ms);
  }
  return table;
}

/// A world in which a sweep meets boxes along its axis: as many a length in a corridor, more in a plane.
struct World {
  std::string text;
  std::string scene;
  int dimension;
  int axis;
};

const std::string corridor = "corridor";
const std::string plane = "plane";
const std::string space = "space";

Table measure_growth(const Laboratory& laboratory) {
  Table table{.name = "growth",
              .title = "Mending a sweep's order where all boxes go a tenth of their size",
              .columns = {{"world"},
                          {"boxes"},
                          {"places moved a box"},
                          {"places moved"},
                          {"insertion", "ms"},
                          {"sort anew", "ms"}},
              .charts = {log_log_chart("Places moved a box over the number of boxes", "boxes",
                                       "places moved a box", "world"),
                         log_log_chart("Time of insertion sort over the number of boxes", "boxes",
                                       "insertion", "world")}};
  const std::vector<World> worlds = {
      {corridor, "one_line", 2, 1}, {plane, "uniform", 2, 0}, {space, "uniform", 3, 0}};
  for (const World& world : worlds) {
    for (std::size_t boxes = 1'000; boxes <= laboratory.either<std::size_t>(256'000, 64'000); boxes *= 4) {
      laboratory.at(fmt::format("sweep_insertion: {} of {} boxes", world.text, boxes));
      const SceneRequest request{.boxes = boxes, .frames = 1, .moving = 1, .drift = 0.1};
      const std::size_t times = laboratory.either<std::size_t>(11, 5);
      const Disturbance found = world.dimension == 2 ? disturb<2>(world.scene, world.axis, request, times)
                                                     : disturb<3>(world.scene, world.axis, request, times);
      const auto count = static_cast<double>(boxes);
      table.add({world.text, count, found.places_a_box, found.places_a_box * count, found.insertion_ms,
                 found.anew_ms});
    }
  }
  return table;
}

const std::vector<std::string> updates = {"insertion", "heap", "binary", "rebuild"};

Table measure_frames(const Laboratory& laboratory, const Table& sorting) {
  Table table{.name = "frames",
              .title = "Frames of the paper's sweep where all boxes move: uniform boxes in 2D",
              .columns = {{"motion"},
                          {"update"},
                          {"boxes"},
                          {"places moved a box"},
                          {"mending", "ms"},
                          {"sweeping", "ms"},
                          {"time", "ms"}},
              .charts = {log_log_chart("Time of a frame over how far the order is disturbed",
                                       "places moved a box", "time", "update")}};
  std::vector<std::string> specs;
  for (const std::string& update : updates) specs.push_back("paper_sweep_and_prune:update=" + update);
  const auto boxes = laboratory.either<std::size_t>(10'000, 4'000);
  for (const Motion& motion : motions()) {
    const std::vector<MendingCost> costs =
        measure_mending<2>(laboratory, specs,
                           {.scene = "uniform",
                            .boxes = boxes,
                            .moving = 1,
                            .frames = laboratory.either<std::size_t>(10, 4),
                            .drift = motion.drift,
                            .teleport = motion.teleport});
    const double places = sorting.where("motion", motion.text).number("places moved a box");
    for (std::size_t i = 0; i < updates.size(); ++i)
      table.add({motion.text, updates[i], static_cast<double>(boxes), places, costs[i].mending_ms,
                 costs[i].searching_ms, costs[i].frame_ms});
  }
  return table;
}

std::vector<Table> measure(const Laboratory& laboratory) {
  Table sorting = measure_sorting(laboratory);
  Table frames = measure_frames(laboratory, sorting);
  return {std::move(sorting), measure_growth(laboratory), std::move(frames)};
}

/// How a sort's time a box goes with the places moved.
std::vector<std::pair<double, double>> line(const Table& sorting, const std::string& sort) {
  auto points = sorting.where("sort", sort).points("places moved a box", "time a box");
  std::erase_if(points, [](const auto& point) { return !(point.first > 0); });
  std::ranges::sort(points);
  return points;
}

/// Of whole frames: the least and the most time of insertion over that of another update.
std::pair<double, double> ratios(const Table& frames, const std::string& other) {
  double least = INFINITY;
  double most = 0;
  for (const std::string& motion : frames.distinct_texts("motion")) {
    const Table rows = frames.where("motion", motion);
    const std::vector<double> first = rows.where("update", insertion).numbers("time");
    const std::vector<double> second = rows.where("update", other).numbers("time");
    if (first.empty() || second.empty()) continue;
    least = std::min(least, first[0] / second[0]);
    most = std::max(most, first[0] / second[0]);
  }
  if (most == 0) throw std::invalid_argument("table 'frames' has no times of insertion and " + other);
  return {least, most};
}

Finding judge(const std::vector<Table>& tables) {
  const Table& sorting = table_named(tables, "sorting");
  const Table& growth = table_named(tables, "growth");
  const Table& frames = table_named(tables, "frames");
  const auto grows = [&growth](const std::string& world, std::string_view column) {
    return growth_of(growth.where("world", world).points("boxes", column));
  };
  const double in_corridor = grows(corridor, "places moved");
  const double in_plane = grows(plane, "places moved");
  const double in_space = grows(space, "places moved");
  const auto inserted = line(sorting, insertion);
  const auto sorted = line(sorting, anew);
  const auto heaped = line(sorting, heap);
  if (inserted.empty() || sorted.empty() || heaped.empty())
    throw std::invalid_argument("table 'sorting' lacks a sort; expected insertion, sort anew and heap");
  const std::optional<double> limit = crossover(sorted, inserted);
  const bool is_ahead = inserted.front().second < sorted.front().second;
  // From where a box passes one other, its time grows with them.
  const double gain = sorted.front().second / inserted.front().second;
  const double loss = inserted.back().second / sorted.back().second;
  const auto [least_over_heap, most_over_heap] = ratios(frames, heap);
  const auto [least_over_rebuild, most_over_rebuild] = ratios(frames, "rebuild");
  constexpr double linear = 1.15;

  Finding finding;
  if (in_corridor > linear || !is_ahead) {
    finding.verdict = Verdict::does_not_hold;
  } else if (in_plane <= linear && in_space <= linear && !limit) {
    finding.verdict = Verdict::holds;
  } else {
    finding.verdict = Verdict::holds_when;
    finding.condition =
        limit ? fmt::format("a box passes fewer than about {} others a frame, however many boxes there are",
                            rounded(*limit))
              : "a box passes as many others a frame, however many boxes there are";
  }
  const std::vector<double> passed = growth.where("world", plane).numbers("places moved a box");
  if (passed.empty()) throw std::invalid_argument("table 'growth' has no places moved a box; expected some");
  finding.reason = fmt::format(
      "The places that boxes move grow as n^{:.2f} in a corridor, where as many boxes stand along each "
      "length, but as n^{:.2f} in a plane and n^{:.2f} in space, although all go only a tenth of their size: "
      "there a sweep's axis passes ever more boxes. Where boxes pass {} others, insertion is {:.1f} times as "
      "fast as sorting anew, where they jump anywhere {} times as slow. Whole frames by insertion take "
      "{:.2f} to {} times those by a heap and {:.2f} to {} times those that sort anew.",
      in_corridor, in_plane, in_space, rounded(inserted.front().first), gain, rounded(loss), least_over_heap,
      rounded(most_over_heap), least_over_rebuild, rounded(most_over_rebuild));
  finding.figures = {{"growth_in_corridor", in_corridor},
                     {"growth_in_plane", in_plane},
                     {"growth_in_space", in_space},
                     {"time_growth_in_corridor", grows(corridor, "insertion")},
                     {"time_growth_in_plane", grows(plane, "insertion")},
                     {"time_growth_in_space", grows(space, "insertion")},
                     {"places_moved_in_largest_plane", passed.back(), "places a box"},
                     {"gain_over_sorting", gain},
                     {"loss_where_boxes_jump", loss},
                     {"heap_over_sorting", heaped.front().second / sorted.front().second},
                     {"least_frame_over_heap", least_over_heap},
                     {"most_frame_over_heap", most_over_heap},
                     {"least_frame_over_rebuild", least_over_rebuild},
                     {"most_frame_over_rebuild", most_over_rebuild},
                     {"places_up_to_which_it_pays", limit.value_or(inserted.back().first), "places a box"}};
  return finding;
}

}  // namespace

Experiment sweep_insertion() {
  return {.number = 12,
          .name = "sweep_insertion",
          .title = "Insertion sort and an order that is nearly kept",
          .claim =
              "The improved method would make reinserting objects only takes O(n) using insertion sort if "
              "objects in the collection are relatively in order.",
          .section = "VI-C",
          .measured =
              "By how many places boxes move in a sweep's order and what sorting takes, over how far they go "
              "and over their number in a corridor, a plane and in space; then frames of "
              "paper_sweep_and_prune, whose kept "
              "order is mended (update=insertion, heap or binary) or sorted anew (update=rebuild) and swept "
              "once.",
          .measure = measure,
          .judge = judge};
}

}  // namespace broadside::lab

// Section VI-C: insertion sort is linear when order is nearly kept; how far may it be disturbed?
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lab/numbers.hpp"
#include "paper/experiments/descriptions.hpp"
#include "paper/experiments/laboratory.hpp"
#include "paper/experiments/mending.hpp"
#include "paper/experiments/table.hpp"

namespace broadside::lab {
namespace {

const std::string insertion = "insertion";
const std::string rebuild = "rebuild";
const std::string heap = "heap";

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

const std::string corridor = "corridor";
const std::string plane = "plane";
const std::string space = "space";

/// Boxes that all go a tenth of their size.
template <int D>
History<D> drifting(const std::string& scene, std::size_t boxes) {
  return history_of<D>(scene, {.boxes = boxes, .frames = 4, .moving = 1, .drift = 0.1});
}

/// Boxes along the x axis: each length of it holds as many, however many boxes there are.
History<2> along_x(std::size_t boxes) {
  History<2> history = drifting<2>("one_line", boxes);  // along y
  const auto turn = [](Box2& box) {
    std::swap(box.min[0], box.min[1]);
    std::swap(box.max[0], box.max[1]);
  };
  std::ranges::for_each(history.boxes, turn);
  for (Step<2>& step : history.steps) std::ranges::for_each(step.boxes, turn);
  return history;
}

/// Insertion and rebuild, in that order.
std::vector<MendingCost> measure_world(const Laboratory& laboratory, const std::string& world,
                                       std::size_t boxes) {
  const std::vector<std::string> specs = sweeps_by({insertion, rebuild});
  if (world == space) return measure_mending<3>(laboratory, specs, world, drifting<3>("uniform", boxes));
  return measure_mending<2>(laboratory, specs, world,
                            world == plane ? drifting<2>("uniform", boxes) : along_x(boxes));
}

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
  for (const std::string& world : {corridor, plane, space}) {
    for (std::size_t boxes = 1'000; boxes <= laboratory.either<std::size_t>(64'000, 16'000); boxes *= 4) {
      const std::vector<MendingCost> costs = measure_world(laboratory, world, boxes);
      const auto count = static_cast<double>(boxes);
      table.add({world, count, costs[0].moved, costs[0].moved * count, costs[0].mending.median(),
                 costs[1].mending.median()});
    }
  }
  return table;
}

const std::vector<std::string> updates = {insertion, heap, "binary", rebuild};

Table measure_frames(const Laboratory& laboratory) {
  Table table{.name = "frames",
              .title = "Frames of the paper's sweep where all boxes move: uniform boxes in 2D",
              .columns = {{"motion"},
                          {"update"},
                          {"boxes"},
                          {"places moved a box"},
                          {"detecting", "ms"},
                          {"mending", "ms"},
                          {"sweeping", "ms"},
                          {"time", "ms"}},
              .charts = {log_log_chart("Time of mending over how far the order is disturbed",
                                       "places moved a box", "mending", "update"),
                         log_log_chart("Time of a frame over how far the order is disturbed",
                                       "places moved a box", "time", "update")}};
  append(table.columns, ratio_columns("insertion's frame over this"));
  const auto boxes = laboratory.either<std::size_t>(10'000, 4'000);
  for (const Motion& motion : motions()) {
    const std::vector<MendingCost> costs =
        measure_mending<2>(laboratory, sweeps_by(updates),
                           {.scene = "uniform",
                            .boxes = boxes,
                            .moving = 1,
                            .frames = laboratory.either<std::size_t>(10, 4),
                            .drift = motion.drift,
                            .teleport = motion.teleport});
    for (std::size_t i = 0; i < updates.size(); ++i) {
      std::vector<Cell> row = {motion.text,
                               updates[i],
                               static_cast<double>(boxes),
                               costs[0].moved,
                               costs[i].detecting.median(),
                               costs[i].mending.median(),
                               costs[i].searching.median(),
                               costs[i].frame.median()};
      append(row, ratio_cells(costs[0].frame, costs[i].frame));
      table.add(std::move(row));
    }
  }
  return table;
}

std::vector<Table> measure(const Laboratory& laboratory) {
  return {measure_growth(laboratory), measure_frames(laboratory)};
}

/// The time of mending by an update over the places moved.
std::vector<std::pair<double, double>> mending_by(const Table& frames, const std::string& update) {
  auto points = frames.where("update", update).points("places moved a box", "mending");
  std::erase_if(points, [](const auto& point) { return !(point.first > 0); });
  std::ranges::sort(points);
  return points;
}

/// Of whole frames: the time of insertion over that of another update, by the places moved a box.
std::vector<RatioAt> frames_over(const Table& frames, const std::string& other) {
  return ratios_over(frames.where("update", other), "places moved a box", "insertion's frame over this");
}

Finding judge(const std::vector<Table>& tables) {
  const Table& growth = table_named(tables, "growth");
  const Table& frames = table_named(tables, "frames");
  const auto grows = [&growth](const std::string& world, std::string_view column) {
    return growth_of(growth.where("world", world).points("boxes", column));
  };
  const auto fit = [&growth](const std::string& world) {
    return growth_interval_of(growth.where("world", world).points("boxes", "places moved"));
  };
  const double in_corridor = grows(corridor, "places moved");
  const double in_plane = grows(plane, "places moved");
  const double in_space = grows(space, "places moved");
  const auto inserted = mending_by(frames, insertion);
  const auto sorted = mending_by(frames, rebuild);
  if (inserted.empty() || sorted.empty())
    throw std::invalid_argument("table 'frames' lacks times of mending; expected insertion's and rebuild's");
  const std::optional<double> limit = crossover(sorted, inserted);
  // From where a box passes one other, its time grows with them.
  const double gain = sorted.front().second / inserted.front().second;
  const double loss = inserted.back().second / sorted.back().second;
  const std::vector<RatioAt> over_heap = frames_over(frames, heap);
  const std::vector<RatioAt> over_rebuild = frames_over(frames, rebuild);
  const auto [least_over_heap, most_over_heap] = std::ranges::minmax(over_heap, {}, &RatioAt::ratio);
  const auto [least_over_rebuild, most_over_rebuild] = std::ranges::minmax(over_rebuild, {}, &RatioAt::ratio);
  constexpr double linear = 1.15;

  Finding finding;
  Statement linear_time{.name = "linear",
                        .text = "insertion sort mends an order that is nearly kept in O(n)",
                        .threshold = fmt::format("places moved grow as n to the power {} at most", linear),
                        .evidence = {"growth_in_corridor", "growth_in_plane", "growth_in_space"}};
  if (in_plane <= linear && in_space <= linear && in_corridor <= linear) {
    linear_time.verdict = Verdict::confirmed;
  } else if (in_corridor <= linear) {
    linear_time.verdict = Verdict::within_bounds;
    linear_time.condition =
        "the number of others that a box passes in a frame does not grow with the number of boxes";
  }
  Statement improved{.name = "improved",
                     .text = "that improves on keeping the objects in a heap",
                     .threshold = "a frame takes less time than by a heap, beyond noise",
                     .evidence = {"least_frame_over_heap", "most_frame_over_heap"}};
  const Crossing lost = rises_above(1, over_heap);
  if (std::ranges::none_of(over_heap, [](const RatioAt& at) { return at.is_above(1); }) &&
      over_heap.front().is_below(1)) {
    improved.verdict = Verdict::confirmed;
  } else if (over_heap.front().is_below(1) && lost.at) {
    improved.verdict = Verdict::within_bounds;
    improved.condition = fmt::format("a box passes fewer than about {} others a frame", rounded(*lost.at));
    improved.evidence.emplace_back("places_up_to_which_it_beats_the_heap");
    finding.figures.push_back({"places_up_to_which_it_beats_the_heap", *lost.at, "places a box",
                               lost.interval(over_heap.back().x)});
  }
  finding.statements = {linear_time, improved};
  const std::vector<double> passed = growth.where("world", plane).numbers("places moved a box");
  if (passed.empty()) throw std::invalid_argument("table 'growth' has no places moved a box; expected some");
  finding.reason = fmt::format(
      "The places that boxes move grow as n^{:.2f} in a corridor, where as many boxes stand along each "
      "length, but as n^{:.2f} in a plane and n^{:.2f} in space, although all go only a tenth of their size: "
      "there a sweep's axis passes ever more boxes. Where boxes pass {} others, insertion is {:.1f} times as "
      "fast as sorting anew, where they jump anywhere {} times as slow. Whole frames by insertion take "
      "{:.2f} to {} times those by a heap and {:.2f} to {} times those that sort anew.",
      in_corridor, in_plane, in_space, rounded(inserted.front().first), gain, rounded(loss),
      least_over_heap.ratio, rounded(most_over_heap.ratio), least_over_rebuild.ratio,
      rounded(most_over_rebuild.ratio));
  const auto ratio = [](const std::string& name, const RatioAt& at) {
    return Figure{name, at.ratio, "", at.interval};
  };
  append(finding.figures,
         {{"growth_in_corridor", in_corridor, "", fit(corridor)},
          {"growth_in_plane", in_plane, "", fit(plane)},
          {"growth_in_space", in_space, "", fit(space)},
          {"time_growth_in_corridor", grows(corridor, "insertion")},
          {"time_growth_in_plane", grows(plane, "insertion")},
          {"time_growth_in_space", grows(space, "insertion")},
          {"places_moved_in_largest_plane", passed.back(), "places a box"},
          {"gain_over_sorting", gain},
          {"loss_where_boxes_jump", loss},
          ratio("least_frame_over_heap", least_over_heap),
          ratio("most_frame_over_heap", most_over_heap),
          ratio("least_frame_over_rebuild", least_over_rebuild),
          ratio("most_frame_over_rebuild", most_over_rebuild),
          {"places_up_to_which_it_pays", limit.value_or(inserted.back().first), "places a box"}});
  return finding;
}

}  // namespace

Experiment sweep_insertion() {
  return {
      .number = 12,
      .name = "sweep_insertion",
      .title = "Insertion sort and an order that is nearly kept",
      .claim =
          "For Sweep and Prune, the straight forward method would be to keep the objects in a heap and "
          "extract "
          "the minimum when needed. The improved method would make reinserting objects only takes O(n) using "
          "insertion sort if "
          "objects in the collection are relatively in order.",
      .section = "VI-C",
      .measured =
          "paper_sweep_and_prune, whose kept order is mended (update=insertion, heap or binary) or sorted "
          "anew (update=rebuild) and then swept once: the places by which boxes move in the order, and "
          "the time of detecting, mending, sweeping and the whole frame, over how far all boxes go; and "
          "mending "
          "over the number of boxes in a corridor, a plane and in space.",
      .measure = measure,
      .judge = judge};
}

}  // namespace broadside::lab

// Which algorithm is the fastest where: six maps over the number of boxes and one thing that makes boxes easy
// or hard.
#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "lab/measure/samples.hpp"
#include "paper/experiments/winners_measure.hpp"

namespace broadside::lab {
namespace {

/// A map: the number of boxes by `axis`, one of the columns.
struct Map {
  std::string name;
  int dimension;
  std::string axis;
  std::string title;
  std::vector<std::size_t> boxes;
  std::vector<double> values;
};

const std::array<std::string_view, 4> axes = {"neighbours", "size ratio", "cluster spread", "moving"};

std::vector<Map> maps(const Laboratory& laboratory) {
  using Counts = std::vector<std::size_t>;
  using Values = std::vector<double>;
  const auto counts = laboratory.either<Counts>({100, 1'000, 10'000, 100'000}, {100, 1'000, 10'000});
  const auto many = laboratory.either<Counts>({1'000, 10'000, 100'000}, {1'000, 10'000});
  const auto density = laboratory.either<Values>({0.5, 4, 16, 64}, {0.5, 64});
  const auto ratios = laboratory.either<Values>({10, 316, 10'000}, {10, 10'000});
  const auto spreads = laboratory.either<Values>({0.1, 0.017, 0.003}, {0.1, 0.003});
  const auto moving = laboratory.either<Values>({0.01, 0.1, 0.5, 1}, {0.01, 0.1, 1});
  return {{"density 2D", 2, "neighbours", "by overlaps a box, 2D", counts, density},
          {"density 3D", 3, "neighbours", "by overlaps a box, 3D", many, density},
          {"sizes 2D", 2, "size ratio", "by largest over smallest size, 2D", many, ratios},
          {"clusters 2D", 2, "cluster spread", "by width of 16 clusters in the world, 2D", many, spreads},
          {"motion 2D", 2, "moving", "by fraction that moves in a frame, 2D", counts, moving},
          {"motion 3D", 3, "moving", "by fraction that moves in a frame, 3D", many, moving}};
}

std::string scene_of(const Map& map, double value) {
  if (map.axis == "neighbours") return fmt::format("uniform:neighbours={}", value);
  if (map.axis == "size ratio") return fmt::format("power_law:ratio={}", value);
  if (map.axis == "cluster spread") return fmt::format("clustered:spread={}", value);
  return "uniform";
}

/// Our algorithms that can win with this many boxes: quadratic search has lost from some thousands on, and
/// costs the most.
std::string entries(std::size_t boxes) {
  std::string list = "auto";
  for (const std::string& name : single_algorithms()) {
    if (name != "brute_force" || boxes <= 2'000) list += "," + name;
  }
  return list;
}

Effort effort_of_ours(const Laboratory& laboratory) {
  return {.budget_seconds = 2,
          .history_seconds = 8,
          .share_seconds = laboratory.either(0.02, 0.005),
          .least_rounds = laboratory.either<std::size_t>(4, 3),
          .most_rounds = laboratory.either<std::size_t>(100, 40),
          .slow_seconds = 0.5,
          .slow_history_seconds = 0.5,
          .slow_rounds = 1};
}

/// Peers are several times slower than ours: few rounds say which of them is the fastest.
Effort effort_of_peers(const Laboratory& laboratory) {
  return {.budget_seconds = laboratory.either(0.15, 0.02),
          .history_seconds = laboratory.either(0.5, 0.04),
          .share_seconds = 0.002,
          .least_rounds = laboratory.either<std::size_t>(2, 1),
          .most_rounds = 10,
          .slow_seconds = laboratory.either(0.02, 0.005),
          .slow_history_seconds = laboratory.either(0.02, 0.005),
          .slow_rounds = 1};
}

/// The fastest measured one, auto aside.
const Measurement* fastest(const CaseResult& result) {
  const Measurement* best = nullptr;
  for (const Measurement& measurement : result.measurements) {
    if (measurement.samples_ms.empty() || measurement.algorithm == "auto") continue;
    if (best == nullptr || median(measurement.samples_ms) < median(best->samples_ms)) best = &measurement;
  }
  return best;
}

/// The algorithms that may be the fastest where there are more boxes: all that are not far behind already.
std::string not_hopeless(const CaseResult& result) {
  constexpr double far = 4;
  const Measurement* const best = fastest(result);
  std::string list;
  for (const Measurement& measurement : result.measurements) {
    if (!measurement.samples_ms.empty() && median(measurement.samples_ms) <= far * median(best->samples_ms))
      list += (list.empty() ? "" : ",") + measurement.algorithm;
  }
  return list;
}

Cell time_of(const CaseResult& result, const std::string& name) {
  const auto found = std::ranges::find(result.measurements, name, &Measurement::algorithm);
  return found == result.measurements.end() ? Cell() : time_cell(*found);
}

std::vector<Cell> row_of(const Map& map, std::size_t boxes, double value, const CaseResult& ours,
                         const std::optional<CaseResult>& peers) {
  std::vector<Cell> row;
  row.emplace_back(map.name);
  row.emplace_back(static_cast<double>(boxes));
  for (const std::string_view axis : axes) {
    row.emplace_back();
    if (axis == map.axis) row.back() = value;
  }
  row.push_back(time_of(ours, "auto"));
  for (const std::string& name : single_algorithms()) row.push_back(time_of(ours, name));
  const Measurement* const own = fastest(ours);
  const Measurement* const peer = peers ? fastest(*peers) : nullptr;
  for (const Measurement* const winner : {own, peer}) {
    row.emplace_back();
    if (winner != nullptr) row.back() = winner->algorithm;
  }
  row.push_back(peer == nullptr ? Cell() : time_cell(*peer));
  return row;
}

}  // namespace

const std::vector<std::string>& single_algorithms() {
  static const std::vector<std::string> names = {"brute_force", "grid", "sweep_and_prune", "quadtree", "bvh"};
  return names;
}

Table measure_fields(const Laboratory& laboratory) {
  Table table{.name = "fields",
              .title = "The time of each of ours, and the fastest of them and of the peers",
              .columns = {{"map"}, {"boxes"}}};
  for (const std::string_view axis : axes) table.columns.push_back({std::string(axis)});
  table.columns.push_back({"auto", "ms"});
  for (const std::string& name : single_algorithms()) table.columns.push_back({name, "ms"});
  table.columns.insert(table.columns.end(), {{"fastest"}, {"fastest peer"}, {"peer", "ms"}});

  const bool any_peer =
      std::ranges::any_of(laboratory.catalogue().algorithms(),
                          [](const Algorithm& algorithm) { return algorithm.kind == AlgorithmKind::peer; });
  // They take most of the time.
  const auto has_peers = [&](const Map& map) {
    return any_peer && (!laboratory.is_quick() || map.axis == "neighbours");
  };
  for (const Map& map : maps(laboratory)) {
    for (const std::string_view value : {"fastest", "fastest peer"}) {
      if (value == "fastest peer" && (!has_peers(map) || map.axis != "neighbours")) continue;
      table.charts.push_back(
          {.title = fmt::format("The {} {}", value == "fastest" ? "fastest of ours" : value, map.title),
           .kind = ChartKind::map,
           .x = "boxes",
           .y = map.axis,
           .value = std::string(value),
           .log_x = true,
           .log_y = true,
           .where = {{"map", map.name}}});
    }
    for (const double value : map.values) {
      std::string rivals = "peers";
      for (const std::size_t boxes : map.boxes) {
        const bool moves = map.axis == "moving";
        const CaseRequest request{.scene = scene_of(map, value),
                                  .dimension = map.dimension,
                                  .boxes = boxes,
                                  .moving = moves ? value : 0,
                                  .frames = moves ? laboratory.either<std::size_t>(12, 6) : 0};
        const CaseResult ours = laboratory.measure(entries(boxes), request, effort_of_ours(laboratory));
        std::optional<CaseResult> peers;
        if (has_peers(map)) {
          peers = laboratory.measure(rivals, request, effort_of_peers(laboratory));
          const std::string left = not_hopeless(*peers);
          if (boxes >= 1'000 && !left.empty()) rivals = left;
        }
        table.add(row_of(map, boxes, value, ours, peers));
      }
    }
  }
  return table;
}

}  // namespace broadside::lab

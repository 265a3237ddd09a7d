// What instruction sets and threads add, measured on uniform boxes.
#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "broadside/executor.hpp"

#include "lab/measure/samples.hpp"
#include "paper/experiments/winners_measure.hpp"

namespace broadside::lab {
namespace {

/// Has all searches run on an instruction set while it lives.
class OnInstructionSet {
 public:
  explicit OnInstructionSet(const std::string& name) { limit_instruction_set(name); }
  ~OnInstructionSet() { limit_instruction_set(""); }
  OnInstructionSet(const OnInstructionSet&) = delete;
  OnInstructionSet& operator=(const OnInstructionSet&) = delete;
};

/// Those of our single algorithms that can search with several threads.
std::vector<std::string> threaded(const Catalogue& catalogue) {
  std::vector<std::string> names;
  for (const std::string& name : single_algorithms()) {
    const Algorithm* const algorithm = find_algorithm(name, catalogue.algorithms());
    if (name != "brute_force" && algorithm != nullptr && has_threads(*algorithm)) names.push_back(name);
  }
  return names;
}

/// 1, 2 and as many as there are, each once; 1 alone where there is nothing to run several with.
std::vector<std::size_t> thread_counts() {
  const Executor* const executor = standard_executor();
  const std::size_t most = executor == nullptr ? 1 : std::max<std::size_t>(executor->threads(), 1);
  std::vector<std::size_t> counts = {1};
  if (most >= 2) counts.push_back(2);
  if (most > 2) counts.push_back(most);
  return counts;
}

/// Alike for both tables but for the time that an algorithm may take.
Effort effort_of(const Laboratory& laboratory, double share_seconds) {
  return {.budget_seconds = 2,
          .share_seconds = share_seconds,
          .least_rounds = laboratory.either<std::size_t>(5, 3),
          .most_rounds = 100,
          .slow_seconds = 1,
          .slow_rounds = 1};
}

Chart time_chart(const std::string& by, ChartKind kind, const std::string& x, const std::string& series,
                 const std::string& dimension) {
  return {.title = fmt::format("Time by {}, {}", by, dimension),
          .kind = kind,
          .x = x,
          .y = "time",
          .series = series,
          .log_y = true,
          .where = {{"dimension", dimension}}};
}

}  // namespace

Table measure_instruction_sets(const Laboratory& laboratory) {
  Table table{.name = "instruction_sets",
              .title = "The time of each of ours by instruction set, on uniform boxes",
              .columns = {{"dimension"}, {"boxes"}, {"algorithm"}, {"instruction set"}, {"time", "ms"}}};
  std::vector<std::string> sets = instruction_sets();
  if (laboratory.is_quick() && sets.size() > 2) sets = {sets.front(), sets.back()};
  const std::size_t boxes = laboratory.either<std::size_t>(10'000, 5'000);
  const Effort effort = effort_of(laboratory, laboratory.either(0.05, 0.01));
  for (const int dimension : {2, 3}) {
    const std::string axes = fmt::format("{}D", dimension);
    table.charts.push_back(
        time_chart("instruction set", ChartKind::bars, "algorithm", "instruction set", axes));
    // One set after the other, more than once: the least of each, so that what else the machine does is not
    // taken for a difference between them.
    std::map<std::pair<std::string, std::string>, double> least;
    for (int round = 0; round < 2; ++round) {
      for (const std::string& set : sets) {
        const OnInstructionSet limited(set);
        const CaseResult result =
            laboratory.measure(list_of(single_algorithms()),
                               {.scene = "uniform", .dimension = dimension, .boxes = boxes}, effort);
        for (const Measurement& measurement : result.measurements) {
          if (measurement.samples_ms.empty()) continue;
          const double time = median(measurement.samples_ms);
          const auto [at, is_new] = least.try_emplace({measurement.algorithm, set}, time);
          if (!is_new) at->second = std::min(at->second, time);
        }
      }
    }
    for (const std::string& name : single_algorithms()) {
      for (const std::string& set : sets) {
        const auto found = least.find({name, set});
        table.add({axes, static_cast<double>(boxes), name, set,
                   found == least.end() ? Cell() : Cell(found->second)});
      }
    }
  }
  return table;
}

Table measure_threads(const Laboratory& laboratory) {
  Table table{.name = "threads",
              .title = "The time of each of ours by threads, on uniform boxes",
              .columns = {{"dimension"}, {"boxes"}, {"algorithm"}, {"threads"}, {"time", "ms"}}};
  const std::size_t boxes = laboratory.either<std::size_t>(200'000, 50'000);
  std::vector<std::string> specs;
  for (const std::string& name : threaded(laboratory.catalogue())) {
    for (const std::size_t threads : thread_counts())
      specs.push_back(threads == 1 ? name : fmt::format("{}:threads={}", name, threads));
  }
  const Effort effort = effort_of(laboratory, laboratory.either(0.5, 0.02));
  for (const int dimension : {2, 3}) {
    const std::string axes = fmt::format("{}D", dimension);
    table.charts.push_back(time_chart("threads", ChartKind::lines, "threads", "algorithm", axes));
    const CaseResult result = laboratory.measure(
        list_of(specs), {.scene = "uniform", .dimension = dimension, .boxes = boxes}, effort);
    for (const Measurement& measurement : result.measurements) {
      table.add({axes, static_cast<double>(boxes),
                 measurement.algorithm.substr(0, measurement.algorithm.find(':')),
                 static_cast<double>(measurement.threads), time_cell(measurement)});
    }
  }
  return table;
}

}  // namespace broadside::lab

// Parts about the moving fraction: `auto` against peers, `auto` against each way alone, and a single mover.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "bench/motion/parts.hpp"
#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"

namespace broadside::bench {
namespace {

template <int D>
RaceOutcome race_in(const MotionBenchmarkOptions& options, const std::string& algorithms,
                    const std::string& scene, std::size_t boxes, double moving, const Turns& turns) {
  const lab::Catalogue catalogue;
  return race<D>(catalogue.select(algorithms), motion_of<D>(scene, options.request(boxes, turns, moving)),
                 turns);
}

RaceOutcome race_in(int dimension, const MotionBenchmarkOptions& options, const std::string& algorithms,
                    const std::string& scene, std::size_t boxes, double moving, const Turns& turns) {
  return dimension == 2 ? race_in<2>(options, algorithms, scene, boxes, moving, turns)
                        : race_in<3>(options, algorithms, scene, boxes, moving, turns);
}

std::vector<std::string> scenes_of(const MotionBenchmarkOptions& options) {
  return options.scenes.empty() ? std::vector<std::string>{"uniform"} : options.scenes;
}

std::string percent(double moving) { return fmt::format("{:.3g} %", moving * 100); }

/// Ten fractions from 0.1 to 100 %, evenly spaced on a logarithmic scale.
std::vector<double> ten_fractions() {
  std::vector<double> fractions;
  for (int i = 0; i < 10; ++i) fractions.push_back(std::pow(10.0, -3 + i / 3.0));
  return fractions;
}

/// The first runner's median over the smallest median of the others; 0 if there are no others.
double over_the_best(const RaceOutcome& outcome) {
  double best = INFINITY;
  for (std::size_t i = 1; i < outcome.runners.size(); ++i) {
    if (outcome.runners[i].ran()) best = std::min(best, lab::median(outcome.runners[i].frames_ms));
  }
  const RaceRunner& first = outcome.runners.front();
  return first.ran() && std::isfinite(best) ? lab::median(first.frames_ms) / best : 0;
}

void ways_in(int dimension, const std::string& scene, const MotionBenchmarkOptions& options,
             std::vector<double>& ratios) {
  const std::string algorithms = options.algorithms_or("auto,auto:update=rebuild,auto:update=follow");
  const std::size_t boxes = options.boxes_or(100'000);
  const Turns turns = options.turns(20, 3);
  const std::vector<double> fractions = options.moving.empty() ? ten_fractions() : options.moving;
  const lab::Catalogue catalogue;
  const std::vector<lab::Entry> entries = catalogue.select(algorithms);
  print_heading(scene, dimension, boxes, turns);
  lab::AlignedColumns columns(">>" + std::string(entries.size(), '>') + "><");
  std::vector<std::string> head = {"moving", "movers"};
  for (const lab::Entry& entry : entries) head.push_back(entry.spec.text());
  head.insert(head.end(), {"over the best", "the last frame"});
  columns.add(head);
  for (const double moving : fractions) {
    const RaceOutcome outcome = race_in(dimension, options, algorithms, scene, boxes, moving, turns);
    std::vector<std::string> row = {percent(moving), lab::rounded(outcome.mean_movers())};
    for (const RaceRunner& runner : outcome.runners)
      row.push_back(runner.ran() ? lab::rounded(lab::median(runner.frames_ms) * 1e3) : "-");
    const double ratio = over_the_best(outcome);
    if (ratio > 0) ratios.push_back(ratio);
    row.insert(row.end(), {fmt::format("{:.2f}", ratio), outcome.runners.front().explanation});
    columns.add(row);
  }
  fmt::print("{}(microseconds a frame, medians)\n\n", columns.text("  "));
  std::fflush(stdout);
}

}  // namespace

void against_peers(const MotionBenchmarkOptions& options) {
  const std::array<std::string, 2> peers = {"bullet_dbvt,box2d_tree,chipmunk_bb_tree",
                                            "bullet_dbvt,fcl_dynamic_aabb_tree"};
  const std::vector<double> fractions =
      options.moving.empty() ? std::vector<double>{0.01, 0.1, 0.5, 1} : options.moving;
  for (const int dimension : options.dimensions) {
    for (const std::string& scene : scenes_of(options)) {
      const Turns turns = options.turns(20, 3);
      print_heading(scene, dimension, options.boxes_or(100'000), turns);
      for (const double moving : fractions) {
        const std::string& rivals = peers[static_cast<std::size_t>(dimension - 2)];
        const RaceOutcome outcome = race_in(dimension, options, options.algorithms_or("auto," + rivals),
                                            scene, options.boxes_or(100'000), moving, turns);
        fmt::print("{} moving, {} events a frame\n", percent(moving),
                   lab::rounded(static_cast<double>(outcome.events) / static_cast<double>(turns.frames)));
        print_table(outcome);
      }
      fmt::print("\n");
    }
  }
}

void against_ways(const MotionBenchmarkOptions& options) {
  std::vector<double> ratios;
  for (const int dimension : options.dimensions) {
    for (const std::string& scene : scenes_of(options)) ways_in(dimension, scene, options, ratios);
  }
  if (ratios.empty()) return;
  fmt::print("the first over the best of the others: geometric mean {:.3f}, worst {:.3f}\n\n",
             lab::geometric_mean(ratios), std::ranges::max(ratios));
}

void one_mover(const MotionBenchmarkOptions& options) {
  for (const int dimension : options.dimensions) {
    for (const std::string& scene : scenes_of(options)) {
      const std::size_t boxes = options.boxes_or(1'000'000);
      const Turns turns = options.turns(200, 3);
      print_heading("one mover, " + scene, dimension, boxes, turns);
      print_table(race_in(dimension, options, options.algorithms_or("auto"), scene, boxes,
                          1 / static_cast<double>(boxes), turns));
      fmt::print("\n");
    }
  }
}

}  // namespace broadside::bench

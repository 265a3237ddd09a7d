// Shared by the parts of the motion benchmark: scenes in motion, headings and tables.
#include "bench/motion/parts.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "lab/measure/samples.hpp"
#include "lab/numbers.hpp"
#include "lab/report/aligned_columns.hpp"
#include "lab/report/machine.hpp"
#include "lab/scenes/motion.hpp"

namespace broadside::bench {

Turns MotionBenchmarkOptions::turns(std::size_t default_frames, std::size_t default_rounds) const {
  return {.frames = frames > 0 ? frames : default_frames,
          .rounds = rounds > 0 ? rounds : default_rounds,
          .in_a_row = in_a_row,
          .is_cold = is_cold,
          .budget_seconds = budget_seconds};
}

template <int D>
StartMotion<D> motion_of(const std::string& scene, const lab::SceneRequest& request) {
  const lab::NamedScene named = lab::find_scene(scene);
  const bool by_itself = D == 2 ? bool(named.scene.history_2d) : bool(named.scene.history_3d);
  lab::SceneRequest first = request;
  if (!by_itself) first.frames = 0;
  const auto history =
      std::make_shared<const lab::History<D>>(lab::make_history<D>(named.scene, named.spec, first));
  return [=, whole_steps = named.scene.integers]() -> Motion<D> {
    if (by_itself) {
      return {history->boxes,
              [history, frame = std::size_t{0}]() mutable { return history->steps.at(frame++); }};
    }
    const auto moving = std::make_shared<lab::MovingBoxes<D>>(history->boxes, request, whole_steps);
    return {history->boxes, [moving] { return moving->next(); }};
  };
}

template StartMotion<2> motion_of(const std::string&, const lab::SceneRequest&);
template StartMotion<3> motion_of(const std::string&, const lab::SceneRequest&);

void print_heading(const std::string& what, int dimension, std::size_t boxes, const Turns& turns) {
  const lab::Machine machine = lab::this_machine();
  const lab::Build build = lab::this_build();
  fmt::print("{}, {}D, {} boxes, {} frames in turns of {}{}, the least of {} rounds; {}, {} cores; {}, {}\n",
             what, dimension, lab::grouped(boxes), turns.frames, turns.in_a_row,
             turns.is_cold ? ", caches flushed" : "", turns.rounds, machine.cpu, machine.cores,
             build.compiler, build.revision);
}

namespace {

double mean_of(const std::vector<double>& times) {
  return std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size());
}

}  // namespace

void print_table(const RaceOutcome& outcome) {
  lab::AlignedColumns columns("<>>>>>>>><");
  columns.add(
      {"algorithm", "us a frame", "mean", "p99", "worst", "ns a mover", "ratio", "of means", "build us", ""});
  const double movers = std::max(outcome.mean_movers(), 1.0);
  double first = 0;
  double first_mean = 0;
  for (const RaceRunner& runner : outcome.runners) {
    if (!runner.ran()) {
      columns.add({runner.algorithm, "-", "-", "-", "-", "-", "-", "-", "-", runner.left_out});
      continue;
    }
    const double median = lab::median(runner.frames_ms);
    const double mean = mean_of(runner.frames_ms);
    if (first == 0) first = median;
    if (first_mean == 0) first_mean = mean;
    columns.add({runner.algorithm, lab::rounded(median * 1e3), lab::rounded(mean * 1e3),
                 lab::rounded(lab::percentile(runner.frames_ms, 0.99) * 1e3),
                 lab::rounded(std::ranges::max(runner.frames_ms) * 1e3), lab::rounded(median * 1e6 / movers),
                 fmt::format("{:.2f}", median / first), fmt::format("{:.2f}", mean / first_mean),
                 lab::rounded(runner.build_ms * 1e3), runner.explanation});
  }
  fmt::print("{}", columns.text("  "));
  std::fflush(stdout);
}

}  // namespace broadside::bench

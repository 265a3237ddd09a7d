// The motion benchmark: motion PART... [options], one table per part. `motion --help` lists the parts.
#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "bench/guarded.hpp"
#include "bench/motion/parts.hpp"

namespace broadside::bench {
namespace {

struct MotionBenchmark {
  std::string name;
  std::string what;
  void (*run)(const MotionBenchmarkOptions&);
};

const std::vector<MotionBenchmark>& parts() {
  static const std::vector<MotionBenchmark> list = {
      {"peers", "auto against peers that follow motion: 1, 10, 50, 100 % of 100,000 boxes", against_peers},
      {"ways", "auto over the better of rebuilding and following, 0.1 to 100 % moving", against_ways},
      {"one", "one mover among 1,000,000 boxes", one_mover},
      {"spikes", "1,000 frames, a tenth moving, five times: the worst over the median", spikes},
      {"jumps", "frames in which every box jumps, over rebuilding", jumps},
      {"rest", "2,000 movers among 1,000,000 boxes that rest, over those among 10,000", rest},
      {"recorded", "recorded scenes and a pile at rest, 5,000 bodies, against the engine's own broad phase",
       recorded},
      {"worlds", "World with its moves, exact and enlarged events, over its tracker alone", worlds},
      {"frames", "a tracker over the search alone where all boxes move, and its worst frames", frames},
  };
  return list;
}

int run(int count, char** arguments) {
  CLI::App program("Prints a table for each claim about motion.");
  std::vector<std::string> wanted;
  MotionBenchmarkOptions options;
  std::string listing;
  std::vector<std::string> names;
  for (const MotionBenchmark& part : parts()) {
    listing += fmt::format("\n  {:<10} {}", part.name, part.what);
    names.push_back(part.name);
  }
  program.footer("Parts; all are run unless some are named:" + listing);
  program.add_option("parts", wanted, "Parts to run")->check(CLI::IsMember(names));
  program.add_option("--algorithms", options.algorithms,
                     "Instead of a part's own; all others are compared with the first");
  program.add_option("--scenes", options.scenes, "Scenes instead of uniform")->delimiter(',');
  program.add_option("--traces", options.traces, "Files in motion, for the part worlds: instead of scenes")
      ->delimiter(',')
      ->check(CLI::ExistingFile);
  program.add_option("--kinds", options.kinds, "Motions, for the part frames")
      ->delimiter(',')
      ->check(CLI::IsMember({"straight", "tremble", "alike", "churn"}));
  program.add_option("--dimension", options.dimensions, "2, 3 or 2,3")
      ->delimiter(',')
      ->check(CLI::Range(2, 3));
  program.add_option("-n", options.boxes, "Boxes, instead of a part's own number");
  program.add_option("--moving", options.moving, "Fractions that move")->delimiter(',');
  program.add_option("--drift", options.drift, "What a mover goes in a frame, in boxes")
      ->capture_default_str();
  program.add_option("--frames", options.frames, "Frames after the first");
  program.add_option("--rounds", options.rounds,
                     "How often the motion is followed anew; of each frame the least time counts");
  program.add_option("--turn", options.in_a_row, "Frames in a row before it is the next one's turn")
      ->capture_default_str()
      ->check(CLI::PositiveNumber);
  program.add_flag("--cold", options.is_cold,
                   "Flush the caches before each frame, as the rest of an engine does");
  program.add_option("--budget", options.budget_seconds, "Seconds for all frames of an algorithm")
      ->capture_default_str();
  program.add_option("--seed", options.seed, "Of the boxes and their motion")->capture_default_str();
  CLI11_PARSE(program, count, arguments);
  for (const MotionBenchmark& part : parts()) {
    if (wanted.empty() || std::ranges::find(wanted, part.name) != wanted.end()) part.run(options);
  }
  return 0;
}

}  // namespace
}  // namespace broadside::bench

int main(int count, char** arguments) {
  using namespace broadside::bench;
  return guarded("motion", 1, [&] { return run(count, arguments); });
}

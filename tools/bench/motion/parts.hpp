// The parts of the motion benchmark: each prints a table about one claim.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bench/motion/race.hpp"

namespace broadside::bench {

/// Options of the command line. 0 or an empty list selects the part's own default.
struct MotionBenchmarkOptions {
  std::string algorithms{};  ///< a selection for Catalogue::select
  std::vector<std::string> scenes{};
  std::vector<std::string> traces{};              ///< files
  std::vector<std::string> kinds = {"straight"};  ///< of motion, for the part frames
  std::vector<int> dimensions = {2, 3};
  std::size_t boxes = 0;
  std::vector<double> moving{};
  double drift = 0.2;
  std::uint64_t seed = 1;
  std::size_t frames = 0;
  std::size_t rounds = 0;
  std::size_t in_a_row = Turns{}.in_a_row;
  bool is_cold = false;
  double budget_seconds = Turns{}.budget_seconds;

  /// The request for a scene.
  lab::SceneRequest request(std::size_t its_boxes, const Turns& turns, double its_moving) const {
    return {.boxes = its_boxes, .seed = seed, .frames = turns.frames, .moving = its_moving, .drift = drift};
  }
  Turns turns(std::size_t default_frames, std::size_t default_rounds) const;
  std::string algorithms_or(const std::string& default_value) const {
    return algorithms.empty() ? default_value : algorithms;
  }
  std::size_t boxes_or(std::size_t default_value) const { return boxes > 0 ? boxes : default_value; }
};

/// The motion of a scene. Its boxes are generated (or recorded) once for all rounds.
template <int D>
StartMotion<D> motion_of(const std::string& scene, const lab::SceneRequest& request);

/// `auto` against the peers that follow motion, at 1, 10, 50 and 100 % moving.
void against_peers(const MotionBenchmarkOptions& options);

/// `auto` over the better of rebuilding and following, at ten fractions from 0.1 to 100 % moving.
void against_ways(const MotionBenchmarkOptions& options);

/// One mover among a million boxes.
void one_mover(const MotionBenchmarkOptions& options);

/// A thousand frames with 10 % moving: the slowest over the median.
void spikes(const MotionBenchmarkOptions& options);

/// The frame in which every box jumps, over the time of a rebuild.
void jumps(const MotionBenchmarkOptions& options);

/// 2,000 movers among 1,000,000 boxes at rest, over the same movers among the 10,000 boxes around them.
void rest(const MotionBenchmarkOptions& options);

/// Recorded scenes, and the pile at rest: `auto` against the broad phase of the recorded engine. Accepts any
/// scene that moves by itself.
void recorded(const MotionBenchmarkOptions& options);

/// Worlds with and without enlarged boxes, over their tracker alone and over an engine's broad phase; in
/// scenes or in files.
void worlds(const MotionBenchmarkOptions& options);

/// A tracker over the search alone, in motions that go on alike, and its worst frame over the median.
void frames(const MotionBenchmarkOptions& options);

/// Prints the scene, its boxes and the machine.
void print_heading(const std::string& what, int dimension, std::size_t boxes, const Turns& turns);

/// Prints a line for each runner: times, time per mover, and ratio to the first runner.
void print_table(const RaceOutcome& outcome);

}  // namespace broadside::bench

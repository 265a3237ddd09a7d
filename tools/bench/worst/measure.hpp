// One algorithm on one input: time, tests, memory, and a hash of the pairs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "lab/catalogue.hpp"
#include "lab/worst/hard_input.hpp"

namespace broadside::bench {

/// The beginning of an error's text, in a Run that a child process sends through a pipe.
using FaultText = std::array<char, 256>;

/// Result of an algorithm on an input. If nothing moves, a frame is the call itself.
struct MeasuredRun {
  enum class End { finished, too_slow, out_of_memory, too_many_pairs, failed };

  End end = End::finished;
  double milliseconds = 0;        ///< per call, the shortest of several; for a tracker, the median frame
  double worst_milliseconds = 0;  ///< for a tracker, the slowest frame after the first; otherwise as above
  double tests = 0;               ///< per call or frame; negative if the algorithm does not count tests
  std::uint64_t pairs = 0;        ///< for a tracker, pairs of its first frame
  std::uint64_t events = 0;       ///< for a tracker, begun and ended pairs in all frames after the first
  std::uint64_t hash = 0;         ///< of pairs and events
  double peak_bytes = 0;          ///< beyond input and output
  FaultText fault{};              ///< what it threw if it failed; null-terminated

  bool finished() const { return end == End::finished; }
};

/// How an input is measured.
struct HuntEffort {
  std::size_t boxes = 100'000;
  std::size_t rounds = 2;  ///< timed calls, after a first call that is only counted
  std::size_t frames = 9;  ///< for a tracker, after its first
  double max_pairs = 10;   ///< per box, and events per mover and frame; an input with more is left out
  std::uint64_t max_bytes = std::uint64_t{6} << 30;
};

/// Runs one algorithm for at most `seconds`, in a child process.
using RunAlgorithm = std::function<MeasuredRun(const lab::Entry& entry, double seconds)>;

/// Generates the boxes of `input` and returns a function that runs algorithms on them. A run makes one call
/// to count tests, memory and pairs, and then `rounds` timed calls, which must find the same pairs. A tracker
/// follows the whole motion in each of these calls.
RunAlgorithm prepare(const lab::HardInput& input, const HuntEffort& effort);

}  // namespace broadside::bench

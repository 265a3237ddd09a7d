// One algorithm on one input: its time, tests and memory, and the hash of its pairs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

#include "lab/catalogue.hpp"
#include "lab/worst/hard_input.hpp"

namespace broadside::bench {

/// The beginning of an error's text, in a Run that a child sends through a pipe.
using FaultText = std::array<char, 256>;

/// What an algorithm did with an input. A frame is the call itself where nothing moves.
struct MeasuredRun {
  enum class End { finished, too_slow, out_of_memory, too_many_pairs, failed };

  End end = End::finished;
  double milliseconds = 0;        ///< a call, the least of several; of a tracker the median frame
  double worst_milliseconds = 0;  ///< of a tracker the slowest frame after the first; else as above
  double tests = 0;               ///< a call or frame; negative where the algorithm does not count
  std::uint64_t pairs = 0;        ///< of a tracker those of its first frame
  std::uint64_t events = 0;       ///< of a tracker: begun and ended in all frames after the first
  std::uint64_t hash = 0;         ///< of both
  double peak_bytes = 0;          ///< taken beyond input and output
  FaultText fault{};              ///< what it threw where it failed; ends with 0

  bool finished() const { return end == End::finished; }
};

/// How an input is measured.
struct HuntEffort {
  std::size_t boxes = 100'000;
  std::size_t rounds = 2;  ///< timed calls; the first, counted call is not among them
  std::size_t frames = 9;  ///< of a tracker, after its first
  double max_pairs = 10;   ///< a box, and events a mover and frame: an input with more is left out
  std::uint64_t max_bytes = std::uint64_t{6} << 30;
};

/// A run of one algorithm of at most `seconds`, in a process of its own.
using RunAlgorithm = std::function<MeasuredRun(const lab::Entry& entry, double seconds)>;

/// Makes the boxes of `input` and returns what runs algorithms on them. A run makes one call in which tests,
/// memory and pairs are counted, then `rounds` that are timed and whose pairs must be the same. A tracker
/// takes the whole motion once for each.
RunAlgorithm prepare(const lab::HardInput& input, const HuntEffort& effort);

}  // namespace broadside::bench

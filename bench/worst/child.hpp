// A call in a process of its own, which can be ended at any time: an algorithm that takes minutes for a hard
// input, or all memory, costs the hunt no more than its limit.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace broadside::bench {

/// What an algorithm did with an input. A frame is the call itself where nothing moves.
struct Run {
  enum class End { finished, too_slow, out_of_memory, too_many_pairs, failed };

  End end = End::finished;
  double milliseconds = 0;        ///< a call, the least of several; of a tracker the median frame
  double worst_milliseconds = 0;  ///< of a tracker the slowest frame after the first; else as above
  double tests = 0;               ///< a call or frame; negative where the algorithm does not count
  std::uint64_t pairs = 0;        ///< of a tracker those of its first frame
  std::uint64_t events = 0;       ///< of a tracker: begun and ended in all frames after the first
  std::uint64_t hash = 0;         ///< of both
  double peak_bytes = 0;          ///< taken beyond input and output
  std::string fault{};            ///< what it threw where it failed

  bool finished() const { return end == End::finished; }
};

/// Calls `run` in a process of its own and returns its result; too_slow after `seconds`, out_of_memory beyond
/// `most_bytes` of address space. Throws std::runtime_error if no process can be made.
Run in_child(double seconds, std::uint64_t most_bytes, const std::function<Run()>& run);

}  // namespace broadside::bench

// One algorithm on one input: its time, tests and memory, and the hash of its pairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>

#include "bench/worst/child.hpp"
#include "lab/catalogue.hpp"
#include "lab/worst/input.hpp"

namespace broadside::bench {

/// How an input is measured.
struct Effort {
  std::size_t boxes = 100'000;
  std::size_t rounds = 2;  ///< timed calls; the first, counted call is not among them
  std::size_t frames = 9;  ///< of a tracker, after its first
  double most_pairs = 10;  ///< a box, and events a mover and frame: an input with more is left out
  std::uint64_t most_bytes = std::uint64_t{6} << 30;
};

/// A run of one algorithm of at most `seconds`, in a process of its own.
using RunAlgorithm = std::function<Run(const lab::Entry& entry, double seconds)>;

/// Makes the boxes of `input` and returns what runs algorithms on them. A run makes one call in which tests,
/// memory and pairs are counted, then `rounds` that are timed and whose pairs must be the same. A tracker
/// takes the whole motion once for each.
RunAlgorithm prepare(const lab::HardInput& input, const Effort& effort);

}  // namespace broadside::bench

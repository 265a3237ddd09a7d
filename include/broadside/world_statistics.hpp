// What a world holds, what it costs, and what its last update did.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "broadside/statistics.hpp"

namespace broadside {

/// The bytes a world holds, by purpose; what it has reserved counts.
struct WorldBytes {
  std::size_t boxes = 0;    ///< boxes, also enlarged ones and those removed that can still be read
  std::size_t slots = 0;    ///< generations and states of slots, user data, lists of what changed
  std::size_t filters = 0;  ///< filters and ignored pairs
  std::size_t pairs = 0;    ///< current pairs and events; those of enlarged boxes and a predicate's answers
  std::size_t tracker = 0;  ///< what the tracker says: its copies of boxes and filters, and its structure

  std::size_t total() const noexcept { return boxes + slots + filters + pairs + tracker; }
};

/// What World::statistics() tells.
struct WorldStatistics {
  std::size_t boxes = 0;  ///< in the world
  std::size_t slots = 0;  ///< that there are, used or free
  std::size_t pairs = 0;  ///< that hold since the last update
  std::size_t begun = 0;  ///< events of the last update
  std::size_t ended = 0;
  std::size_t enlarged_pairs = 0;  ///< pairs of enlarged boxes, where there is a margin or a predicate
  std::size_t ignored_pairs = 0;   ///< that ignore() was called for

  /// What the tracker counted in the last update: tests, hits (the other tests are false positives),
  /// references, cells or nodes. Empty where it does not count.
  std::optional<Statistics> tracker;

  /// What the tracker chose for the last update and why; empty where it is not one that chooses.
  std::string explanation;

  WorldBytes bytes;
};

}  // namespace broadside

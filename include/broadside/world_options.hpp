// What a world, and each box in it, can be told when it is made.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "broadside/algorithm.hpp"
#include "broadside/bad_input.hpp"
#include "broadside/filter.hpp"
#include "broadside/handle.hpp"

namespace broadside {

/// What comes with a box when it is added.
struct BoxOptions {
  Filter filter{};              ///< which boxes it meets, and whether it is static
  std::uint64_t user_data = 0;  ///< the caller's; the world only keeps it
};

/// How a world works.
struct WorldOptions {
  /// The spec of the algorithm that finds the pairs.
  std::string algorithm{default_algorithm};

  /// Whether the world knows its current pairs: pairs() and persisting(). Without them it saves 16 bytes a
  /// pair and some ten nanoseconds an event, and a predicate can only be set before the first update.
  bool keep_pairs = true;

  /// If greater than 0, the tracker sees each box enlarged by this distance on every side, and a new one only
  /// when the box has left the enlarged one. The pairs reported are those of the boxes themselves all the
  /// same, exactly and in the same update.
  ///
  /// Each pair of enlarged boxes takes some 50 bytes and is tested whenever one of its boxes moves, which
  /// costs about a microsecond a mover. So it pays over a tracker of your own for which a mover is dearer
  /// than that, and not over the library's own, which took 0.3 (n = 100,000 in 2D).
  double margin = 0;

  /// The generation of the first handles. Worlds that begin far apart refuse each other's handles.
  std::uint32_t first_generation = 0;

  /// What add() and move() do about invalid boxes: they throw, or take them in as absent ones, which pair
  /// with nothing until they are moved to valid ones, and which quarantined() names.
  BadInput bad_input = BadInput::reject;

  /// Whether brute force runs beside the tracker: update() then throws a DivergenceOf<D, Real> where the two
  /// first differ. For looking for faults; n^2 / 2 tests an update. See ShadowTracker.
  bool shadow = false;
};

/// Whether two boxes that overlap and whose filters accept each other are to count as a pair;
/// first.slot < second.slot.
using PairPredicate = std::function<bool(Handle first, Handle second)>;

}  // namespace broadside

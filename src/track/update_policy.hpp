// FollowPolicy: whether a frame's changes are followed in a structure that stays, or all pairs found anew.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"

namespace broadside::core {

/// How a tracker updates: the values of its tunable `update`.
enum class Update { automatic, follow, rebuild };

Tunable update_tunable();
Update update_of(const Settings& settings);

/// The cost of following boxes in a structure, in nanoseconds of one machine: only ratios matter.
struct FollowCosts {
  double start;         ///< to build the structure, a box
  double mover;         ///< to follow a box that moves, before any was followed
  double mover_alone;   ///< to follow a box that moves, without its tests
  double test;          ///< each of a mover's first 64 tests
  double further_test;  ///< each further one
};

/// The cost of finding all pairs anew, likewise.
struct FindCosts {
  double box;                     ///< a box, without its pairs, with 64 tests and 4 references
  double further_test = 0.5;      ///< each further test of a box
  double further_reference = 30;  ///< each further reference to a box
  double pair = 7;
};

/// Decides by counts alone, of boxes, of changes and of tests, so that the same history always goes the same
/// way. May choose among several structures. Cost of a frame: near the lesser of the two ways', and never
/// much more than finding all pairs anew, since a structure whose movers make too many tests is not followed.
class FollowPolicy {
 public:
  FollowPolicy(Update update, const FindCosts& finding, std::vector<FollowCosts> following);

  /// Whether the next frame is to be followed, in the structure of number current(). `rebuild` says that
  /// nothing of the frame before is known.
  bool follows(std::size_t boxes, std::size_t changed, bool rebuild);

  /// Says that all pairs were found anew, and what that took.
  void found(std::size_t boxes, std::size_t pairs, const std::optional<Statistics>& statistics);

  /// Says that the structure followed a frame, and what that took.
  void followed(std::size_t changed, const std::optional<Statistics>& statistics);

  /// Says that no structure has the boxes of the last frame.
  void lost();

  /// The structure in use, and the one that costs least by what is known. use() gives up one for another.
  std::size_t current() const noexcept { return current_; }
  std::size_t cheapest() const;
  void use(std::size_t structure);

  /// After all structures were tried: a change to another is not yet one of many.
  void settle() noexcept { patience_ = 1; }

  Update update() const noexcept { return update_; }

  /// Whether the structure has the boxes of the last frame.
  bool is_following() const noexcept { return follows_; }

  /// Up to how many changed boxes following cost less, in the last frame.
  std::size_t break_even() const noexcept { return break_even_; }

 private:
  Update update_;
  FindCosts finding_;
  std::vector<FollowCosts> following_;
  std::vector<double> of_mover_;    // by structure: the cost of a mover when it was last used, or expected
  double candidates_of_mover_ = 0;  // what a mover's candidates cost besides, in any structure
  double of_box_;                   // the cost of finding all pairs anew, a box
  bool follows_ = false;
  std::size_t current_ = 0;
  double saved_ = 0;     // what following would have saved since it was last done, or another structure
  double patience_ = 1;  // hysteresis: grows with each change of structures, so that they do not take turns
  std::uint64_t seen_movers_ = 0;  // since the structure was last weighed
  double seen_tests_ = 0;
  double seen_hits_ = 0;
  std::size_t break_even_ = 0;
};

}  // namespace broadside::core

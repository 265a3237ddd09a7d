// MovedBox: a box that changed from one frame to the next, as structures and kernels take it. ChangeSinks:
// where they write its pairs. nan_box(): the sentinel for "no box here".
#pragma once

#include <cstdint>
#include <limits>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/pair.hpp"

namespace broadside::core {

/// Sentinel: a box that has no slot in a structure, or a chain without a first block.
inline constexpr std::uint32_t no_slot = 0xffffffffU;

/// A box of NaNs. It overlaps nothing, not even an infinite box, without a test for presence, so it pads
/// unused SIMD lanes. The absent box would not do: it overlaps an infinite box.
template <int D>
constexpr Box<D> nan_box() noexcept {
  Box<D> box{};
  box.min.fill(std::numeric_limits<float>::quiet_NaN());
  box.max.fill(std::numeric_limits<float>::quiet_NaN());
  return box;
}

/// Made by append_moved(). At least one of `before` and `now` is present.
template <int D>
struct MovedBox {
  Box<D> before;  ///< nan_box() if it was absent
  Box<D> now;     ///< nan_box() if it is absent
  Box<D> bounds;  ///< around both, or whichever is present
  BoxId id;

  /// Where the algorithm keeps it: block * 16 + lane. The algorithm sets it.
  std::uint32_t slot = no_slot;

  bool was_present;
  bool is_present;

  /// Whether its filter changed, so that pairs that overlap both before and now must be reviewed as well.
  bool filter_changed;

  /// Whether `before` and `now` are too far apart to be looked up as one box. The algorithm sets it.
  bool is_far = false;
};

/// Where a search for the changed pairs of moved boxes writes.
struct ChangeSinks {
  PairSink& begun;       ///< a moved box with each box at rest that it overlaps now but not before
  PairSink& ended;       ///< a moved box with each box at rest that it overlapped before but not now
  PairSink& candidates;  ///< pairs that must be tested again; some more than once

  /// By id: 1 for boxes that move, whether or not the structure has moved them yet.
  const std::uint8_t* moves;

  /// Counts the compared pairs, and may end the search by an exception. May be null.
  Checkpoint* checkpoint = nullptr;

  /// Whether all movers are in their places in the structure, and marked, so that each of two finds the
  /// other: then a pair of two is written only once.
  bool all_placed = false;

  /// The search ends soon after it has made more tests.
  std::uint64_t max_tests = std::numeric_limits<std::uint64_t>::max();
};

/// The work of a search.
struct ChangeWork {
  std::uint64_t tests = 0;   ///< pairs of boxes compared
  std::uint64_t blocks = 0;  ///< blocks visited

  ChangeWork& operator+=(const ChangeWork& other) {
    tests += other.tests;
    blocks += other.blocks;
    return *this;
  }
};

}  // namespace broadside::core

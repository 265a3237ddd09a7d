// MovedBox: a box that changed from one frame to the next, as structures and kernels take it, and where they
// write what it meets. nan_box(): the sentinel for "no box here".
#pragma once

#include <cstdint>
#include <limits>

#include "broadside/box.hpp"
#include "broadside/executor.hpp"
#include "broadside/pair.hpp"

namespace broadside::core {

/// Sentinel: a box that has no slot in a structure, or a chain without a first block.
inline constexpr std::uint32_t no_slot = 0xffffffffU;

/// A box of NaNs: overlaps nothing, not even an infinite box, without asking whether it is present. So it
/// pads unused SIMD lanes. The absent box would not do: it overlaps an infinite one.
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

  /// Where the algorithm keeps it: block * 16 + lane. For the algorithm to set.
  std::uint32_t slot = no_slot;

  bool was_present;
  bool is_present;

  /// Whether pairs that overlap before and now are asked for as well, since a filter may have changed what
  /// they mean.
  bool filter_changed;

  /// Whether the two boxes are too far from each other to be looked up as one. For the algorithm to set.
  bool is_far = false;
};

/// Where a search for what moved boxes meet writes.
struct ChangeSinks {
  PairSink& begun;       ///< a moved box with each box at rest that it overlaps now and did not before
  PairSink& ended;       ///< and that it did and does not
  PairSink& candidates;  ///< pairs whose boxes must be looked at again; some more than once

  /// By id: 1 for boxes that move, whether the structure has moved them already or not yet.
  const std::uint8_t* moves;

  /// Counts the pairs compared, and may end the search by an exception; or null.
  Checkpoint* checkpoint = nullptr;
};

/// The work of a search.
struct ChangeWork {
  std::uint64_t tests = 0;   ///< pairs of boxes compared
  std::uint64_t blocks = 0;  ///< blocks looked at

  ChangeWork& operator+=(const ChangeWork& other) {
    tests += other.tests;
    blocks += other.blocks;
    return *this;
  }
};

}  // namespace broadside::core

// MovedBox: a box that changed from one frame to the next, as structures and kernels take it.
#pragma once

#include <cstdint>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::core {

/// Sentinel: a box that has no slot in a structure, or a chain without a first block.
inline constexpr std::uint32_t no_slot = 0xffffffffU;

/// Made by append_moved() of the interface. At least one of `before` and `now` is present.
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

  /// Whether the two boxes are so far apart that each is to be looked up by itself. For the algorithm to set.
  bool is_far = false;
};

}  // namespace broadside::core

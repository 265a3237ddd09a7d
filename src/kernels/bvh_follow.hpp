// Boxes that moved, looked up in a dynamic bounding volume hierarchy and moved in it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "kernels/bvh.hpp"

namespace broadside::kernels {

/// The repairs that a move calls for in the tree, as bits.
inline constexpr std::uint8_t may_shrink = 1;  ///< the old box was at the border of its leaf's bounds
inline constexpr std::uint8_t left_leaf = 2;   ///< the new box is not within the bounds that its leaf had

/// Moves boxes one after the other: writes the pairs of each box that begin and those that end, with all
/// others where the tree has them at its turn, then writes the new box to its slot, enlarges the bounds
/// around it, and writes to `calls_for` what the move calls for. Where the filter changed, all pairs that
/// overlap before or now go to `begun`. A box that is absent now leaves its lane without a box. Returns how
/// many pairs of boxes were compared, each leaf counted as full.
template <int D>
std::uint64_t follow(const WritableBvh<D>& tree, std::span<const MovedBox<D>> moved, std::uint8_t* calls_for,
                     PairSink& begun, PairSink& ended);

}  // namespace broadside::kernels

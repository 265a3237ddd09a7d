// Tests which of given pairs of boxes overlap.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::kernels {

/// Sets flags[i] to 1 if the boxes of pairs[i] are present and overlap, else to 0. Pairs may be in any order.
/// Takes one or two nanoseconds per pair if the boxes are in the cache.
template <int D, typename Real>
void set_overlap_flags(std::span<const Box<D, Real>> boxes, std::span<const Pair> pairs, std::uint8_t* flags);

/// Sets the flags as set_overlap_flags() does, and writes the places of those that changed to `changed`, in
/// order. Returns their number. `changed` must have room for all.
template <int D, typename Real>
std::size_t renew_overlap_flags(std::span<const Box<D, Real>> boxes, std::span<const Pair> pairs,
                                std::uint8_t* flags, std::uint32_t* changed);

/// Copies to `apart`, in order, each pair of boxes that do not overlap or are not both present. Returns the
/// number of these pairs. `apart` must have room for all pairs.
template <int D, typename Real>
std::size_t select_apart(std::span<const Box<D, Real>> boxes, std::span<const Pair> pairs, Pair* apart);

}  // namespace broadside::kernels

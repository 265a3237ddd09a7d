// Pairs of boxes that are known by their places: which of them overlap.
#pragma once

#include <cstdint>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::kernels {

/// Sets flags[i] to 1 if the boxes of pairs[i] are present and overlap, else to 0. In any order in memory; a
/// nanosecond or two a pair where the boxes are in the cache.
template <int D, typename Real>
void set_overlap_flags(std::span<const Box<D, Real>> boxes, std::span<const Pair> pairs, std::uint8_t* flags);

}  // namespace broadside::kernels

// The length that some peers must be given: the extent of a typical box, or a sensible cell size.
#pragma once

#include <span>

#include "broadside/box.hpp"

namespace broadside::lab::peers {

/// The median of a sample of the boxes' longest sides, infinite ones aside. Where the typical box is a point,
/// the mean distance of as many points; never 0. O(n) for the world's extent where it is needed, else O(1).
template <int D>
double typical_extent(std::span<const Box<D>> boxes);

/// The edge of cells for a grid that inserts a box into every cell it touches: `extents` typical extents, and
/// larger where boxes would otherwise be in more than 8 * 2^D cells each on average, or coordinates in more
/// than 2^20 cells.
template <int D>
double cell_size(std::span<const Box<D>> boxes, double extents);

}  // namespace broadside::lab::peers

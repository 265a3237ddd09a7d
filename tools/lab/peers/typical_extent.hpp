// What some peers must be given: the world's extent, that of a typical box, or a sensible cell size.
#pragma once

#include <array>
#include <span>

#include "broadside/box.hpp"

namespace broadside::lab::peers {

/// The least and the greatest coordinate on an axis, infinite ones aside; 0 and 0 if there is none.
template <int D>
std::array<double, 2> range_on(int axis, std::span<const Box<D>> boxes);

/// The axes in the order of the world's extent on them, the longest first; infinite coordinates aside.
template <int D>
std::array<int, D> axes_by_extent(std::span<const Box<D>> boxes);

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

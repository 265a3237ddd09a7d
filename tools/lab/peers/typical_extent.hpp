// Parameters that some peers need: the world's extent, that of a typical box, or a sensible cell size.
#pragma once

#include <array>
#include <span>

#include "broadside/box.hpp"

namespace broadside::lab::peers {

/// The minimum and maximum coordinate on an axis, without infinite ones; 0 and 0 if there are none.
template <int D>
std::array<double, 2> range_on(int axis, std::span<const Box<D>> boxes);

/// The axes sorted by the world's extent on them, the longest first; ignores infinite coordinates.
template <int D>
std::array<int, D> axes_by_extent(std::span<const Box<D>> boxes);

/// The median of a sample of the boxes' longest sides, without infinite ones. If the typical box is a point,
/// the mean distance between as many points; never 0. O(n) if the world's extent is needed, else O(1).
template <int D>
double typical_extent(std::span<const Box<D>> boxes);

/// The cell size for a grid that inserts a box into every cell it touches: `extents` typical extents; larger
/// if boxes would otherwise be in more than 8 * 2^D cells each on average, or coordinates in more than 2^20
/// cells.
template <int D>
double cell_size(std::span<const Box<D>> boxes, double extents);

}  // namespace broadside::lab::peers

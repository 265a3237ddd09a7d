// interval(): intervals, such as genes on a chromosome or bookings of a room, as boxes.
#pragma once

#include "broadside/box.hpp"

namespace broadside {

/// Makes a box of the closed interval from `min` to `max`: it lies on the x axis, and its y is 0.
/// find_pairs(), trackers, worlds and queries take it as any other box. A point on the axis is {x, 0}. Whole
/// numbers are exact up to 2^53.
///
///     find_pairs(boxes_of(genes, [](const Gene& gene) { return interval(gene.start, gene.end); }));
///
/// Half-open intervals, such as those of BED files, need the option `touching = false`: then [100, 200) and
/// [200, 300) do not overlap. An empty interval, such as [100, 100), is then the point 100.
///
/// The absent interval is absent_box<2, double>().
[[nodiscard]] constexpr DoubleBox2 interval(double min, double max) noexcept { return {{min, 0}, {max, 0}}; }

}  // namespace broadside

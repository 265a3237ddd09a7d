// An axis divided into equal cells, as in partition-based joins.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "broadside/box.hpp"

namespace broadside::lab::literature {

/// The range of the finite coordinates on an axis, divided into equal cells. Coordinates beyond it are in the
/// first or last cell. The cell index is monotonic in the coordinate.
struct CutAxis {
  double low = 0;
  double scale = 0;  // cells per unit
  std::size_t cells = 1;

  std::size_t cell(float coordinate) const noexcept {
    if (cells == 1) return 0;
    const double place = (double{coordinate} - low) * scale;
    return place > 0 ? static_cast<std::size_t>(std::min(place, static_cast<double>(cells - 1))) : 0;
  }
};

/// Statistics of boxes on an axis: the range of their finite coordinates, and their mean extent within it.
/// `mean` is 0 if no coordinate is finite.
struct Extent {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();
  double mean = 0;

  /// The length of the range; 0 if no coordinate is finite.
  double length() const noexcept { return low < high ? high - low : 0; }

  CutAxis cut(std::size_t cells) const noexcept {
    if (!(low < high)) return {};
    return {low, static_cast<double>(cells) / (high - low), cells};
  }
};

/// The extent of `boxes`, which must not be empty.
template <int D>
Extent extent_of(std::span<const Box<D>> boxes, int axis) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Extent extent;
  for (const Box<D>& box : boxes) {
    for (const float bound : {box.min[axis], box.max[axis]}) {
      if (std::abs(bound) == infinity) continue;
      extent.low = std::min(extent.low, double{bound});
      extent.high = std::max(extent.high, double{bound});
    }
  }
  if (!(extent.low <= extent.high)) return extent;
  const auto inside = [&extent](float bound) { return std::clamp(double{bound}, extent.low, extent.high); };
  for (const Box<D>& box : boxes) extent.mean += inside(box.max[axis]) - inside(box.min[axis]);
  extent.mean /= static_cast<double>(boxes.size());
  return extent;
}

}  // namespace broadside::lab::literature

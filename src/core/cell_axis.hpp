// CellAxis: which of some cells of one length a coordinate lies in.
#pragma once

#include <algorithm>
#include <cstdint>

namespace broadside::core {

/// The one formula by which a coordinate has a cell. It never falls where the coordinate rises, and clamps:
/// the first and the last cell take in what lies beyond, infinite or not. A NaN is in the first one.
struct CellAxis {
  float low = 0;       ///< where the first cell begins
  float per_unit = 0;  ///< 1 / the length of a cell
  float last = 0;      ///< the number of cells, less one; at most 2^24

  std::uint32_t operator()(float coordinate) const {
    const float cell = (coordinate - low) * per_unit;
    // By way of a signed number, which takes one instruction.
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::min(std::max(0.0F, cell), last)));
  }

  std::uint32_t count() const { return static_cast<std::uint32_t>(last) + 1; }
};

}  // namespace broadside::core

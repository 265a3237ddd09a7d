// CellAxis: maps a coordinate to its cell among cells of one length.
#pragma once

#include <algorithm>
#include <cstdint>

namespace broadside::core {

/// The only formula that maps a coordinate to a cell. It is monotonic, and it clamps: coordinates beyond the
/// cells, even infinite ones, are in the first or the last cell. A NaN is in the first.
struct CellAxis {
  float low = 0;       ///< where the first cell begins
  float per_unit = 0;  ///< 1 / the length of a cell
  float last = 0;      ///< the number of cells, less one; at most 2^24

  std::uint32_t operator()(float coordinate) const {
    const float cell = (coordinate - low) * per_unit;
    // Conversion through a signed integer takes one instruction.
    return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::min(std::max(0.0F, cell), last)));
  }

  std::uint32_t count() const { return static_cast<std::uint32_t>(last) + 1; }
};

/// The least float in the cell or after it. `cell` is at least 1.
float border_before(const CellAxis& axis, std::uint32_t cell);

}  // namespace broadside::core

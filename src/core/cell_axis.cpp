// The borders between cells, as exact as the cells.
#include "core/cell_axis.hpp"

#include <cmath>
#include <limits>

#include "core/bit_cast.hpp"
#include "core/radix_sort.hpp"

namespace broadside::core {
namespace {

/// The inverse of sort_key().
float float_of(std::uint32_t key) {
  return core::bit_cast<float>(key ^ (key >> 31 != 0 ? 0x80000000U : 0xffffffffU));
}

}  // namespace

float border_before(const CellAxis& axis, std::uint32_t cell) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  // Rounding may have moved it by a little.
  float border = axis.low + static_cast<float>(cell) / axis.per_unit;
  for (int i = 0; i < 4 && axis(border) < cell; ++i) border = std::nextafter(border, infinity);
  for (int i = 0; i < 4 && axis(std::nextafter(border, -infinity)) >= cell; ++i)
    border = std::nextafter(border, -infinity);
  if (axis(border) >= cell && axis(std::nextafter(border, -infinity)) < cell) return border;
  std::uint32_t below = sort_key(-infinity);
  std::uint32_t at = sort_key(infinity);
  while (at - below > 1) {
    const std::uint32_t middle = below + (at - below) / 2;
    (axis(float_of(middle)) < cell ? below : at) = middle;
  }
  return float_of(at);
}

}  // namespace broadside::core

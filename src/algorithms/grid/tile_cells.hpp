// TileCells: the rows and buckets into which a search sorts boxes that fit in a core's cache.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "broadside/box.hpp"

#include "core/cell_axis.hpp"
#include "core/sample.hpp"

namespace broadside::algorithm {

/// What decides about the cells, by axis.
template <int D>
struct TileStats {
  std::array<float, D> low;   ///< the least finite minimum
  std::array<float, D> high;  ///< the greatest finite minimum
  std::array<float, D> side;  ///< the boxes' mean extent

  /// Of at most 1,024 of the boxes.
  static TileStats of(std::span<const Box<D>> boxes);

  /// Of a sorted sample, without far outliers.
  static TileStats of(const core::Sample<D>& sample);

  /// Whether on some axis minima are in half the range of `other` or less.
  bool is_narrower_than(const TileStats& other) const;
};

/// Rows over all axes but the swept one, and buckets of the swept axis in each row. The outermost ones take
/// in what lies beyond.
template <int D>
struct TileCells {
  static constexpr int across = D - 1;

  /// With more boxes, the cells of a whole grid cost less. Also, a bucket's number in a tile has 16 bits.
  static constexpr std::size_t max_boxes = D == 2 ? std::size_t{1} << 15 : std::size_t{1} << 14;

  /// The minimum of buckets.count(), which is a power of two.
  static constexpr std::size_t min_buckets = 16;

  /// Chooses cells that suit evenly spread boxes, at most max_boxes.
  static TileCells choose(const TileStats<D>& stats, std::size_t boxes);

  std::size_t rows() const {
    std::size_t rows = 1;
    for (const core::CellAxis& axis : row_axes) rows *= axis.count();
    return rows;
  }

  /// The number of a row, from its place on each axis across the swept one.
  std::uint32_t row(const std::array<std::uint32_t, across>& at) const {
    if constexpr (D == 2)
      return at[0];
    else
      return at[1] * row_axes[0].count() + at[0];
  }

  std::array<int, D> axes;                      ///< the swept axis, then the others
  core::CellAxis buckets;                       ///< of the swept axis
  std::array<core::CellAxis, across> row_axes;  ///< of the others
};

}  // namespace broadside::algorithm

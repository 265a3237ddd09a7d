// GridLayout: which axes of a grid have cells, how many, and which cell a coordinate lies in.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "broadside/box.hpp"

#include "core/cell_axis.hpp"
#include "core/sample.hpp"

namespace broadside::algorithm {

/// The maximum number of cells per box if the caller sets their size.
inline constexpr double max_cells_per_box = 4;

/// Cells over all axes but the swept one. On each axis they are equally wide, and the outermost ones take in
/// what lies beyond. In 3D, the cells along the first gridded axis form a row, and rows lie one above the
/// other; in 2D, a cell is a row. Consecutive rows form a slab, which can be searched by itself.
template <int D>
class GridLayout {
 public:
  static constexpr int gridded = D - 1;

  /// The maximum number of bits in a cell's number.
  static constexpr int cell_bits = 20;

  /// Chooses axes and cells for `count` boxes by the estimated cost of a search; or cells `cell` wide, unless
  /// there would be too many.
  void choose(const core::Sample<D>& sample, std::size_t count, std::optional<double> cell);

  /// The axes of the caller's boxes: first the swept one, then the gridded ones.
  const std::array<int, D>& axes() const noexcept { return axes_; }

  /// The cells on the axes but the swept one.
  const std::array<core::CellAxis, gridded>& cell_axes() const noexcept { return cell_axes_; }

  std::size_t cells() const noexcept { return cell_count_; }
  std::size_t row_length() const noexcept { return D == 2 ? 1 : cells_[0]; }
  std::size_t rows() const noexcept { return cells_[gridded - 1]; }
  std::size_t slabs() const noexcept { return slab_begin_.size() - 1; }

  /// The first row of a slab; for slabs(), the number of rows.
  std::size_t slab_begin(std::size_t slab) const { return slab_begin_[slab]; }

  /// The slab that a row is in.
  std::size_t slab_of(std::size_t row) const { return slab_of_[row]; }

  /// The cell that a coordinate lies in on the axis `axes()[1 + axis]`.
  std::uint32_t cell_of(float coordinate, int axis) const { return cell_axes_[axis](coordinate); }

  /// The row that a box's minimum lies in, and its cell within the row.
  std::size_t row_of(const Box<D>& box) const { return cell_of(box.min[axes_[D - 1]], gridded - 1); }
  std::size_t column_of(const Box<D>& box) const { return D == 2 ? 0 : cell_of(box.min[axes_[1]], 0); }

  /// The least coordinate in the next row or column; NaN for the last one, so that no box reaches it.
  float row_border(std::size_t row) const { return borders_[gridded - 1][row]; }
  float column_border(std::size_t column) const { return borders_[0][column]; }

  /// The least coordinate in the slab after a row's slab; NaN for the last one.
  float slab_border(std::size_t row) const { return slab_border_[row]; }

 private:
  void set(const core::Sample<D>& sample, const std::array<double, gridded>& cells);
  void set_borders(int axis);
  void set_slabs();

  std::array<int, D> axes_{};
  std::array<std::uint32_t, gridded> cells_{};
  std::array<core::CellAxis, gridded> cell_axes_{};
  std::size_t cell_count_ = 0;
  std::array<std::vector<float>, gridded> borders_;
  std::vector<std::uint32_t> slab_begin_;
  std::vector<std::uint8_t> slab_of_;
  std::vector<float> slab_border_;
};

}  // namespace broadside::algorithm

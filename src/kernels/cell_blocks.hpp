// Levels of cells with boxes in blocks of sixteen, and the search for what a box meets in them.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "kernels/block.hpp"

namespace broadside::kernels {

inline constexpr std::size_t most_cell_levels = 8;

/// What is known of a block without looking into it.
struct BlockHead {
  std::uint32_t next;  ///< the next block of the same cell, or no_slot
  std::uint32_t cell;  ///< the cell, counted over all levels
  std::uint16_t used;  ///< a bit for each place that holds a box
  std::uint16_t
      moving;  ///< a bit for each box that is not where it says: its bounds hold where it was and is
};

/// Cells of equal size for boxes of about one size. Each box is in the cell that its minimum lies in; what
/// lies outside of all cells is in the outermost ones.
template <int D>
struct CellLevel {
  std::array<float, D> low{};      ///< where the first cell begins
  std::array<float, D> inverse{};  ///< 1 / the length of a cell
  std::array<float, D> last{};     ///< the number of cells on the axis, less one
  std::array<std::uint32_t, D> stride{};
  std::array<float, D> extent{};  ///< no box is longer
  std::uint32_t first_cell = 0;
  std::uint32_t boxes = 0;  ///< how many there are

  /// Which cell on the axis a coordinate lies in. Never falls where the coordinate rises.
  std::uint32_t on_axis(int axis, float value) const {
    const float at = (value - low[axis]) * inverse[axis];
    return at > 0 ? static_cast<std::uint32_t>(std::min(at, last[axis])) : 0;
  }

  /// The cell of a box whose minimum this is, counted over all levels.
  std::uint32_t cell(const std::array<float, D>& min) const {
    std::uint32_t place = first_cell;
    for (int axis = 0; axis < D; ++axis) place += on_axis(axis, min[axis]) * stride[axis];
    return place;
  }
};

/// All levels, their cells and the blocks.
template <int D>
struct CellsView {
  std::span<const CellLevel<D>> levels;
  const std::uint32_t* first;  ///< by cell, over all levels: the first block, or no_slot
  const BlockHead* heads;
  const Block<D>* blocks;
};

/// What a search went through.
struct CellWork {
  std::uint64_t tests = 0;   ///< pairs of boxes compared
  std::uint64_t blocks = 0;  ///< blocks looked at
};

/// Where find_changes() writes.
struct CellSinks {
  PairSink& begun;       ///< a query with each box at rest that it overlaps now and did not before
  PairSink& ended;       ///< and that it did and does not
  PairSink& candidates;  ///< with each moving box that one of its two boxes overlaps; some more than once

  /// By id: 1 for boxes that move, whether their entries say so already or not yet.
  const std::uint8_t* moves;
};

/// Writes what each query's box meets and met, but for itself. Where all are asked for, every box at rest
/// that overlaps one of its two boxes is a candidate.
template <int D>
CellWork find_changes(const CellsView<D>& cells, std::span<const MovedBox<D>> queries,
                      const CellSinks& sinks);

/// Writes the pair of each query's box `now` with every one of a greater id that overlaps it.
template <int D>
CellWork find_later(const CellsView<D>& cells, std::span<const MovedBox<D>> queries, PairSink& pairs);

}  // namespace broadside::kernels

// The kernels of followers: boxes that moved against boxes that are kept in blocks, in cells of blocks or in
// a run, and which overlaps begin or end by it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "core/cell_axis.hpp"
#include "kernels/block.hpp"
#include "kernels/block_pool.hpp"
#include "kernels/run.hpp"

namespace broadside::kernels {

inline constexpr std::size_t max_cell_levels = 8;

/// Cells of equal size for boxes of about one size. Each box is in the cell that its minimum lies in; what
/// lies outside of all cells is in the outermost ones.
template <int D>
struct CellLevel {
  std::array<core::CellAxis, D> axes;
  std::array<std::uint32_t, D> stride{};
  std::array<float, D> extent{};  ///< no box is longer
  std::uint32_t first_cell = 0;
  std::uint32_t boxes = 0;  ///< how many there are

  /// The cell of a box whose minimum this is, counted over all levels.
  std::uint32_t cell(const std::array<float, D>& min) const {
    std::uint32_t cell = first_cell;
    for (int axis = 0; axis < D; ++axis) cell += axes[axis](min[axis]) * stride[axis];
    return cell;
  }
};

/// All levels, their cells and the blocks.
template <int D>
struct CellsView {
  std::span<const CellLevel<D>> levels;
  const std::uint32_t* first;  ///< by cell, over all levels: the first block, or no_slot
  BlocksView<D> blocks;
};

/// A moved box, by its place in a list, and the first block of a chain that it is to be compared with.
struct BlockTask {
  std::uint32_t moved;
  std::uint32_t block;
};

/// Each finds what moved boxes overlap now or did before, except themselves. A box at rest that overlaps
/// exactly one of a mover's two boxes is an event; the many pairs that go on are not written. With another
/// mover, or where `filter_changed`, each pair that overlaps before or now is a candidate.
///
/// In the blocks of tasks; in the cells of levels, where each box is in one cell.
template <int D>
core::ChangeWork find_changes(const BlocksView<D>& blocks, std::span<const MovedBox<D>> moved,
                              std::span<const BlockTask> tasks, const core::ChangeSinks& sinks);
template <int D>
core::ChangeWork find_changes(const CellsView<D>& cells, std::span<const MovedBox<D>> moved,
                              const core::ChangeSinks& sinks);

/// For one moved box, against the places [begin, end) of a run. At its turn some other movers are still where
/// they were, and others where they are now; once all have had their turn, each event of two movers was found
/// at one of them.
template <int D>
void find_changes(const Run<D>& run, std::size_t begin, std::size_t end, const MovedBox<D>& moved,
                  const core::ChangeSinks& sinks);

}  // namespace broadside::kernels

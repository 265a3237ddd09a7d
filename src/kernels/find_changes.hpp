// The kernels of followers: they compare moved boxes with boxes kept in blocks, in cells of blocks or in a
// run, and find the overlaps that begin or end.
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

/// Cells of equal size for boxes of about one size. Each box is in the cell of its minimum; boxes outside all
/// cells are in the outermost ones.
template <int D>
struct CellLevel {
  std::array<core::CellAxis, D> axes;
  std::array<std::uint32_t, D> stride{};
  std::array<float, D> extent{};  ///< no box is longer
  std::uint32_t first_cell = 0;
  std::uint32_t boxes = 0;  ///< how many boxes the level has

  /// The cell of a box with this minimum, counted over all levels.
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
  bool are_cached = false;  ///< whether the blocks are most likely in the cache, so that none is prefetched
};

/// A moved box, by its place in a list, and the first block of a chain to compare it with.
struct BlockTask {
  std::uint32_t moved;
  std::uint32_t block;
};

/// These find the boxes that moved boxes overlap now or overlapped before, except themselves. A box at rest
/// that overlaps exactly one of a mover's two boxes makes an event; the many continuing pairs are not
/// written. With another mover, or if `filter_changed`, each pair that overlaps before or now is a candidate.
///
/// The first searches the blocks of `tasks`, the second the cells of all levels. Each box is in one cell.
template <int D>
core::ChangeWork find_changes(const BlocksView<D>& blocks, std::span<const MovedBox<D>> moved,
                              std::span<const BlockTask> tasks, const core::ChangeSinks& sinks);
template <int D>
core::ChangeWork find_changes(const CellsView<D>& cells, std::span<const MovedBox<D>> moved,
                              const core::ChangeSinks& sinks);

/// Compares one moved box with the places [begin, end) of a run. At that time, some other movers are still at
/// their old places and others at their new ones. After the turns of all movers, each event of two movers has
/// been found in the turn of one of them.
template <int D>
void find_changes(const Run<D>& run, std::size_t begin, std::size_t end, const MovedBox<D>& moved,
                  const core::ChangeSinks& sinks);

}  // namespace broadside::kernels

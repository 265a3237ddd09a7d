// The cells of a grid that stays from frame to frame: boxes filed in every cell that they touch.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "kernels/toggle.hpp"

namespace broadside::own {

/// Cells by their numbers on each axis, both ends included.
template <int D>
struct CellRange {
  std::array<std::int32_t, D> first;
  std::array<std::int32_t, D> last;

  bool contains(const std::array<std::int32_t, D>& cell) const {
    bool inside = true;
    for (int axis = 0; axis < D; ++axis) inside &= first[axis] <= cell[axis] && cell[axis] <= last[axis];
    return inside;
  }

  /// How many cells there are on an axis beyond the first: in unsigned numbers, for the difference of two
  /// that are far from 0 on either side is no std::int32_t.
  std::uint32_t more(int axis) const {
    return static_cast<std::uint32_t>(last[axis]) - static_cast<std::uint32_t>(first[axis]);
  }

  friend bool operator==(const CellRange&, const CellRange&) = default;
};

/// Calls `visit` with each cell of a range.
template <int D, typename Visit>
void for_each_cell(const CellRange<D>& range, Visit visit) {
  std::array<std::int32_t, D> cell = range.first;
  if constexpr (D == 3) {
    for (cell[2] = range.first[2]; cell[2] <= range.last[2]; ++cell[2]) {
      for (cell[1] = range.first[1]; cell[1] <= range.last[1]; ++cell[1])
        for (cell[0] = range.first[0]; cell[0] <= range.last[0]; ++cell[0]) visit(cell);
    }
  } else {
    for (cell[1] = range.first[1]; cell[1] <= range.last[1]; ++cell[1])
      for (cell[0] = range.first[0]; cell[0] <= range.last[0]; ++cell[0]) visit(cell);
  }
}

/// Cells in levels, each level's four times as wide as those of the one below; a box is in the first level in
/// which it reaches over few of them. The cells of a level share a table of blocks, in which each cell has
/// its place by its numbers alone: so no world is declared, and cells far apart may share a block. Of the
/// last level there is one cell, for boxes that nothing bounds.
template <int D>
class GridCells {
 public:
  using Block = kernels::Block<D>;
  static constexpr int levels = 17;

  /// Where a box is filed: a level, and the finest level's cells that it touches.
  struct Place {
    int level;
    CellRange<D> finest;
  };

  /// Starts over with these boxes, whose ids are their places; absent ones are left out. Cells of the first
  /// level are `sizes` wide on each axis, and a box reaches over `span` of them at most before it goes to the
  /// next one. There will be room for as many boxes as there are `later`.
  void start(const std::array<double, D>& sizes, int span, std::span<const Box<D>> boxes,
             std::span<const Box<D>> later);

  Place place_of(const Box<D>& box) const;

  /// The cells of another level that hold those of the finest one.
  static CellRange<D> cells_at(int level, const CellRange<D>& finest) {
    if (level == 0) [[likely]]
      return finest;
    CellRange<D> cells{};
    if (level == levels - 1) return cells;
    for (int axis = 0; axis < D; ++axis) {
      cells.first[axis] = finest.first[axis] >> (2 * level);
      cells.last[axis] = finest.last[axis] >> (2 * level);
    }
    return cells;
  }

  void insert(int level, const std::array<std::int32_t, D>& cell, const Box<D>& box, BoxId id);

  /// Takes out the box, which must be there.
  void erase(int level, const std::array<std::int32_t, D>& cell, BoxId id);

  void insert(const Place& place, const Box<D>& box, BoxId id);
  void erase(const Place& place, BoxId id);

  /// To be called when every box that is filed is so in all its cells: makes the tables larger or smaller
  /// where they have become many times too small or too large.
  void fit_tables() {
    for (; unfit_ != 0; unfit_ &= unfit_ - 1) fit_table(std::countr_zero(unfit_));
  }

  /// A bit for each level that has boxes.
  std::uint32_t occupied() const noexcept { return occupied_; }

  /// Appends the blocks of a range of a level's cells, but for those that `except` has as well; perhaps some
  /// more.
  void gather(int level, const CellRange<D>& cells, const CellRange<D>* except, std::vector<Block*>& blocks) {
    Level& table = levels_[level];
    std::uint64_t count = 1;
    for (int axis = 0; axis < D; ++axis) count *= std::min<std::uint64_t>(cells.more(axis), 1 << 20) + 1;
    if (count >= table.heads.size()) {
      for (Block& first : table.heads) add_cell(first, blocks);
      return;
    }
    for_each_cell<D>(cells, [&](const auto& cell) {
      if (except == nullptr || !except->contains(cell)) add_cell(head(table, cell), blocks);
    });
  }

  /// Appends a cell's first block and those that go on where it is full.
  void add_cell(Block& first, std::vector<Block*>& blocks) {
    for (Block* block = &first;; block = &more_[next(*block)]) {
      blocks.push_back(block);
      if (next(*block) == none) [[likely]]
        return;
    }
  }

  /// Sets `blocks` to the first ones of a range of at most two cells on each axis, and asks the processor for
  /// them. Returns how many there are; 0 if the range is larger. They hold while version() does.
  static constexpr std::uint32_t most_near = 1U << D;
  std::uint32_t find_near(int level, const CellRange<D>& cells, Block** blocks) {
    Level& table = levels_[level];
    std::array<std::uint32_t, D> more;
    for (int axis = 0; axis < D; ++axis) {
      more[axis] = cells.more(axis);
      if (more[axis] > 1) return 0;
    }
    // Whether there is one or two is as good as random: no branches.
    std::uint32_t count = 0;
    for (std::uint32_t corner = 0; corner < most_near; ++corner) {
      std::array<std::int32_t, D> cell;
      std::uint32_t inside = 1;
      for (int axis = 0; axis < D; ++axis) {
        const std::uint32_t step = corner >> axis & 1;
        cell[axis] = cells.first[axis] + static_cast<std::int32_t>(step & more[axis]);
        inside &= more[axis] | (step ^ 1);
      }
      Block* const block = &head(table, cell);
      blocks[count] = block;
      count += inside;
      for (std::size_t line = 0; line < sizeof(Block); line += 64)
        __builtin_prefetch(reinterpret_cast<const char*>(block) + line);
    }
    return count;
  }
  std::uint32_t version() const noexcept { return version_; }

  /// Asks the processor for the blocks of the box's cells.
  void prefetch(const Place& place) const;

  /// How many boxes a block holds.
  static std::uint32_t filled(const Block& block) {
    return static_cast<std::uint32_t>(block.max[0][Block::capacity]);
  }

  static void write(Block& block, std::uint32_t place, const Box<D>& box) {
    for (int axis = 0; axis < D; ++axis) {
      block.min[axis][place] = box.min[axis];
      block.max[axis][place] = box.max[axis];
    }
  }

  std::size_t references() const noexcept { return references_; }
  std::size_t cells() const noexcept;
  std::size_t bytes() const noexcept;

 private:
  static constexpr std::uint32_t none = 0xffffffffU;

  struct Level {
    std::vector<Block> heads;  // as many as a power of two
    std::array<std::uint32_t, D> steps{};
    std::size_t references = 0;
  };

  static void set_filled(Block& block, std::uint32_t count) {
    block.max[0][Block::capacity] = static_cast<float>(count);
  }
  static std::uint32_t& next(Block& block) { return block.id[Block::capacity]; }
  static void make_empty(Block& block);

  std::array<std::size_t, levels> references_of(std::span<const Box<D>> boxes) const;
  void make_table(Level& level, std::size_t references);
  void fit_table(int number);
  void free_blocks(Block& first);
  void compact();
  static std::size_t block_of(const Level& level, const std::array<std::int32_t, D>& cell) {
    auto place = static_cast<std::uint32_t>(cell[0]);
    for (int axis = 1; axis < D; ++axis) place += static_cast<std::uint32_t>(cell[axis]) * level.steps[axis];
    return place & (level.heads.size() - 1);
  }
  static Block& head(Level& level, const std::array<std::int32_t, D>& cell) {
    return level.heads[block_of(level, cell)];
  }
  std::uint32_t take_block();

  std::array<float, D> per_unit_{};
  float span_ = 1;
  std::array<Level, levels> levels_;
  std::uint32_t occupied_ = 0;
  std::uint32_t unfit_ = 0;  // a bit for each level whose table is to be made anew
  std::vector<Block> more_;  // the blocks that go on where one is full, and free ones
  std::uint32_t free_ = none;
  std::size_t used_ = 0;  // of them, those that are not free
  std::size_t references_ = 0;
  std::uint32_t version_ = 0;  // of the tables
};

}  // namespace broadside::own

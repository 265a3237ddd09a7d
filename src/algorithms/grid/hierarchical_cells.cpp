// HierarchicalCells.
//
// A box is in one cell: that of its minimum, on the level for its size. So a search looks into the cells from
// the box's minimum, minus the level's greatest extent, to its maximum. All blocks of a cell but the first
// are full: a box is added to the first block, or to a new one before it, and a box removed from another
// block is replaced by one from the first.
#include "algorithms/grid/hierarchical_cells.hpp"

#include <bit>

namespace broadside::algorithm {

using kernels::block_size;
using kernels::no_slot;

template <int D>
void HierarchicalCells<D>::build(std::span<const Box<D>> boxes, std::span<const Box<D>> like) {
  reserve(boxes.size());
  levels_.choose(like);
  do {
    const std::uint32_t cells = levels_.lay_out();
    counts_.assign(cells, 0);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!is_present(boxes[i])) continue;
      slot_[i] = levels_[levels_.level_of(boxes[i])].cell(boxes[i].min);
      ++counts_[slot_[i]];
    }
  } while (levels_.shrink_crowded_cells(counts_));
  fill(boxes);
}

/// Inserts `boxes`: slot_ has the cell of each box, and counts_ the number of boxes in each cell.
template <int D>
void HierarchicalCells<D>::fill(std::span<const Box<D>> boxes) {
  first_.assign(counts_.size(), no_slot);
  pool_.clear();
  stale_.clear();
  boxes_ = 0;
  levels_.clear();

  // In the order of cells, so that neighbours in space are neighbours in memory. A cell's first block is its
  // last one in memory, and the only one that need not be full.
  const auto blocks_for = [](std::uint32_t count) {
    return (count + std::uint32_t{block_size} - 1) / std::uint32_t{block_size};
  };
  std::size_t blocks = 0;
  for (const std::uint32_t count : counts_) blocks += blocks_for(count);
  pool_.reserve(blocks);
  for (std::uint32_t cell = 0; cell < counts_.size(); ++cell) {
    const std::uint32_t own = blocks_for(counts_[cell]);
    for (std::uint32_t block = 0; block < own; ++block) pool_.add_block(first_[cell], cell);
    if (own > 0) counts_[cell] += (first_[cell] + 1 - own) * std::uint32_t{block_size};
  }
  // counts_ now has the end of each cell's slots. Slots are assigned from there down.
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!is_present(boxes[i])) continue;
    slot_[i] = --counts_[slot_[i]];
    pool_.put(slot_[i], boxes[i], BoxId(i));
    const std::size_t level = levels_.level_of(boxes[i]);
    levels_.widen(level, boxes[i]);
    ++levels_[level].boxes;
    ++boxes_;
  }
}

template <int D>
void HierarchicalCells<D>::move(core::MovedBox<D>& box) {
  if (!box.is_present) {
    remove(box.id, box.before);
    return;
  }
  const std::size_t level = levels_.level_of(box.now);
  if (stays(box, level)) {
    const std::uint32_t slot = slot_[index(box.id)];
    pool_.mark(slot);
    levels_.widen(level, box.now);
    pool_.set(slot, box.bounds);
  } else {
    if (box.was_present) remove(box.id, box.before);
    insert(box.id, box.now, level);
    pool_.mark(slot_[index(box.id)]);
  }
  box.slot = slot_[index(box.id)];
  box.is_far = is_far(box);
}

template <int D>
void HierarchicalCells<D>::move_within_cell(core::MovedBox<D>& box) {
  if (!box.is_present) return;
  const std::size_t level = levels_.level_of(box.now);
  if (!stays(box, level) || levels_.is_widened(level, box.now)) return;
  box.slot = slot_[index(box.id)];
  pool_.mark_beside_others(box.slot);
  pool_.set(box.slot, box.bounds);
  box.is_far = is_far(box);
}

template <int D>
bool HierarchicalCells<D>::is_far(const core::MovedBox<D>& box) const {
  bool is_far = false;
  for (int axis = 0; axis < D && box.was_present; ++axis) {
    const float extents =
        box.before.max[axis] - box.before.min[axis] + (box.now.max[axis] - box.now.min[axis]);
    is_far |= box.bounds.max[axis] - box.bounds.min[axis] - extents > levels_.smallest_cell()[axis];
  }
  return is_far;
}

template <int D>
void HierarchicalCells<D>::insert(BoxId id, const Box<D>& box, std::size_t level) {
  levels_.widen(level, box);
  const std::uint32_t cell = levels_[level].cell(box.min);
  if (first_[cell] == no_slot || pool_.is_full(first_[cell])) pool_.add_block(first_[cell], cell);
  slot_[index(id)] = pool_.insert(first_[cell], box, id);
  ++levels_[level].boxes;
  ++boxes_;
}

template <int D>
void HierarchicalCells<D>::drop_stale() {
  for (const std::uint32_t slot : stale_) {
    pool_.erase(slot);
    std::size_t level = levels_.count() - 1;
    while (levels_[level].first_cell > pool_.head(slot / block_size).owner) --level;
    --levels_[level].boxes;
  }
  boxes_ -= stale_.size();
  for (const std::uint32_t slot : stale_) close_hole(slot);
  stale_.clear();
}

/// Makes every block of a cell but the first full again, and removes empty ones.
template <int D>
void HierarchicalCells<D>::close_hole(std::uint32_t slot) {
  const std::uint32_t block = slot / block_size;
  const std::uint32_t cell = pool_.head(block).owner;
  if (cell == no_slot) return;  // the block is gone already
  std::uint32_t& first = first_[cell];
  while (first != no_slot && pool_.head(first).used == 0) pool_.remove_block(first, first);
  if (pool_.head(block).owner == no_slot || block == first) return;
  const std::uint32_t from = first * std::uint32_t{block_size} +
                             static_cast<std::uint32_t>(std::bit_width(pool_.head(first).used) - 1);
  const BoxId id = pool_.id(from);
  pool_.put(slot, pool_.box(from), id);
  if (pool_.is_marked(from)) pool_.mark(slot);
  pool_.erase(from);
  slot_[index(id)] = slot;
  if (pool_.head(first).used == 0) pool_.remove_block(first, first);
}

template class HierarchicalCells<2>;
template class HierarchicalCells<3>;

}  // namespace broadside::algorithm

// Cells and their blocks of boxes.
//
// A box is in one cell, that of its minimum, on the level for its size. So whoever looks for what a box meets
// looks into the cells from its minimum less the level's greatest extent to its maximum. All blocks of a cell
// but the first are full: a box is put into the first, or into a new one before it, and where one is taken
// from another block, one of the first fills the hole.
#include "algorithms/hierarchical_grid/cells.hpp"

#include <algorithm>
#include <bit>

#include "core/nan_box.hpp"

namespace broadside::own {
namespace {

using core::no_slot;
using kernels::block_size;

constexpr std::uint16_t all_used = 0xffff;
constexpr std::uint32_t no_cell = 0xffffffffU;

}  // namespace

template <int D>
void HierarchicalGridCells<D>::build(std::span<const Box<D>> boxes, std::span<const Box<D>> like) {
  reserve(boxes.size());
  levels_.choose(like);
  do {
    const std::uint32_t cells = levels_.lay_out();
    counts_.assign(cells, 0);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!is_present(boxes[i])) continue;
      place_[i] = levels_[levels_.level_of(boxes[i])].cell(boxes[i].min);
      ++counts_[place_[i]];
    }
  } while (levels_.disperse_crowds(counts_));
  file(boxes);
}

/// Files `boxes`, of which place_ says in which cell each is, and counts_ how many are in each.
template <int D>
void HierarchicalGridCells<D>::file(std::span<const Box<D>> boxes) {
  first_.assign(counts_.size(), no_slot);
  heads_.clear();
  blocks_.clear();
  free_.clear();
  stale_.clear();
  boxes_ = 0;
  levels_.clear();

  // In the order of cells: neighbours in space are neighbours in memory. A cell's first block is the last one
  // there, and the one that need not be full.
  std::size_t blocks = 0;
  for (const std::uint32_t count : counts_) blocks += (count + block_size - 1) / block_size;
  reserve_blocks(blocks);
  for (std::uint32_t cell = 0; cell < counts_.size(); ++cell) {
    for (std::uint32_t count = 0; count < counts_[cell]; count += block_size) new_block(cell);
    if (first_[cell] != no_slot)
      counts_[cell] +=
          (first_[cell] + 1) * block_size - (counts_[cell] + block_size - 1) / block_size * block_size;
  }
  // counts_ is now the end of each cell's places, from which they are given out.
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!is_present(boxes[i])) continue;
    const std::uint32_t cell = place_[i];
    place_[i] = --counts_[cell];
    kernels::BlockHead& head = heads_[place_[i] / block_size];
    head.used = static_cast<std::uint16_t>(head.used | 1U << place_[i] % block_size);
    blocks_[place_[i] / block_size].id[place_[i] % block_size] = static_cast<std::uint32_t>(i);
    write(place_[i], boxes[i]);
    const std::size_t level = levels_.level_of(boxes[i]);
    levels_.widen(level, boxes[i]);
    ++levels_[level].boxes;
    ++boxes_;
  }
}

template <int D>
void HierarchicalGridCells<D>::move(BoxId id, const Box<D>& before, const Box<D>& now, const Box<D>& bounds) {
  const std::uint32_t place = place_[index(id)];
  kernels::BlockHead& head = heads_[place / block_size];
  const std::size_t level = levels_.level_of(now);
  if (levels_[level].cell(now.min) == head.cell) {
    head.moving = static_cast<std::uint16_t>(head.moving | 1U << place % block_size);
    levels_.widen(level, now);
    write(place, bounds);
    return;
  }
  remove(id, before);
  put(id, now, level, true);
}

template <int D>
void HierarchicalGridCells<D>::remove(BoxId id, const Box<D>& before) {
  const std::uint32_t place = place_[index(id)];
  kernels::BlockHead& head = heads_[place / block_size];
  head.moving = static_cast<std::uint16_t>(head.moving | 1U << place % block_size);
  write(place, before);
  stale_.push_back(place);
}

template <int D>
void HierarchicalGridCells<D>::settle(BoxId id, const Box<D>& box) {
  const std::uint32_t place = place_[index(id)];
  kernels::BlockHead& head = heads_[place / block_size];
  head.moving = static_cast<std::uint16_t>(head.moving & ~(1U << place % block_size));
  write(place, box);
}

template <int D>
void HierarchicalGridCells<D>::put(BoxId id, const Box<D>& box, std::size_t level, bool is_moving) {
  levels_.widen(level, box);
  const std::uint32_t cell = levels_[level].cell(box.min);
  std::uint32_t block = first_[cell];
  if (block == no_slot || heads_[block].used == all_used) block = new_block(cell);
  kernels::BlockHead& head = heads_[block];
  const auto slot = static_cast<std::uint32_t>(std::countr_one(head.used));
  head.used = static_cast<std::uint16_t>(head.used | 1U << slot);
  head.moving = static_cast<std::uint16_t>(head.moving | std::uint32_t{is_moving} << slot);
  blocks_[block].id[slot] = index(id);
  place_[index(id)] = block * std::uint32_t{block_size} + slot;
  write(place_[index(id)], box);
  ++levels_[level].boxes;
  ++boxes_;
}

/// Memory for an eighth more blocks than `count`. They are the most of what is kept: twice as many, as a
/// vector takes by itself, would be too many.
template <int D>
void HierarchicalGridCells<D>::reserve_blocks(std::size_t count) {
  constexpr std::size_t spare = 16;
  heads_.reserve(count + count / 8 + spare);
  blocks_.reserve(count + count / 8 + spare);
}

template <int D>
std::uint32_t HierarchicalGridCells<D>::new_block(std::uint32_t cell) {
  std::uint32_t block = static_cast<std::uint32_t>(blocks_.size());
  if (free_.empty()) {
    if (blocks_.size() == blocks_.capacity()) reserve_blocks(blocks_.size());
    heads_.emplace_back();
    blocks_.emplace_back();
  } else {
    block = free_.back();
    free_.pop_back();
  }
  heads_[block] = {first_[cell], cell, 0, 0};
  blocks_[block].clear();
  first_[cell] = block;
  return block;
}

template <int D>
void HierarchicalGridCells<D>::write(std::uint32_t place, const Box<D>& box) {
  blocks_[place / block_size].set(place % block_size, box);
}

template <int D>
void HierarchicalGridCells<D>::drop_stale() {
  for (const std::uint32_t place : stale_) {
    kernels::BlockHead& head = heads_[place / block_size];
    const std::uint32_t others = ~(1U << place % block_size);
    head.used = static_cast<std::uint16_t>(head.used & others);
    head.moving = static_cast<std::uint16_t>(head.moving & others);
    write(place, core::nan_box<D>());
    std::size_t level = levels_.count() - 1;
    while (levels_[level].first_cell > head.cell) --level;
    --levels_[level].boxes;
  }
  boxes_ -= stale_.size();
  for (const std::uint32_t place : stale_) close_hole(place);
  stale_.clear();
}

/// Keeps every block of a cell but the first full, and none that is empty.
template <int D>
void HierarchicalGridCells<D>::close_hole(std::uint32_t place) {
  const std::uint32_t block = place / block_size;
  const std::uint32_t cell = heads_[block].cell;
  if (cell == no_cell) return;  // the block is gone already
  while (first_[cell] != no_slot && heads_[first_[cell]].used == 0) {
    const std::uint32_t empty = first_[cell];
    first_[cell] = heads_[empty].next;
    heads_[empty].cell = no_cell;
    free_.push_back(empty);
  }
  const std::uint32_t first = first_[cell];
  if (heads_[block].cell == no_cell || block == first) return;
  kernels::BlockHead& head = heads_[first];
  const auto slot = static_cast<std::uint32_t>(std::bit_width(head.used) - 1);
  const std::uint32_t bit = 1U << slot;
  const BoxId id{blocks_[first].id[slot]};
  const Box<D> box = blocks_[first].box(slot);
  blocks_[first].set(slot, core::nan_box<D>());
  blocks_[block].id[place % block_size] = index(id);
  write(place, box);
  place_[index(id)] = place;
  const std::uint32_t hole = 1U << place % block_size;
  heads_[block].used = static_cast<std::uint16_t>(heads_[block].used | hole);
  if ((head.moving & bit) != 0)
    heads_[block].moving = static_cast<std::uint16_t>(heads_[block].moving | hole);
  head.used = static_cast<std::uint16_t>(head.used & ~bit);
  head.moving = static_cast<std::uint16_t>(head.moving & ~bit);
  if (head.used == 0) close_hole(first * std::uint32_t{block_size});
}

template <int D>
std::size_t HierarchicalGridCells<D>::bytes() const noexcept {
  return blocks_.capacity() * sizeof(Block) + heads_.capacity() * sizeof(kernels::BlockHead) +
         (first_.capacity() + counts_.capacity() + free_.capacity() + place_.capacity() + stale_.capacity()) *
             sizeof(std::uint32_t) +
         levels_.bytes();
}

template class HierarchicalGridCells<2>;
template class HierarchicalGridCells<3>;

}  // namespace broadside::own

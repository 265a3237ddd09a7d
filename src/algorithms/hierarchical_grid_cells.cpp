// Levels of cells and their blocks.
//
// A box is in one cell, that of its minimum, on the level for its size. So whoever looks for what a box meets
// looks into the cells from its minimum less the level's greatest extent to its maximum. All blocks of a cell
// but the first are full: a box is put into the first, or into a new one before it, and where one is taken
// from another block, one of the first fills the hole.
#include "algorithms/hierarchical_grid_cells.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

#include "kernels/nowhere.hpp"

namespace broadside::own {
namespace {

using kernels::block_size;
using kernels::no_block;

/// How much longer than a typical box those of the first level may be, and those of each further level than
/// those of the one before.
constexpr float first_border = 2;
constexpr float level_ratio = 4;

/// So many boxes a cell: fewer make for more cells to look into, more for more boxes to compare.
constexpr double boxes_a_cell = 10;

/// Beyond so many others in its cell, a typical box is in a crowd that smaller cells would disperse.
constexpr double crowded = 40;

constexpr std::size_t most_sampled = 1024;

constexpr std::uint16_t all_used = 0xffff;
constexpr std::uint32_t no_cell = 0xffffffffU;

/// The least whole number whose power of D is at least `count`.
template <int D>
std::size_t whole_root(std::size_t count) {
  std::size_t root = 1;
  while ((D == 2 ? root * root : root * root * root) < count) ++root;
  return root;
}

}  // namespace

template <int D>
void HierarchicalGridCells<D>::build(std::span<const Box<D>> boxes, std::span<const Box<D>> like) {
  reserve(boxes.size());
  choose_levels(like);
  do {
    std::uint32_t cells = 0;
    for (std::size_t level = 0; level < level_count_; ++level) {
      lay_out(level);
      levels_[level].first_cell = cells;
      std::uint32_t count = 1;
      for (int axis = 0; axis < D; ++axis) count *= static_cast<std::uint32_t>(levels_[level].last[axis]) + 1;
      cells += count;
    }
    counts_.assign(cells, 0);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      if (!is_present(boxes[i])) continue;
      place_[i] = levels_[level_of(boxes[i])].cell(boxes[i].min);
      ++counts_[place_[i]];
    }
  } while (disperse_crowds());
  file(boxes);
}

/// Files `boxes`, of which place_ says in which cell each is, and counts_ how many are in each.
template <int D>
void HierarchicalGridCells<D>::file(std::span<const Box<D>> boxes) {
  first_.assign(counts_.size(), no_block);
  heads_.clear();
  blocks_.clear();
  free_.clear();
  stale_.clear();
  boxes_ = 0;
  for (Level& level : levels_) level.boxes = 0;

  // In the order of cells: neighbours in space are neighbours in memory. A cell's first block is the last one
  // there, and the one that need not be full.
  std::size_t blocks = 0;
  for (const std::uint32_t count : counts_) blocks += (count + block_size - 1) / block_size;
  reserve_blocks(blocks);
  for (std::uint32_t cell = 0; cell < counts_.size(); ++cell) {
    for (std::uint32_t count = 0; count < counts_[cell]; count += block_size) new_block(cell);
    if (first_[cell] != no_block)
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
    blocks_[place_[i] / block_size].id[place_[i] % block_size] = BoxId(i);
    write(place_[i], boxes[i]);
    const std::size_t level = level_of(boxes[i]);
    widen(levels_[level], level, boxes[i]);
    ++levels_[level].boxes;
    ++boxes_;
  }
}

template <int D>
void HierarchicalGridCells<D>::choose_levels(std::span<const Box<D>> like) {
  sampled_.clear();
  const std::size_t tries = std::min(like.size(), 4 * most_sampled);
  for (std::size_t i = 0; i < tries && sampled_.size() < most_sampled; ++i) {
    const Box<D>& box = like[tries == like.size() ? i : core::sampled_place(i, like.size())];
    if (is_present(box)) sampled_.push_back(box);
  }
  sample_.take(sampled_, most_sampled);
  const auto spread = static_cast<float>(whole_root<D>(like.size()));
  for (int axis = 0; axis < D; ++axis) {
    const float range = std::min(sample_[axis].high - sample_[axis].low, std::numeric_limits<float>::max());
    typical_[axis] = std::max(sample_[axis].extent, range / spread / 2);
    inverse_typical_[axis] = typical_[axis] > 0
                                 ? std::min(1 / typical_[axis], std::numeric_limits<float>::max())
                                 : std::numeric_limits<float>::max();
  }
  // The last level, which is one cell, is for boxes that are about as long as all is.
  float border = first_border;
  level_count_ = 1;
  const auto is_short = [&](int axis) {
    return border * typical_[axis] < (sample_[axis].high - sample_[axis].low) / 4;
  };
  while (level_count_ < kernels::most_cell_levels - 1) {
    bool any = false;
    for (int axis = 0; axis < D; ++axis) any |= is_short(axis);
    if (!any) break;
    border *= level_ratio;
    ++level_count_;
  }
  ++level_count_;
  measure(like);
}

/// How many boxes there are on each level, and how long they are.
template <int D>
void HierarchicalGridCells<D>::measure(std::span<const Box<D>> like) {
  for (Level& level : levels_) level.extent = {};
  expected_.fill(0);
  factor_.fill(0);
  for (const Box<D>& box : like) {
    if (!is_present(box)) continue;
    const std::size_t level = level_of(box);
    ++expected_[level];
    for (int axis = 0; axis < D; ++axis) {
      const float extent = box.max[axis] - box.min[axis];
      if (extent > levels_[level].extent[axis]) levels_[level].extent[axis] = extent;
    }
  }
  // Of two numbers the rounded difference may be less than the true one, but the next number is not.
  for (Level& level : levels_) {
    for (float& extent : level.extent)
      extent = std::nextafter(extent, std::numeric_limits<float>::infinity());
  }
}

/// Sets the cells of a level: as many as suit its boxes, but none shorter than they are; smaller ones from
/// call to call, where disperse_crowds() has said so.
template <int D>
void HierarchicalGridCells<D>::lay_out(std::size_t index) {
  Level& level = levels_[index];
  const bool is_last = index + 1 == level_count_;
  std::array<double, D> range;
  std::array<double, D> length;
  for (int axis = 0; axis < D; ++axis) {
    range[axis] = static_cast<double>(sample_[axis].high) - sample_[axis].low;
    length[axis] = std::max<double>(level.extent[axis], typical_[axis]);
  }
  const auto cells = [&](double factor) {
    std::array<double, D> counts;
    for (int axis = 0; axis < D; ++axis) {
      const bool is_one = is_last || !(length[axis] > 0) || !(range[axis] > 0);
      counts[axis] = is_one ? 1 : std::max(1.0, std::floor(range[axis] / (length[axis] * factor)));
    }
    return counts;
  };
  const auto product = [](const std::array<double, D>& counts) {
    double all = 1;
    for (const double count : counts) all *= count;
    return all;
  };
  if (factor_[index] == 0) {
    double factor = 1;
    while (product(cells(factor)) > std::max(1.0, expected_[index] / boxes_a_cell)) factor *= 1.125;
    factor_[index] = factor;
  }
  const std::array<double, D> counts = cells(factor_[index]);
  std::uint32_t stride = 1;
  for (int axis = 0; axis < D; ++axis) {
    const double side = counts[axis] > 1 ? range[axis] / counts[axis] : 0;
    level.low[axis] = sample_[axis].low;
    level.inverse[axis] =
        side > 0 ? static_cast<float>(std::min<double>(1 / side, std::numeric_limits<float>::max())) : 0;
    level.last[axis] = static_cast<float>(counts[axis] - 1);
    level.stride[axis] = stride;
    stride *= static_cast<std::uint32_t>(counts[axis]);
    if (index == 0) smallest_[axis] = static_cast<float>(side);
  }
}

/// Where a box of a level is among too many others of its cell, by counts_, makes the level's cells smaller.
/// Whether there was one.
template <int D>
bool HierarchicalGridCells<D>::disperse_crowds() {
  bool any = false;
  for (std::size_t index = 0; index + 1 < level_count_; ++index) {
    const std::size_t end = index + 1 < level_count_ ? levels_[index + 1].first_cell : counts_.size();
    double boxes = 0;
    double met = 0;
    for (std::size_t cell = levels_[index].first_cell; cell < end; ++cell) {
      const double count = counts_[cell];
      boxes += count;
      met += count * count;
    }
    const auto cells = static_cast<double>(end - levels_[index].first_cell);
    if (met <= crowded * boxes || factor_[index] <= 1 || cells > boxes / 2) continue;
    factor_[index] = std::max(1.0, factor_[index] / (D == 2 ? 2 : 1.6));
    any = true;
  }
  return any;
}

template <int D>
std::size_t HierarchicalGridCells<D>::level_of(const Box<D>& box) const {
  float size = 0;
  for (int axis = 0; axis < D; ++axis)
    size = std::max(size, (box.max[axis] - box.min[axis]) * inverse_typical_[axis]);
  std::size_t level = 0;
  for (float border = first_border; size > border && level + 1 < level_count_; border *= level_ratio) ++level;
  return level;
}

template <int D>
void HierarchicalGridCells<D>::move(BoxId id, const Box<D>& before, const Box<D>& now, const Box<D>& bounds) {
  const std::uint32_t place = place_[index(id)];
  kernels::BlockHead& head = heads_[place / block_size];
  const std::size_t level = level_of(now);
  if (levels_[level].cell(now.min) == head.cell) {
    head.moving = static_cast<std::uint16_t>(head.moving | 1U << place % block_size);
    widen(levels_[level], level, now);
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
void HierarchicalGridCells<D>::put(BoxId id, const Box<D>& box, std::size_t index_of_level, bool is_moving) {
  Level& level = levels_[index_of_level];
  widen(level, index_of_level, box);
  const std::uint32_t cell = level.cell(box.min);
  std::uint32_t block = first_[cell];
  if (block == no_block || heads_[block].used == all_used) block = new_block(cell);
  kernels::BlockHead& head = heads_[block];
  const auto slot = static_cast<std::uint32_t>(std::countr_one(head.used));
  head.used = static_cast<std::uint16_t>(head.used | 1U << slot);
  head.moving = static_cast<std::uint16_t>(head.moving | std::uint32_t{is_moving} << slot);
  blocks_[block].id[slot] = id;
  place_[index(id)] = block * std::uint32_t{block_size} + slot;
  write(place_[index(id)], box);
  ++level.boxes;
  ++boxes_;
}

/// The level has a box as long as this one. The last one is searched whole, whatever is on it.
template <int D>
void HierarchicalGridCells<D>::widen(Level& level, std::size_t index_of_level, const Box<D>& box) {
  if (index_of_level + 1 == level_count_) return;
  for (int axis = 0; axis < D; ++axis) {
    const float extent = box.max[axis] - box.min[axis];
    if (extent >= level.extent[axis])
      level.extent[axis] = std::nextafter(extent, std::numeric_limits<float>::infinity());
  }
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
  for (int axis = 0; axis < D; ++axis) {
    blocks_[block].min[axis].fill(std::numeric_limits<float>::quiet_NaN());
    blocks_[block].max[axis].fill(std::numeric_limits<float>::quiet_NaN());
  }
  blocks_[block].id.fill(BoxId{0});
  first_[cell] = block;
  return block;
}

template <int D>
void HierarchicalGridCells<D>::write(std::uint32_t place, const Box<D>& box) {
  Block& block = blocks_[place / block_size];
  for (int axis = 0; axis < D; ++axis) {
    block.min[axis][place % block_size] = box.min[axis];
    block.max[axis][place % block_size] = box.max[axis];
  }
}

template <int D>
void HierarchicalGridCells<D>::drop_stale() {
  for (const std::uint32_t place : stale_) {
    kernels::BlockHead& head = heads_[place / block_size];
    const std::uint32_t others = ~(1U << place % block_size);
    head.used = static_cast<std::uint16_t>(head.used & others);
    head.moving = static_cast<std::uint16_t>(head.moving & others);
    write(place, kernels::nowhere<D>());
    std::size_t level = level_count_ - 1;
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
  while (first_[cell] != no_block && heads_[first_[cell]].used == 0) {
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
  const BoxId id = blocks_[first].id[slot];
  Block& from = blocks_[first];
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = std::exchange(from.min[axis][slot], std::numeric_limits<float>::quiet_NaN());
    box.max[axis] = std::exchange(from.max[axis][slot], std::numeric_limits<float>::quiet_NaN());
  }
  blocks_[block].id[place % block_size] = id;
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
         sampled_.capacity() * sizeof(Box<D>);
}

template class HierarchicalGridCells<2>;
template class HierarchicalGridCells<3>;

}  // namespace broadside::own

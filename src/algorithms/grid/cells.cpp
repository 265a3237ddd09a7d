// The cells of a grid that stays from frame to frame.
#include "algorithms/grid/cells.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace broadside::own {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// A table is as large as leaves its blocks with so many boxes on average, or up to half fewer.
constexpr std::size_t boxes_per_block = 12;
constexpr std::size_t least_blocks = 16;

/// A level with so many times more boxes than its table is made for, or fewer, is to be laid out again.
constexpr std::size_t crowded = 4;
constexpr std::size_t deserted = 16;

/// Numbers of cells lie between these: a float holds them exactly, and what lies beyond is in the last cell.
constexpr float most_cell = 0x1p30F;

/// The axes' steps through a table, in parts of it: rows next to each other lie far apart, and evenly.
constexpr double step_fraction[] = {0, 0.7548776662, 0.5698402910};

}  // namespace

/// How many references to these boxes each level will have.
template <int D>
std::array<std::size_t, GridCells<D>::levels> GridCells<D>::references_of(
    std::span<const Box<D>> boxes) const {
  std::array<std::size_t, levels> references{};
  for (const Box<D>& box : boxes) {
    if (!is_present(box)) continue;
    const Place place = place_of(box);
    const CellRange<D> cells = cells_at(place.level, place.finest);
    std::size_t touched = 1;
    for (int axis = 0; axis < D; ++axis) touched *= std::size_t{cells.more(axis)} + 1;
    references[place.level] += touched;
  }
  return references;
}

template <int D>
void GridCells<D>::start(const std::array<double, D>& sizes, int span, std::span<const Box<D>> boxes,
                         std::span<const Box<D>> later) {
  for (int axis = 0; axis < D; ++axis) {
    per_unit_[axis] = static_cast<float>(std::clamp<double>(
        1 / sizes[axis], std::numeric_limits<float>::min(), std::numeric_limits<float>::max()));
  }
  span_ = static_cast<float>(span);
  references_ = 0;
  occupied_ = 0;
  unfit_ = 0;
  more_.clear();
  free_ = none;
  used_ = 0;
  const std::array<std::size_t, levels> first = references_of(boxes);
  const std::array<std::size_t, levels> last = references_of(later);
  for (int level = 0; level < levels; ++level)
    make_table(levels_[level], std::max(first[level], last[level]));
  constexpr std::size_t ahead = 16;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (i + ahead < boxes.size() && is_present(boxes[i + ahead])) prefetch(place_of(boxes[i + ahead]));
    if (is_present(boxes[i])) insert(place_of(boxes[i]), boxes[i], BoxId(i));
  }
}

template <int D>
void GridCells<D>::make_table(Level& level, std::size_t references) {
  ++version_;
  level.references = 0;
  std::size_t blocks = references == 0 ? 0 : least_blocks;
  while (blocks * boxes_per_block < references) blocks *= 2;
  // Given back where far too large; else the memory is used again.
  if (level.heads.capacity() > crowded * blocks) level.heads = std::vector<Block>();
  level.heads.resize(blocks);
  for (Block& block : level.heads) make_empty(block);
  level.steps[0] = 1;
  for (int axis = 1; axis < D; ++axis) {
    const double fraction = D == 2 ? 0.6180339887 : step_fraction[axis];
    level.steps[axis] = static_cast<std::uint32_t>(static_cast<double>(blocks) * fraction) | 1U;
  }
}

/// Makes a level's table anew, for as many boxes as there are in it.
template <int D>
void GridCells<D>::fit_table(int number) {
  Level& level = levels_[number];
  struct Entry {
    BoxId id;
    Box<D> box;
  };
  std::vector<Entry> entries;
  entries.reserve(level.references);
  for (Block& first : level.heads) {
    for (const Block* block = &first;; block = &more_[block->id[Block::capacity]]) {
      for (std::uint32_t i = 0; i < filled(*block); ++i) {
        Entry entry{BoxId(block->id[i]), {}};
        for (int axis = 0; axis < D; ++axis) {
          entry.box.min[axis] = block->min[axis][i];
          entry.box.max[axis] = block->max[axis][i];
        }
        entries.push_back(entry);
      }
      if (block->id[Block::capacity] == none) break;
    }
    free_blocks(first);
  }
  references_ -= level.references;
  make_table(level, level.references);
  std::ranges::sort(entries, {}, &Entry::id);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (i == 0 || entries[i].id != entries[i - 1].id)
      insert({number, place_of(entries[i].box).finest}, entries[i].box, entries[i].id);
  }
  if (more_.size() > least_blocks && used_ * deserted < more_.size()) compact();
}

template <int D>
void GridCells<D>::free_blocks(Block& first) {
  while (next(first) != none) {
    const std::uint32_t block = next(first);
    next(first) = next(more_[block]);
    next(more_[block]) = std::exchange(free_, block);
    --used_;
  }
}

/// Gives back the blocks that are free.
template <int D>
void GridCells<D>::compact() {
  std::vector<Block> kept;
  kept.reserve(used_);
  for (Level& level : levels_) {
    for (Block& first : level.heads) {
      for (Block* block = &first; next(*block) != none; block = &kept.back()) {
        kept.push_back(more_[next(*block)]);
        next(*block) = static_cast<std::uint32_t>(kept.size() - 1);
      }
    }
  }
  more_ = std::move(kept);
  free_ = none;
}

template <int D>
void GridCells<D>::make_empty(Block& block) {
  std::fill_n(block.min[0], Block::places, nan);
  std::fill_n(block.id, Block::places, none);
  set_filled(block, 0);
}

template <int D>
typename GridCells<D>::Place GridCells<D>::place_of(const Box<D>& box) const {
  const auto cell_of = [](float cell) {
    const auto whole = static_cast<std::int32_t>(cell);
    return whole - static_cast<std::int32_t>(static_cast<float>(whole) > cell);
  };
  Place place;
  float reach = 0;
  for (int axis = 0; axis < D; ++axis) {
    const float first = std::clamp(box.min[axis] * per_unit_[axis], -most_cell, most_cell);
    const float last = std::clamp(box.max[axis] * per_unit_[axis], -most_cell, most_cell);
    place.finest.first[axis] = cell_of(first);
    place.finest.last[axis] = cell_of(last);
    reach = std::max(reach, last - first);
  }
  place.level = 0;
  for (float most = span_; reach > most && place.level < levels - 1; most *= 4) ++place.level;
  return place;
}

template <int D>
std::uint32_t GridCells<D>::take_block() {
  ++used_;
  if (free_ == none) {
    more_.emplace_back();
    return static_cast<std::uint32_t>(more_.size() - 1);
  }
  return std::exchange(free_, next(more_[free_]));
}

template <int D>
void GridCells<D>::insert(int number, const std::array<std::int32_t, D>& cell, const Box<D>& box, BoxId id) {
  Level& level = levels_[number];
  if (level.heads.empty()) make_table(level, 1);
  occupied_ |= 1U << number;
  ++references_;
  ++level.references;
  if (level.references > crowded * boxes_per_block * level.heads.size()) unfit_ |= 1U << number;
  Block& first = head(level, cell);
  std::uint32_t count = filled(first);
  if (count == Block::capacity) {
    // Only the first block of a cell is ever not full.
    const std::uint32_t full = take_block();
    more_[full] = first;
    make_empty(first);
    next(first) = full;
    count = 0;
  }
  write(first, count, box);
  first.id[count] = index(id);
  set_filled(first, count + 1);
}

template <int D>
void GridCells<D>::erase(int number, const std::array<std::int32_t, D>& cell, BoxId id) {
  Level& level = levels_[number];
  Block& first = head(level, cell);
  Block* block = &first;
  const std::uint32_t* found;
  for (;;) {
    const std::uint32_t* const ids = block->id;
    const std::uint32_t* const end = ids + Block::capacity;
    found = std::find(ids, end, index(id));
    if (found != end) break;
    block = &more_[next(*block)];
  }
  const auto hole = static_cast<std::uint32_t>(found - block->id);
  const std::uint32_t last = filled(first) - 1;
  for (int axis = 0; axis < D; ++axis) {
    block->min[axis][hole] = first.min[axis][last];
    block->max[axis][hole] = first.max[axis][last];
  }
  block->id[hole] = first.id[last];
  first.min[0][last] = nan;
  first.id[last] = none;
  set_filled(first, last);
  if (last == 0 && next(first) != none) {
    const std::uint32_t full = next(first);
    first = more_[full];
    next(more_[full]) = std::exchange(free_, full);
    --used_;
  }
  --references_;
  if (--level.references == 0) occupied_ &= ~(1U << number);
  // One that has emptied may fill again in the same frame.
  if (level.references != 0 && level.heads.size() > least_blocks &&
      level.references * deserted < boxes_per_block * level.heads.size())
    unfit_ |= 1U << number;
}

template <int D>
void GridCells<D>::insert(const Place& place, const Box<D>& box, BoxId id) {
  for_each_cell<D>(cells_at(place.level, place.finest),
                   [&](const auto& cell) { insert(place.level, cell, box, id); });
}

template <int D>
void GridCells<D>::erase(const Place& place, BoxId id) {
  for_each_cell<D>(cells_at(place.level, place.finest),
                   [&](const auto& cell) { erase(place.level, cell, id); });
}

template <int D>
void GridCells<D>::prefetch(const Place& place) const {
  const Level& level = levels_[place.level];
  if (place.level != 0 || level.heads.empty()) return;
  for_each_cell<D>(place.finest, [&](const auto& cell) {
    const auto* const lines = reinterpret_cast<const char*>(&level.heads[block_of(level, cell)]);
    for (std::size_t at = 0; at < sizeof(Block); at += 64) __builtin_prefetch(lines + at);
  });
}

template <int D>
std::size_t GridCells<D>::cells() const noexcept {
  std::size_t cells = 0;
  for (const Level& level : levels_) cells += level.heads.size();
  return cells;
}

template <int D>
std::size_t GridCells<D>::bytes() const noexcept {
  std::size_t blocks = more_.capacity();
  for (const Level& level : levels_) blocks += level.heads.capacity();
  return blocks * sizeof(Block);
}

template class GridCells<2>;
template class GridCells<3>;

}  // namespace broadside::own

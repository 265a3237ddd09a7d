// HierarchicalCells: the hierarchical grid that GridFollower keeps. Levels have cells, cells have blocks of
// sixteen boxes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "algorithms/grid/cell_levels.hpp"
#include "core/grow.hpp"
#include "kernels/block_pool.hpp"
#include "kernels/find_changes.hpp"

namespace broadside::algorithm {

template <int D>
class HierarchicalCells {
 public:
  /// Cells of the first level are `cell` wide; by default, the boxes decide.
  explicit HierarchicalCells(std::optional<double> cell) : levels_(cell) {}

  /// Lays out cells that suit `like`, and inserts the present boxes of `boxes`; ids are places in the array.
  /// O(n).
  void build(std::span<const Box<D>> boxes, std::span<const Box<D>> like);

  /// Makes room for ids below `count`.
  void reserve(std::size_t count) {
    if (slot_.size() < count) core::resize_by_eighths(slot_, count);
  }

  /// Moves, inserts or removes a box. Until settle(), its entries cover where it was and where it is, so a
  /// query for either finds it. An entry left behind in another cell stays until drop_stale(). O(1).
  void move(core::MovedBox<D>& box);

  /// Prefetch what a box's move() or settle() reads: first its slot, and later the entry there.
  void prefetch_slot(BoxId id) const { kernels::prefetch(slot_.data() + index(id)); }
  void prefetch_entry(BoxId id) const { pool_.prefetch(slot_[index(id)]); }

  /// move() for a box that stays in its cell and fits its level; does nothing for another box, and leaves its
  /// `slot` unset. Other threads may move_within_cell() or settle() other boxes at the same time.
  void move_within_cell(core::MovedBox<D>& box);

  /// Shrinks the entry of a box that moved earlier to where it now rests. Other threads may settle others.
  void settle(BoxId id, const Box<D>& box) {
    pool_.unmark_beside_others(slot_[index(id)]);
    pool_.set(slot_[index(id)], box);
  }

  /// Removes the entries that boxes left behind. O(number of entries).
  void drop_stale();

  /// Whether searches for this number of movers look at most blocks more than once: each looks into about two
  /// cells on each axis.
  bool are_revisited(std::size_t movers) const { return movers >= pool_.block_count() >> D; }

  /// The cells and their boxes, for a search for this number of movers.
  kernels::CellsView<D> view(std::size_t movers) const {
    // This many bytes stay in the second-level cache, and prefetching them costs more than it saves.
    constexpr std::size_t max_cached_bytes = std::size_t{1} << 19;
    const bool are_cached =
        are_revisited(movers) && pool_.block_count() * sizeof(kernels::Block<D>) <= max_cached_bytes;
    return {levels_.all(), first_.data(), pool_.view(), are_cached};
  }

  std::size_t boxes() const { return boxes_; }

  /// The slot of a present box, and the number of slots.
  std::uint32_t slot(BoxId id) const { return slot_[index(id)]; }
  std::size_t slots() const { return pool_.block_count() * kernels::block_size; }
  std::size_t cells() const { return first_.size(); }

  std::size_t bytes() const noexcept {
    return pool_.bytes() + core::bytes_of(first_, counts_, slot_, stale_) + levels_.bytes();
  }

 private:
  void fill(std::span<const Box<D>> boxes);
  void insert(BoxId id, const Box<D>& box, std::size_t level);

  /// Marks the box's entry as stale. Searches find it until drop_stale().
  void remove(BoxId id, const Box<D>& before) {
    const std::uint32_t slot = slot_[index(id)];
    pool_.mark(slot);
    pool_.set(slot, before);
    stale_.push_back(slot);
  }

  /// Whether a box that was present stays in its cell.
  bool stays(const core::MovedBox<D>& box, std::size_t level) const {
    return box.was_present &&
           levels_[level].cell(box.now.min) == pool_.head(slot_[index(box.id)] / kernels::block_size).owner;
  }

  bool is_far(const core::MovedBox<D>& box) const;
  void close_hole(std::uint32_t slot);

  CellLevels<D> levels_;
  std::vector<std::uint32_t> first_;  // by cell: its first block, the only one that may have room
  kernels::BlockPool<D> pool_;
  std::vector<std::uint32_t> slot_;   // by id, for present boxes
  std::vector<std::uint32_t> stale_;  // slots for drop_stale() to free
  std::vector<std::uint32_t> counts_;
  std::size_t boxes_ = 0;
};

}  // namespace broadside::algorithm

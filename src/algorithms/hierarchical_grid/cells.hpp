// What a hierarchical grid keeps: cells with blocks of sixteen boxes, which boxes are put into, moved in and
// taken from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

#include "algorithms/hierarchical_grid/levels.hpp"
#include "core/grow.hpp"
#include "kernels/cell_blocks.hpp"

namespace broadside::own {

template <int D>
class HierarchicalGridCells {
 public:
  /// Lays out cells that suit `like` and files the boxes of `boxes` that are present, each under its place.
  /// O(n).
  void build(std::span<const Box<D>> boxes, std::span<const Box<D>> like);

  /// The memory for places up to `count`.
  void reserve(std::size_t count) {
    if (place_.size() < count) core::resize_by_eighths(place_, count);
  }

  /// Files a box that is there, under an id that is not filed. O(1).
  void insert(BoxId id, const Box<D>& box) { put(id, box, levels_.level_of(box), false); }

  /// The filed box has moved: until it is settled, it is met by whoever meets one of the two. What is left
  /// where it was goes with drop_stale(). O(1).
  void move(BoxId id, const Box<D>& before, const Box<D>& now, const Box<D>& bounds);

  /// The filed box is gone; it is met until drop_stale().
  void remove(BoxId id, const Box<D>& before);

  /// Files a new box as one that moves.
  void add(BoxId id, const Box<D>& box) { put(id, box, levels_.level_of(box), true); }

  /// The box, which has moved before, is now at rest here.
  void settle(BoxId id, const Box<D>& box);

  /// Takes away what has moved elsewhere or is gone. O(as many).
  void drop_stale();

  kernels::CellsView<D> view() const { return {levels_.all(), first_.data(), heads_.data(), blocks_.data()}; }

  /// The length of the smallest cells.
  const std::array<float, D>& smallest_cell() const { return levels_.smallest_cell(); }

  /// Where a filed box is: its place among those of all blocks.
  std::uint32_t place(BoxId id) const { return place_[index(id)]; }

  std::size_t boxes() const { return boxes_; }
  std::size_t cells() const { return first_.size(); }
  std::size_t bytes() const noexcept;

 private:
  using Block = kernels::Block<D>;

  void file(std::span<const Box<D>> boxes);
  void put(BoxId id, const Box<D>& box, std::size_t level, bool is_moving);
  void reserve_blocks(std::size_t count);
  std::uint32_t new_block(std::uint32_t cell);
  void write(std::uint32_t place, const Box<D>& box);
  void close_hole(std::uint32_t place);

  HierarchicalGridLevels<D> levels_;
  std::vector<std::uint32_t> first_;  // by cell: its first block, the only one that may have room
  std::vector<kernels::BlockHead> heads_;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> free_;   // blocks that no cell has
  std::vector<std::uint32_t> place_;  // by id: block and place in it, of boxes that are filed
  std::vector<std::uint32_t> stale_;  // places to be given up
  std::vector<std::uint32_t> counts_;
  std::size_t boxes_ = 0;
};

}  // namespace broadside::own

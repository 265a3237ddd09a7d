// CellLists: lists of boxes by cell, made by a counting sort (prefix sums): each list is one stretch of one
// array.
//
// Several threads may count and append at once, each for a range of the items: ranges have counts of their
// own, and in a list the items of one range stand before those of the next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "core/large_array.hpp"
#include "core/prefix_sum.hpp"

namespace broadside::core {

/// Use: reset(), count() every reference, prepare(), append() the same references, then read the lists.
class CellLists {
 public:
  /// Memory: 8 bytes for each cell and range.
  void reset(std::size_t cells, std::size_t ranges = 1) {
    cells_ = cells;
    ends_.assign(cells * ranges, 0);
  }

  void count(std::size_t cell, std::size_t range = 0) { ++ends_[range * cells_ + cell]; }

  /// Makes room for what was counted.
  void prepare() {
    const std::size_t total = prefix_sum(std::span<std::size_t>(ends_), cells_);
    renew(items_, total);
  }

  /// Appends `item` to the cell's list, or to the range's part of it.
  void append(std::size_t cell, std::uint32_t item, std::size_t range = 0) {
    items_[ends_[range * cells_ + cell]++] = item;
  }

  /// The cell's list; only after everything was appended.
  std::span<const std::uint32_t> list(std::size_t cell) const {
    const std::size_t* const ends = ends_.data() + ends_.size() - cells_;  // the last range's
    const std::size_t begin = cell == 0 ? 0 : ends[cell - 1];
    return {items_.data() + begin, ends[cell] - begin};
  }

  /// The length of all lists together.
  std::size_t size() const noexcept { return items_.size(); }

 private:
  std::size_t cells_ = 0;
  LargeArray<std::size_t>
      ends_;  // counts, then where the next item goes, which is the list's end when all are there
  LargeArray<std::uint32_t> items_;
};

}  // namespace broadside::core

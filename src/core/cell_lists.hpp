// Lists of boxes by cell, filed by counting: each list is one stretch of one array.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace broadside::core {

/// Use: reset(), count() every reference, prepare(), file() the same references, then read the lists.
class CellLists {
 public:
  void reset(std::size_t cells) { ends_.assign(cells, 0); }

  void count(std::size_t cell) { ++ends_[cell]; }

  /// How many references to the cell were counted; only before prepare().
  std::size_t counted(std::size_t cell) const { return ends_[cell]; }

  /// Makes room for what was counted.
  void prepare() {
    std::size_t total = 0;
    for (std::size_t& end : ends_) {
      const std::size_t count = end;
      end = total;
      total += count;
    }
    items_.resize(total);
  }

  /// Appends `item` to the cell's list.
  void file(std::size_t cell, std::uint32_t item) { items_[ends_[cell]++] = item; }

  /// The cell's list; only after everything was filed.
  std::span<const std::uint32_t> list(std::size_t cell) const {
    const std::size_t begin = cell == 0 ? 0 : ends_[cell - 1];
    return {items_.data() + begin, ends_[cell] - begin};
  }

  /// The length of all lists together.
  std::size_t size() const noexcept { return items_.size(); }

 private:
  std::vector<std::size_t>
      ends_;  // counts, then where the next item goes, which is the list's end when all are there
  std::vector<std::uint32_t> items_;
};

}  // namespace broadside::core

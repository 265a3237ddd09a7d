// A free list that knows its lowest slot: a bit for each slot, and a bit for every 64 bits of the level
// below.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace broadside::world {

/// Slots that are free. Handing out the lowest first keeps arrays dense and their ends empty. All O(1).
class SlotSet {
 public:
  bool empty() const noexcept { return size_ == 0; }
  std::size_t size() const noexcept { return size_; }

  /// Makes room for slots below `count`, so that inserting those does not throw.
  void reserve(std::size_t count) {
    for (std::vector<std::uint64_t>& level : levels_) {
      count = (count + 63) / 64;
      if (level.size() < count) level.resize(count);
    }
  }

  bool contains(std::uint32_t slot) const noexcept {
    const std::vector<std::uint64_t>& words = levels_.front();
    return slot / 64 < words.size() && (words[slot / 64] >> slot % 64 & 1) != 0;
  }

  /// Puts in a slot that is not there, below what was reserved.
  void insert(std::uint32_t slot) noexcept {
    ++size_;
    for (std::vector<std::uint64_t>& level : levels_) {
      std::uint64_t& word = level[slot / 64];
      const bool was_empty = word == 0;
      word |= std::uint64_t{1} << slot % 64;
      if (!was_empty) return;
      slot /= 64;
    }
  }

  /// Takes out a slot that is there.
  void erase(std::uint32_t slot) noexcept {
    --size_;
    for (std::vector<std::uint64_t>& level : levels_) {
      std::uint64_t& word = level[slot / 64];
      word &= ~(std::uint64_t{1} << slot % 64);
      if (word != 0) return;
      slot /= 64;
    }
  }

  /// The lowest slot of a set that is not empty.
  std::uint32_t lowest() const noexcept {
    std::uint32_t place = 0;
    for (std::size_t level = levels_.size(); level-- > 0;)
      place = place * 64 + static_cast<std::uint32_t>(std::countr_zero(levels_[level][place]));
    return place;
  }

  /// Gives back the memory for slots from `count` on, which must not be in the set.
  void shrink_to(std::size_t count) {
    for (std::vector<std::uint64_t>& level : levels_) {
      count = (count + 63) / 64;
      if (level.size() > count) level.resize(count);
      level.shrink_to_fit();
    }
  }

  std::size_t bytes() const noexcept {
    std::size_t bytes = 0;
    for (const std::vector<std::uint64_t>& level : levels_) bytes += level.capacity() * 8;
    return bytes;
  }

 private:
  // 64^6 > 2^32: the last level is a single word.
  std::array<std::vector<std::uint64_t>, 6> levels_;
  std::size_t size_ = 0;
};

}  // namespace broadside::world

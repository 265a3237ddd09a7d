// Filters: which overlapping boxes are to count as pairs.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/export.hpp"
#include "broadside/pair.hpp"

namespace broadside {

/// What a box is, and what it wants to meet. Two boxes count as a pair if they overlap and their filters
/// accept each other: see accepts().
struct Filter {
  std::uint64_t category = 1;              ///< bits: what the box is
  std::uint64_t mask = ~std::uint64_t{0};  ///< bits: the categories it meets

  /// Two boxes of the same group other than 0 meet whatever their bits if it is positive, and never if it is
  /// negative.
  std::int32_t group = 0;

  /// Two static boxes never meet.
  bool is_static = false;

  friend constexpr bool operator==(const Filter&, const Filter&) = default;
};

/// Whether boxes with these filters may pair: each one's mask has a bit of the other one's category, unless
/// their groups decide; and not both are static.
constexpr bool accepts(const Filter& a, const Filter& b) noexcept {
  if (a.is_static && b.is_static) return false;
  if (a.group == b.group && a.group != 0) return a.group > 0;
  return (a.mask & b.category) != 0 && (b.mask & a.category) != 0;
}

/// A set of pairs that never count, whatever their boxes and filters: bodies that a joint connects. Each may
/// be named with its boxes in either order.
///
/// Costs: O(1) each, and 16 to 32 bytes a pair. One thread at a time; several may read. A hash table with
/// open addressing, linear probing and deletion by shifting back (Knuth, TAOCP 3, 6.4, algorithm R).
class IgnoredPairs {
 public:
  /// Whether the pair was not ignored before. A box and itself are no pair, and nothing is inserted.
  bool insert(Pair pair) {
    if (pair.first == pair.second) return false;
    if (2 * size_ >= keys_.size()) grow();
    const std::uint64_t key = ordered_key(pair);
    const std::size_t place = find(key);
    if (keys_[place] == key) return false;
    keys_[place] = key;
    ++size_;
    return true;
  }

  /// Whether the pair was ignored before.
  bool erase(Pair pair) noexcept {
    if (!contains(pair)) return false;
    std::size_t gap = find(ordered_key(pair));
    for (std::size_t place = next(gap); keys_[place] != none; place = next(place)) {
      // One that stands before its gap on the way from its home moves there.
      if (((place - home(keys_[place])) & mask()) < ((place - gap) & mask())) continue;
      keys_[gap] = keys_[place];
      gap = place;
    }
    keys_[gap] = none;
    --size_;
    return true;
  }

  bool contains(Pair pair) const noexcept {
    const std::uint64_t key = ordered_key(pair);
    return size_ != 0 && key != none && keys_[find(key)] == key;
  }

  bool empty() const noexcept { return size_ == 0; }
  std::size_t size() const noexcept { return size_; }

  void clear() noexcept {
    keys_.clear();
    size_ = 0;
  }

  /// How many bytes it holds.
  std::size_t bytes() const noexcept { return keys_.capacity() * sizeof(std::uint64_t); }

  /// Calls `visit(pair)` for each pair, in no order that means anything.
  template <typename Visit>
  void for_each(Visit visit) const {
    for (const std::uint64_t pair : keys_) {
      if (pair != none)
        visit(Pair{BoxId(static_cast<std::uint32_t>(pair >> 32)), BoxId(static_cast<std::uint32_t>(pair))});
    }
  }

 private:
  /// No pair: that of box 0 with itself.
  static constexpr std::uint64_t none = 0;

  static std::uint64_t ordered_key(Pair pair) noexcept {
    return key(pair.first < pair.second ? pair : Pair{pair.second, pair.first});
  }

  std::size_t mask() const noexcept { return keys_.size() - 1; }
  std::size_t next(std::size_t place) const noexcept { return (place + 1) & mask(); }

  /// Where a key's search begins: the highest bits of a multiple of the golden ratio (ibid., 6.4).
  std::size_t home(std::uint64_t key) const noexcept {
    const int bits = std::countr_zero(keys_.size());
    return static_cast<std::size_t>(key * 0x9e3779b97f4a7c15U >> (64 - bits));
  }

  /// Where the key is, or would be. There are places, and half of them are free.
  std::size_t find(std::uint64_t key) const noexcept {
    std::size_t place = home(key);
    while (keys_[place] != none && keys_[place] != key) place = next(place);
    return place;
  }

  void grow() {
    IgnoredPairs larger;
    larger.keys_.resize(keys_.empty() ? 16 : 2 * keys_.size());
    for (const std::uint64_t key : keys_) {
      if (key != none) larger.keys_[larger.find(key)] = key;
    }
    keys_.swap(larger.keys_);
  }

  detail::Vector<std::uint64_t> keys_;  // size is a power of two; `none` where a slot is free
  std::size_t size_ = 0;
};

/// Which overlapping boxes of one search count as pairs; all, where nothing is given.
struct PairFilters {
  std::span<const Filter> filters{};        ///< one for each box (of the left set), or none
  std::span<const Filter> right_filters{};  ///< of two sets: one for each box of the right one, or none
  const IgnoredPairs* ignored = nullptr;    ///< pairs that never count; of one set only

  bool empty() const noexcept {
    return filters.empty() && right_filters.empty() && (ignored == nullptr || ignored->empty());
  }
};

}  // namespace broadside

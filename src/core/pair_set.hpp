// PairSet: the hash table behind IgnoredPairs.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

namespace broadside::core {

/// A set of pairs of two different boxes, in either order. A hash table with open addressing, linear probing
/// and deletion by shifting back (Knuth, TAOCP 3, 6.4, algorithm R), at most half full.
class PairSet {
 public:
  /// The set behind `ignored`; null if there is none.
  static const PairSet* of(const IgnoredPairs* ignored) noexcept {
    return ignored == nullptr ? nullptr : ignored->set_.get();
  }

  /// Returns whether the pair is new.
  bool insert(Pair pair) {
    if (2 * size_ >= keys_.size()) grow();
    const std::uint64_t key = ordered_key(pair);
    const std::size_t place = find(key);
    if (keys_[place] == key) return false;
    keys_[place] = key;
    ++size_;
    return true;
  }

  /// Returns whether the pair was in the set.
  bool erase(Pair pair) noexcept {
    if (!contains(pair)) return false;
    std::size_t gap = find(ordered_key(pair));
    for (std::size_t place = next(gap); keys_[place] != none; place = next(place)) {
      // A key moves into the gap if probing for it passes the gap.
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

  std::size_t size() const noexcept { return size_; }
  std::size_t bytes() const noexcept { return sizeof(*this) + keys_.capacity() * sizeof(std::uint64_t); }

  /// The table: the key of each pair, and 0 in free places.
  std::span<const std::uint64_t> keys() const noexcept { return keys_; }

 private:
  /// Marks a free place: the key of box 0 with itself, which is no pair.
  static constexpr std::uint64_t none = 0;

  static std::uint64_t ordered_key(Pair pair) noexcept {
    return key(pair.first < pair.second ? pair : Pair{pair.second, pair.first});
  }

  std::size_t mask() const noexcept { return keys_.size() - 1; }
  std::size_t next(std::size_t place) const noexcept { return (place + 1) & mask(); }

  /// Where probing for a key begins: Fibonacci hashing (ibid., 6.4).
  std::size_t home(std::uint64_t key) const noexcept {
    const int bits = std::countr_zero(keys_.size());
    return static_cast<std::size_t>(key * 0x9e3779b97f4a7c15U >> (64 - bits));
  }

  /// Where the key is, or would be inserted. The table must not be empty; at least half of it is free.
  std::size_t find(std::uint64_t key) const noexcept {
    std::size_t place = home(key);
    while (keys_[place] != none && keys_[place] != key) place = next(place);
    return place;
  }

  void grow() {
    PairSet larger;
    larger.keys_.resize(keys_.empty() ? 16 : 2 * keys_.size());
    for (const std::uint64_t key : keys_) {
      if (key != none) larger.keys_[larger.find(key)] = key;
    }
    keys_.swap(larger.keys_);
  }

  std::vector<std::uint64_t> keys_;  // size is a power of two; `none` in free places
  std::size_t size_ = 0;
};

}  // namespace broadside::core

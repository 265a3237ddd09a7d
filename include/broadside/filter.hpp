// Filters: which overlapping boxes are to count as pairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_set>

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
/// Costs: O(1) each, and some 40 bytes a pair. One thread at a time; several may read.
class IgnoredPairs {
 public:
  /// Whether the pair was not ignored before. A box and itself are no pair, and nothing is inserted.
  bool insert(Pair pair) { return pair.first != pair.second && keys_.insert(ordered_key(pair)).second; }

  /// Whether the pair was ignored before.
  bool erase(Pair pair) { return keys_.erase(ordered_key(pair)) != 0; }

  bool contains(Pair pair) const { return keys_.contains(ordered_key(pair)); }
  bool empty() const noexcept { return keys_.empty(); }
  std::size_t size() const noexcept { return keys_.size(); }
  void clear() noexcept { keys_.clear(); }

  /// About how many bytes it holds: for each pair a node and its place in the table.
  std::size_t bytes() const noexcept { return 40 * size(); }

  /// Calls `visit(pair)` for each pair, in no order that means anything.
  template <typename Visit>
  void for_each(Visit visit) const {
    for (const std::uint64_t pair : keys_)
      visit(Pair{BoxId(static_cast<std::uint32_t>(pair >> 32)), BoxId(static_cast<std::uint32_t>(pair))});
  }

 private:
  static std::uint64_t ordered_key(Pair pair) noexcept {
    return key(pair.first < pair.second ? pair : Pair{pair.second, pair.first});
  }

  std::unordered_set<std::uint64_t> keys_;
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

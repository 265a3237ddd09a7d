// Filter and IgnoredPairs: which overlapping boxes count as pairs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "broadside/export.hpp"
#include "broadside/pair.hpp"

namespace broadside {

namespace core {
class PairSet;
}  // namespace core

/// What a box is, and the categories it collides with. Two boxes count as a pair if they overlap and their
/// filters accept each other: see accepts().
struct Filter {
  std::uint64_t category = 1;              ///< bits: what the box is
  std::uint64_t mask = ~std::uint64_t{0};  ///< bits: the categories it collides with

  /// If two boxes have the same group and it is not 0, it decides instead of the bits: they always collide if
  /// it is positive, and never if it is negative.
  std::int32_t group = 0;

  /// Two static boxes never collide.
  bool is_static = false;

  friend constexpr bool operator==(const Filter&, const Filter&) = default;
};

namespace detail {
/// Whether the bits of two filters accept each other, whatever their groups. Two static boxes never collide.
constexpr bool bits_accept(const Filter& a, const Filter& b) noexcept {
  return (a.mask & b.category) != 0 && (b.mask & a.category) != 0 && !(a.is_static && b.is_static);
}
}  // namespace detail

/// Whether boxes with these filters may be a pair: they are not both static, and either their common group is
/// positive or, without a common group, the mask of each has a bit of the other's category.
[[nodiscard]] constexpr bool accepts(const Filter& a, const Filter& b) noexcept {
  if (a.is_static && b.is_static) return false;
  if (a.group == b.group && a.group != 0) return a.group > 0;
  return detail::bits_accept(a, b);
}

/// A set of pairs that never count, whatever their boxes and filters are, such as bodies that a joint
/// connects. The two boxes of a pair may be given in either order.
///
/// Each operation is O(1). A pair takes 16 to 32 bytes. Several threads may read at once; nothing else may
/// run at the same time as a change.
class BROADSIDE_PUBLIC IgnoredPairs {
 public:
  IgnoredPairs() noexcept;
  IgnoredPairs(const IgnoredPairs& other);
  IgnoredPairs(IgnoredPairs&& other) noexcept;
  IgnoredPairs& operator=(IgnoredPairs other) noexcept;
  ~IgnoredPairs();

  /// Returns whether the pair is new. Does not insert a pair of a box with itself.
  bool insert(Pair pair);

  /// Returns whether the pair was in the set.
  bool erase(Pair pair) noexcept;

  [[nodiscard]] bool contains(Pair pair) const noexcept;
  [[nodiscard]] bool empty() const noexcept { return size() == 0; }
  [[nodiscard]] std::size_t size() const noexcept;
  void clear() noexcept;

  /// The number of bytes held.
  [[nodiscard]] std::size_t bytes() const noexcept;

  /// Calls `visit(pair)` for each pair, in an unspecified order.
  template <typename Visit>
  void for_each(Visit visit) const {
    for (const std::uint64_t key : keys()) {
      if (key != 0)
        visit(Pair{BoxId(static_cast<std::uint32_t>(key >> 32)), BoxId(static_cast<std::uint32_t>(key))});
    }
  }

 private:
  friend class core::PairSet;

  /// The keys of the pairs, and zeros.
  std::span<const std::uint64_t> keys() const noexcept;

  std::unique_ptr<core::PairSet> set_;  // null until a pair is inserted
};

/// Which overlapping boxes of one search count as pairs: by default all.
struct PairFilters {
  std::span<const Filter> filters{};        ///< one for each box (of the left set), or none
  std::span<const Filter> right_filters{};  ///< of two sets: one for each box of the right set, or none
  const IgnoredPairs* ignored = nullptr;    ///< pairs that never count; only if one set is searched

  [[nodiscard]] bool empty() const noexcept {
    return filters.empty() && right_filters.empty() && (ignored == nullptr || ignored->empty());
  }
};

}  // namespace broadside

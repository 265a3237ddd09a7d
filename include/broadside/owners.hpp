// OwnerPairs: from the pairs of boxes to the pairs of their owners, such as bodies made of several boxes.
#pragma once

#include <algorithm>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "broadside/error.hpp"
#include "broadside/export.hpp"
#include "broadside/pair.hpp"

namespace broadside {

/// Two owners, first < second. An owner is a number of yours.
struct OwnerPair {
  std::uint64_t first;
  std::uint64_t second;

  friend constexpr auto operator<=>(const OwnerPair&, const OwnerPair&) = default;
};

/// The pairs of owners that began and that ended, each once and sorted. Valid until the next update.
struct OwnerEvents {
  std::span<const OwnerPair> begun;
  std::span<const OwnerPair> ended;
};

namespace detail {

/// Both throw InvalidFrame. They are compiled into the library, so that programs without exceptions can
/// include this header.
[[noreturn]] BROADSIDE_PUBLIC void refuse_box_without_owner(BoxId box, std::size_t owners);
[[noreturn]] BROADSIDE_PUBLIC void refuse_end(const OwnerPair& owners, std::int64_t pairs, std::int64_t ends);

}  // namespace detail

/// Tells which pairs of owners touch, from the pairs of boxes that begin and end: two owners touch while at
/// least one box of each touches a box of the other. Boxes of one owner never count as a pair;
/// filters_of_keys(KeyRule::different, owners) also keeps a search from finding them. Its memory and the cost
/// of pairs() follow the pairs of owners, the cost of an update the events.
///
/// With a world, the owner of a box is its user data:
///
///     const Events events = world.update();
///     const OwnerEvents of_cars = cars.update(events.begun_data, events.ended_data);
///
/// With a tracker, or for the pairs of one search, the owners are an array with one for each box:
///
///     cars.update(begun, ended, owners);
///     cars.update(find_pairs(boxes), {}, owners);
///
/// A box that is removed ends its pairs, as its world or tracker tells. Its owner must be the same as when
/// its pairs began.
class OwnerPairs {
 public:
  /// Takes the owners of the boxes of the pairs that began and ended since the last update, in any order.
  /// Each has a `first` and a `second`, as UserDataPair. Throws InvalidFrame if a pair of owners would end
  /// more often than it began. Then nothing has changed.
  template <typename Pairs>
  OwnerEvents update(const Pairs& begun, const Pairs& ended) {
    changes_.clear();
    append(begun, +1, [](std::uint64_t owner) { return owner; });
    append(ended, -1, [](std::uint64_t owner) { return owner; });
    return apply();
  }

  /// The same for pairs of boxes, where owners[i] is the owner of box i. Also throws InvalidFrame if a pair
  /// has a box without an owner.
  OwnerEvents update(std::span<const Pair> begun, std::span<const Pair> ended,
                     std::span<const std::uint64_t> owners) {
    const auto owner_of = [owners](BoxId box) {
      if (index(box) >= owners.size()) detail::refuse_box_without_owner(box, owners.size());
      return owners[index(box)];
    };
    changes_.clear();
    append(begun, +1, owner_of);
    append(ended, -1, owner_of);
    return apply();
  }

  /// The pairs of owners that touch now, sorted.
  [[nodiscard]] std::vector<OwnerPair> pairs() const {
    std::vector<OwnerPair> all;
    all.reserve(counts_.size());
    for (const auto& [pair, count] : counts_) all.push_back(pair);
    return all;
  }

  /// How many pairs of owners touch now.
  [[nodiscard]] std::size_t size() const noexcept { return counts_.size(); }

 private:
  using Change = std::pair<OwnerPair, std::int64_t>;

  template <typename Pairs, typename OwnerOf>
  void append(const Pairs& pairs, std::int64_t by, const OwnerOf& owner_of) {
    for (const auto& pair : pairs) {
      const std::uint64_t a = owner_of(pair.first);
      const std::uint64_t b = owner_of(pair.second);
      if (a != b) changes_.push_back({{std::min(a, b), std::max(a, b)}, by});
    }
  }

  /// Makes one change of each pair of owners, checks all, and then takes them.
  OwnerEvents apply() {
    std::sort(changes_.begin(), changes_.end());
    std::size_t merged = 0;
    for (const Change& change : changes_) {
      if (merged > 0 && changes_[merged - 1].first == change.first)
        changes_[merged - 1].second += change.second;
      else
        changes_[merged++] = change;
    }
    changes_.resize(merged);
    begun_.clear();
    ended_.clear();
    for (const auto& [pair, by] : changes_) {
      const auto found = counts_.find(pair);
      const std::int64_t before = found == counts_.end() ? 0 : found->second;
      if (before + by < 0) detail::refuse_end(pair, before, -by);
      if (before == 0 && by > 0) begun_.push_back(pair);
      if (before > 0 && before + by == 0) ended_.push_back(pair);
    }
    // Memory may run out here, before anything has changed; merge() takes none.
    std::map<OwnerPair, std::int64_t> added;
    for (const OwnerPair& pair : begun_) added.emplace_hint(added.end(), pair, 0);
    counts_.merge(added);
    for (const auto& [pair, by] : changes_) {
      if (by != 0) counts_.find(pair)->second += by;
    }
    for (const OwnerPair& pair : ended_) counts_.erase(pair);
    return {begun_, ended_};
  }

  std::map<OwnerPair, std::int64_t> counts_;  // how many pairs of boxes each pair of owners has; never 0
  std::vector<Change> changes_;
  std::vector<OwnerPair> begun_;
  std::vector<OwnerPair> ended_;
};

}  // namespace broadside

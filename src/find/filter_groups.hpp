// FilterGroups: the boxes of a search, grouped by filter.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

namespace broadside::find {

/// The filters of a search's boxes, by the boxes' places in the search.
class BoxFilters {
 public:
  /// For one set. Box i has the filter ids[i], or i if there are no ids.
  explicit BoxFilters(std::span<const Filter> filters, std::span<const BoxId> ids = {})
      : left_(filters), ids_(ids) {}

  /// For two sets: the first `left_count` boxes are the left set. Ids count from 0 in each set. All boxes of
  /// a set without filters have the default one.
  BoxFilters(std::span<const Filter> left, std::span<const Filter> right, std::size_t left_count,
             std::span<const BoxId> ids = {})
      : left_(left), right_(right), left_count_(left_count), ids_(ids) {}

  /// Whether no box has a filter.
  bool empty() const noexcept { return left_.empty() && right_.empty(); }

  const Filter& operator[](std::size_t place) const noexcept {
    const bool is_left = place < left_count_;
    const std::span<const Filter> filters = is_left ? left_ : right_;
    if (filters.empty()) return default_filter;
    if (!ids_.empty()) return filters[index(ids_[place])];
    return filters[is_left ? place : place - left_count_];
  }

  /// The filters of all boxes, if they are given as one array; else null.
  const Filter* array() const noexcept {
    return left_count_ == one_set && ids_.empty() && !left_.empty() ? left_.data() : nullptr;
  }

 private:
  static constexpr Filter default_filter{};
  static constexpr std::size_t one_set = std::numeric_limits<std::size_t>::max();

  std::span<const Filter> left_;
  std::span<const Filter> right_;
  std::size_t left_count_ = one_set;
  std::span<const BoxId> ids_;
};

/// Boxes of one set that have equal filters.
struct FilterGroup {
  Filter filter;
  bool is_right;        ///< whether they are in the right one of two sets
  std::uint32_t begin;  ///< the place of its first box in places_
  std::uint32_t size;
};

/// Groups boxes by filter, with a hash table with linear probing (Knuth, TAOCP 3, 6.4). Groups are in the
/// order of their first boxes. Keeps its memory.
class FilterGroups {
 public:
  /// Groups the first `boxes` places. If `left_count` is not 0, the places before it are the left set, and no
  /// group has boxes of both. Returns false, without groups, if there would be more than `boxes` / 4.
  /// O(boxes).
  bool build(const BoxFilters& filters, std::size_t boxes, std::size_t left_count);

  std::span<const FilterGroup> groups() const noexcept { return groups_; }

  /// The group of the box at `place`, as an index of groups().
  std::uint32_t group_of(std::size_t place) const noexcept { return group_of_[place]; }

  /// The boxes of a group, ascending.
  std::span<const BoxId> places(std::uint32_t group) const noexcept {
    return std::span(places_).subspan(groups_[group].begin, groups_[group].size);
  }

 private:
  std::uint32_t find_or_insert(const Filter& filter, bool is_right);
  void grow();

  std::vector<FilterGroup> groups_;
  std::vector<std::uint32_t> table_;  // hash table of groups; its size is a power of two
  std::vector<std::uint32_t> group_of_;
  std::vector<BoxId> places_;
};

}  // namespace broadside::find

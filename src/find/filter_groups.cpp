// FilterGroups: the boxes of a search, grouped by filter.
#include "find/filter_groups.hpp"

#include <bit>

namespace broadside::find {
namespace {

constexpr std::uint32_t no_group = ~std::uint32_t{0};

/// Where the search for a filter begins in a table of 2^`bits` slots.
std::size_t home(const Filter& filter, bool is_right, int bits) noexcept {
  std::uint64_t hash = filter.category * 0x9e3779b97f4a7c15U;
  hash = (std::rotl(hash, 32) ^ filter.mask) * 0xbf58476d1ce4e5b9U;
  hash ^= std::uint64_t{static_cast<std::uint32_t>(filter.group)} << 2 |
          static_cast<std::uint64_t>(filter.is_static ? 2 : 0) | static_cast<std::uint64_t>(is_right ? 1 : 0);
  hash = (hash ^ hash >> 32) * 0x94d049bb133111ebU;
  return static_cast<std::size_t>(hash >> (64 - bits));
}

}  // namespace

bool FilterGroups::build(const BoxFilters& filters, std::size_t boxes, std::size_t left_count) {
  const std::size_t max_groups = boxes / 4;
  groups_.clear();
  table_.assign(64, no_group);
  group_of_.resize(boxes);
  std::uint32_t group = no_group;
  for (std::size_t i = 0; i < boxes; ++i) {
    const Filter filter = filters[i];  // a copy, since another thread may change the caller's
    const bool is_right = left_count != 0 && i >= left_count;
    // Boxes of equal filters often follow each other.
    if (group == no_group || groups_[group].filter != filter || groups_[group].is_right != is_right)
      group = find_or_insert(filter, is_right);
    if (groups_.size() > max_groups) {
      groups_.clear();
      return false;
    }
    ++groups_[group].size;
    group_of_[i] = group;
  }
  std::uint32_t begin = 0;
  for (FilterGroup& of_filter : groups_) {
    of_filter.begin = begin;
    begin += of_filter.size;
    of_filter.size = 0;
  }
  places_.resize(boxes);
  for (std::size_t i = 0; i < boxes; ++i) {
    FilterGroup& of_filter = groups_[group_of_[i]];
    places_[of_filter.begin + of_filter.size++] = BoxId(i);
  }
  return true;
}

std::uint32_t FilterGroups::find_or_insert(const Filter& filter, bool is_right) {
  if (2 * groups_.size() >= table_.size()) grow();
  std::size_t slot = home(filter, is_right, std::countr_zero(table_.size()));
  for (; table_[slot] != no_group; slot = (slot + 1) & (table_.size() - 1)) {
    const FilterGroup& group = groups_[table_[slot]];
    if (group.filter == filter && group.is_right == is_right) return table_[slot];
  }
  table_[slot] = static_cast<std::uint32_t>(groups_.size());
  groups_.push_back({filter, is_right, 0, 0});
  return table_[slot];
}

void FilterGroups::grow() {
  table_.assign(4 * table_.size(), no_group);
  for (std::uint32_t group = 0; group < groups_.size(); ++group) {
    std::size_t slot = home(groups_[group].filter, groups_[group].is_right, std::countr_zero(table_.size()));
    while (table_[slot] != no_group) slot = (slot + 1) & (table_.size() - 1);
    table_[slot] = group;
  }
}

}  // namespace broadside::find

// FilterGroups: which boxes are in one group, and where it gives up.
#include "find/filter_groups.hpp"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/boxes.hpp"

namespace broadside::find {
namespace {

Ids places(const FilterGroups& groups, std::uint32_t group) {
  const std::span<const BoxId> places = groups.places(group);
  return {places.begin(), places.end()};
}

TEST(FilterGroups, GroupsBoxesOfEqualFilters) {
  const Filter a{};
  const Filter b{.category = 2};
  const Filter c{.is_static = true};
  const std::vector<Filter> filters = {a, b, a, c, c, b, a, a, a, a, a, a};
  FilterGroups groups;
  ASSERT_TRUE(groups.build(BoxFilters(filters), filters.size(), 0));
  ASSERT_EQ(groups.groups().size(), 3);
  EXPECT_EQ(places(groups, 0),
            (Ids{BoxId{0}, BoxId{2}, BoxId{6}, BoxId{7}, BoxId{8}, BoxId{9}, BoxId{10}, BoxId{11}}));
  EXPECT_EQ(places(groups, 1), (Ids{BoxId{1}, BoxId{5}}));
  EXPECT_EQ(places(groups, 2), (Ids{BoxId{3}, BoxId{4}}));
  EXPECT_EQ(groups.groups()[1].filter, b);
  EXPECT_EQ(groups.group_of(4), 2);
}

TEST(FilterGroups, TellsTheTwoSetsApart) {
  const std::vector<Filter> left(4, Filter{});
  FilterGroups groups;
  ASSERT_TRUE(groups.build(BoxFilters(left, {}, 4), 8, 4));
  ASSERT_EQ(groups.groups().size(), 2);
  EXPECT_FALSE(groups.groups()[0].is_right);
  EXPECT_TRUE(groups.groups()[1].is_right);
  EXPECT_EQ(groups.groups()[1].size, 4);
}

TEST(FilterGroups, TellsManyFiltersApart) {
  std::vector<Filter> filters;
  for (int i = 0; i < 40'000; ++i) {
    Filter filter;
    (i % 4 == 0 ? filter.category : filter.mask) = std::uint64_t(i % 10'000);
    if (i % 4 == 1) filter.group = i % 10'000;
    if (i % 4 == 2) filter.is_static = true;
    filters.push_back(filter);
  }
  FilterGroups groups;
  ASSERT_TRUE(groups.build(BoxFilters(filters), filters.size(), 0));
  EXPECT_EQ(groups.groups().size(), 10'000);
  for (std::size_t i = 0; i < filters.size(); ++i) {
    ASSERT_EQ(groups.groups()[groups.group_of(i)].filter, filters[i]);
    ASSERT_TRUE(std::ranges::binary_search(groups.places(groups.group_of(i)), BoxId(i)));
  }
}

TEST(FilterGroups, GivesUpWhereFiltersAreNearlyAsManyAsBoxes) {
  std::vector<Filter> filters;
  for (std::uint64_t i = 0; i < 1000; ++i) filters.push_back({.mask = i});
  FilterGroups groups;
  EXPECT_FALSE(groups.build(BoxFilters(filters), filters.size(), 0));
  EXPECT_TRUE(groups.groups().empty());
}

}  // namespace
}  // namespace broadside::find

// GroupedSearch against the definition of a pair; and which boxes it has searched together.
#include "find/grouped_search.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "tests/support/boxes.hpp"
#include "tests/support/rng.hpp"

namespace broadside::find {
namespace {

/// Compares all boxes. Writes pairs within a set too. Counts as tests the pairs that were asked for.
template <int D>
class AllPairs final : public Searcher<D> {
 public:
  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    ++searches;
    const std::size_t left = input.left_count;
    std::uint64_t hits = 0;
    for (std::size_t i = 0; i < input.boxes.size(); ++i) {
      for (std::size_t j = i + 1; j < input.boxes.size(); ++j) {
        if (!(input.doubles != nullptr ? overlap(input.doubles[i], input.doubles[j])
                                       : overlap(input.boxes[i], input.boxes[j])))
          continue;
        pairs.add(BoxId(j), BoxId(i));
        if (left == 0 || (i < left && j >= left)) ++hits;
      }
    }
    if (!counts) return std::nullopt;
    return Statistics{.tests = hits, .references = input.boxes.size()};
  }

  bool counts = true;
  std::size_t searches = 0;
};

template <int D>
std::vector<Box<D>> boxes_at_one_place(std::size_t count) {
  Box<D> box{};
  box.max.fill(1);
  return std::vector<Box<D>>(count, box);
}

template <int D>
Box<D> any_box(Rng& rng) {
  Box<D> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = float(rng.below(6));
    box.max[axis] = box.min[axis] + float(rng.below(5));
    if (rng.one_in(20)) box.min[axis] = -infinity;
    if (rng.one_in(20)) box.max[axis] = infinity;
  }
  return box;
}

/// Filters by which boxes accept only others of their own group; some are in none.
std::vector<Filter> group_filters(Rng& rng, std::size_t count) {
  const int groups = rng.whole(1, rng.one_in(2) ? 3 : 60);
  const int apart = rng.one_in(2) ? 1 : 30'000'001;  // far apart, they share buckets
  std::vector<Filter> filters(count);
  for (Filter& filter : filters)
    filter = {.category = 0, .group = apart * rng.whole(rng.one_in(40) ? -1 : 1, groups)};
  return filters;
}

/// Filters of which many accept few others.
std::vector<Filter> any_filters(Rng& rng, std::size_t count) {
  if (rng.one_in(3)) return group_filters(rng, count);
  const std::size_t categories = 1 + rng.below(rng.one_in(3) ? 40 : 4);
  const int groups = rng.one_in(3) ? 40 : rng.whole(0, 3);
  const std::size_t filter_count = 1 + rng.below(rng.one_in(4) ? count : 12);
  std::vector<Filter> filters(filter_count);
  for (Filter& filter : filters) {
    filter.category = std::uint64_t{1} << rng.below(categories);
    filter.mask = rng.one_in(3) ? 0 : rng.one_in(2) ? rng.bits() & rng.bits() : rng.bits();
    if (rng.one_in(2)) filter.group = rng.whole(-groups, groups);
    filter.is_static = rng.one_in(4);
  }
  std::vector<Filter> of_boxes(count);
  for (Filter& filter : of_boxes) filter = rng.one_of<Filter>(filters);
  return of_boxes;
}

template <int D>
struct Found {
  Pairs pairs;
  std::optional<Statistics> statistics;
  AllPairs<D> searcher;
};

template <int D>
void find(Found<D>& found, GroupedSearch<D>& search, const SearchInput<D>& input, const BoxFilters& filters) {
  PairCollector collector(found.pairs);
  found.statistics = search.search(found.searcher, input, filters, collector,
                                   [] { return std::make_unique<AllPairs<D>>(); });
  collector.flush();
  std::erase_if(found.pairs, [&](Pair pair) {
    return input.left_count != 0 && (pair.first < input.left_count) == (pair.second < input.left_count);
  });
  std::ranges::sort(found.pairs);
}

template <int D>
Pairs pairs_by_definition(const SearchInput<D>& input, const BoxFilters& filters) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < input.boxes.size(); ++i) {
    for (std::uint32_t j = i + 1; j < input.boxes.size(); ++j) {
      if (input.left_count != 0 && (i < input.left_count) == (j < input.left_count)) continue;
      const bool touch = input.doubles != nullptr ? overlap(input.doubles[i], input.doubles[j])
                                                  : overlap(input.boxes[i], input.boxes[j]);
      if (touch && accepts(filters[i], filters[j])) pairs.push_back(pair(i, j));
    }
  }
  return pairs;
}

template <int D>
void finds_pairs_by_definition(std::size_t cases) {
  GroupedSearch<D> search;
  std::size_t grouped = 0;
  std::size_t by_searcher = 0;
  for (std::uint64_t seed = 0; seed < cases; ++seed) {
    Rng rng(seed);
    const std::size_t count = rng.one_in(4)    ? rng.below(140)
                              : rng.one_in(15) ? 1000 + rng.below(1000)
                                               : 130 + rng.below(300);
    std::vector<Box<D>> boxes(count);
    const bool is_one_place = rng.one_in(3);
    for (Box<D>& box : boxes) box = is_one_place ? boxes_at_one_place<D>(1)[0] : any_box<D>(rng);
    std::vector<Box<D, double>> doubles(count);
    for (std::size_t i = 0; i < count; ++i) {
      for (int axis = 0; axis < D; ++axis) {
        doubles[i].min[axis] = boxes[i].min[axis] + (rng.one_in(2) ? 1e-12 : 0);
        doubles[i].max[axis] = boxes[i].max[axis] + 1e-11 - (rng.one_in(2) ? 2e-11 : 0);
        if (doubles[i].max[axis] < doubles[i].min[axis]) doubles[i].max[axis] = doubles[i].min[axis];
      }
    }
    const std::size_t left_count = rng.one_in(2) || count < 2 ? 0 : 1 + rng.below(count - 1);
    std::vector<Filter> filters = any_filters(rng, count);
    std::vector<Filter> right(filters.begin() + std::ptrdiff_t(left_count), filters.end());
    filters.resize(left_count == 0 ? count : left_count);
    if (left_count != 0 && rng.one_in(4)) (rng.one_in(2) ? filters : right).clear();
    const BoxFilters of_boxes =
        left_count == 0 ? BoxFilters(filters) : BoxFilters(filters, right, left_count);
    const Workers workers{.threads = rng.one_in(2) ? 1U : 3U, .boxes_per_thread = 50};
    const SearchInput<D> input{.boxes = boxes,
                               .left_count = left_count,
                               .doubles = rng.one_in(2) ? doubles.data() : nullptr,
                               .workers = workers};
    Found<D> found;
    find(found, search, input, of_boxes);
    ASSERT_EQ(found.pairs, pairs_by_definition(input, of_boxes)) << "seed " << seed;
    if (search.searches() == 1) continue;
    ++grouped;
    by_searcher += found.searcher.searches > 0 ? 1 : 0;
  }
  EXPECT_GT(grouped, cases / 10);
  EXPECT_GT(by_searcher, 0U);
  EXPECT_LT(by_searcher, grouped);
}

TEST(GroupedSearch, FindsThePairsByDefinitionIn2D) { finds_pairs_by_definition<2>(1000); }
TEST(GroupedSearch, FindsThePairsByDefinitionIn3D) { finds_pairs_by_definition<3>(500); }

TEST(GroupedSearch, FiltersBoxesByTheirIds) {
  const std::vector<Box2> boxes = boxes_at_one_place<2>(400);
  std::vector<Filter> filters(800);
  Ids ids;
  for (std::uint32_t i = 0; i < 400; ++i) {
    filters[2 * i] = {.category = 4, .mask = 4};
    filters[2 * i + 1] = {.category = 2, .mask = i % 40 == 0 ? ~0U : 1U};
    ids.push_back(BoxId{2 * i + 1});
  }
  GroupedSearch<2> search;
  const BoxFilters of_boxes(filters, ids);
  Found<2> found;
  find(found, search, {.boxes = boxes}, of_boxes);
  EXPECT_EQ(found.pairs, pairs_by_definition<2>({.boxes = boxes}, of_boxes));
  EXPECT_EQ(found.pairs.size(), 10u * 9 / 2);
}

/// Expects that no pair was found and then rejected, in the given number of searches.
void expect_no_rejected_pair(const std::vector<Filter>& filters, std::size_t searches) {
  const std::vector<Box2> boxes = boxes_at_one_place<2>(filters.size());
  GroupedSearch<2> search;
  Found<2> found;
  find(found, search, {.boxes = boxes}, BoxFilters(filters));
  EXPECT_EQ(found.pairs, pairs_by_definition<2>({.boxes = boxes}, BoxFilters(filters)));
  EXPECT_EQ(found.statistics->tests, found.pairs.size());
  EXPECT_EQ(search.searches(), searches);
}

TEST(GroupedSearch, SearchesEachPositiveGroupByItself) {
  std::vector<Filter> filters;
  for (int i = 0; i < 3000; ++i) filters.push_back({.mask = 0, .group = 1 + i % 100});
  expect_no_rejected_pair(filters, 100);
}

TEST(GroupedSearch, SearchesEachGroupInTheSameOrderForAnyNumberOfThreads) {
  Rng rng(5);
  std::vector<Box2> boxes;
  std::vector<Filter> filters;
  for (int i = 0; i < 20'000; ++i) {
    const auto place = float(rng.below(100'000));
    boxes.push_back({{place, 0}, {place + 60, 1}});
    const bool is_large = rng.one_in(3);
    filters.push_back({.mask = 0, .group = is_large ? 5 : rng.whole(1, rng.one_in(2) ? 10 : 3000)});
  }
  std::array<Pairs, 2> found;
  for (std::size_t i = 0; i < 2; ++i) {
    Finder<2> finder("auto");
    finder.set_workers({.threads = 1 + 2 * i, .boxes_per_thread = 100});
    PairCollector collector(found[i]);
    const std::optional<Statistics> statistics = finder.find(boxes, collector, {.filters = filters});
    EXPECT_GT(statistics->tests, found[i].size());
    EXPECT_NE(finder.explanation().find("; the last of "), std::string::npos) << finder.explanation();
  }
  EXPECT_FALSE(found[0].empty());
  EXPECT_EQ(found[0], found[1]);
}

TEST(GroupedSearch, TestsNoFilterIfAllBoxesAreInOneGroup) {
  expect_no_rejected_pair(std::vector<Filter>(200, {.mask = 0, .group = 7}), 1);
}

TEST(GroupedSearch, SearchesBoxesThatRejectEachOtherOnlyAgainstThoseThatAcceptThem) {
  std::vector<Filter> filters(2000, {.category = 2, .mask = 1});
  for (int i = 0; i < 10; ++i) filters[100 * i] = {.category = 1, .mask = 2};
  expect_no_rejected_pair(filters, 1);
  for (int i = 0; i < 10; ++i) filters[100 * i] = {.category = 1, .mask = 3};
  expect_no_rejected_pair(filters, 2);
}

TEST(GroupedSearch, SearchesWhatNeverMeetsApart) {
  std::vector<Filter> filters;
  for (int i = 0; i < 2000; ++i) filters.push_back({.category = 1U << i % 5, .mask = 1U << i % 5});
  expect_no_rejected_pair(filters, 5);
}

TEST(GroupedSearch, SearchesFiltersThatBehaveEquallyTogether) {
  // Those of categories 2 to 5 meet category 1 alone.
  std::vector<Filter> filters;
  for (int i = 0; i < 2000; ++i)
    filters.push_back(i % 5 == 0 ? Filter{} : Filter{.category = 1U << i % 5, .mask = 1});
  expect_no_rejected_pair(filters, 2);
}

TEST(GroupedSearch, LeavesOutBoxesThatMeetNone) {
  std::vector<Filter> filters(1000, {.category = 2, .mask = 2, .is_static = true});
  for (int i = 0; i < 100; ++i) filters[10 * i] = {.category = 1, .mask = 1};
  const std::vector<Box2> boxes = boxes_at_one_place<2>(filters.size());
  GroupedSearch<2> search;
  Found<2> found;
  find(found, search, {.boxes = boxes}, BoxFilters(filters));
  EXPECT_EQ(found.pairs.size(), 100u * 99 / 2);
  EXPECT_EQ(found.statistics->references, 100);
}

TEST(GroupedSearch, SearchesLargeNegativeGroupsAgainstOthersOnly) {
  std::vector<Filter> filters(2000, {.group = -1});
  for (int i = 0; i < 10; ++i) filters[100 * i] = {};
  expect_no_rejected_pair(filters, 2);
}

TEST(GroupedSearch, TestsPairsBehindOneSearchWhereSmallNegativeGroupsAreMany) {
  std::vector<Filter> filters;
  for (int i = 0; i < 2000; ++i) filters.push_back({.group = -1 - i / 10});
  const std::vector<Box2> boxes = boxes_at_one_place<2>(filters.size());
  GroupedSearch<2> search;
  Found<2> found;
  find(found, search, {.boxes = boxes}, BoxFilters(filters));
  EXPECT_EQ(found.pairs, pairs_by_definition<2>({.boxes = boxes}, BoxFilters(filters)));
  EXPECT_EQ(found.searcher.searches, 1);
}

TEST(GroupedSearch, SearchesAllAtOnceWhereNoRejectedBoxesOverlap) {
  std::vector<Box2> boxes;
  std::vector<Filter> filters;
  for (int i = 0; i < 2000; ++i) {
    boxes.push_back(at(float(2 * i)));
    filters.push_back({.category = 1U << i % 4, .mask = i % 4 == 0 ? ~0U : 1U});
  }
  GroupedSearch<2> search;
  Found<2> found;
  find(found, search, {.boxes = boxes}, BoxFilters(filters));
  EXPECT_EQ(found.searcher.searches, 1);
  EXPECT_EQ(found.statistics->references, 2000);
}

TEST(GroupedSearch, SearchesOnlyTheSidesThatAcceptEachOther) {
  const std::vector<Box2> boxes = boxes_at_one_place<2>(1000);
  std::vector<Filter> left(500, {.category = 2, .mask = 1});
  std::vector<Filter> right(500, {.category = 2, .mask = 1});
  for (int i = 0; i < 5; ++i) right[i].category = 1, right[i].mask = 2;
  const BoxFilters filters(left, right, 500);
  const SearchInput<2> input{.boxes = boxes, .left_count = 500};
  GroupedSearch<2> search;
  Found<2> found;
  find(found, search, input, filters);
  EXPECT_EQ(found.pairs, pairs_by_definition(input, filters));
  EXPECT_EQ(found.statistics->tests, 5u * 500);
  EXPECT_EQ(found.statistics->references, 505);
}

TEST(GroupedSearch, LeavesSearchesOfManyPairsToTheSearcher) {
  std::vector<Filter> filters(2000, {.category = 2, .mask = 1});
  for (int i = 0; i < 500; ++i) filters[4 * i] = {.category = 1, .mask = 2};
  const std::vector<Box2> boxes = boxes_at_one_place<2>(filters.size());
  GroupedSearch<2> search;
  Found<2> found;
  find(found, search, {.boxes = boxes}, BoxFilters(filters));
  EXPECT_EQ(found.pairs.size(), 500u * 1500);
  EXPECT_EQ(found.searcher.searches, 1);
}

TEST(GroupedSearch, ComparesFewBoxesWithManyWhicheverTheAlgorithm) {
  const std::vector<Box2> boxes = boxes_at_one_place<2>(16'000);
  std::vector<Filter> filters(boxes.size(), {.category = 2, .mask = 1});
  filters[7] = {.category = 1, .mask = 2};
  for (const Algorithm& algorithm : algorithms()) {
    Finder<2> finder(algorithm.name);
    PairCounter pairs;
    const std::optional<Statistics> statistics = finder.find(boxes, pairs, {.filters = filters});
    EXPECT_EQ(pairs.count(), 15'999) << algorithm.name;
    EXPECT_EQ(statistics->tests, 15'999) << algorithm.name;
    EXPECT_TRUE(finder.explanation().starts_with("brute_force")) << algorithm.name;
  }
}

TEST(GroupedSearch, CountsNothingWhereTheSearcherDoesNot) {
  std::vector<Filter> filters(2000, {.category = 2, .mask = 1});
  for (int i = 0; i < 500; ++i) filters[4 * i] = {.category = 1, .mask = 2};
  const std::vector<Box2> boxes = boxes_at_one_place<2>(filters.size());
  GroupedSearch<2> search;
  Found<2> found;
  found.searcher.counts = false;
  find(found, search, {.boxes = boxes}, BoxFilters(filters));
  EXPECT_EQ(found.statistics, std::nullopt);
  EXPECT_EQ(found.pairs.size(), 500u * 1500);
}

TEST(GroupedSearch, PassesTheCheckpointBetweenSearches) {
  std::vector<Filter> filters;
  for (int i = 0; i < 20'000; ++i) filters.push_back({.mask = 0, .group = 1 + i % 20});
  const std::vector<Box2> boxes = boxes_at_one_place<2>(filters.size());
  const Workers workers{.checkpoint = [] { throw std::runtime_error("enough"); }};
  GroupedSearch<2> search;
  AllPairs<2> searcher;
  PairCounter counter;
  EXPECT_THROW(search.search(searcher, {.boxes = boxes, .workers = workers}, BoxFilters(filters), counter),
               std::runtime_error);
  EXPECT_LT(searcher.searches, 20);
}

TEST(GroupedSearch, EndsTheSearchesOfAllThreadsByACheckpoint) {
  std::vector<Filter> filters;
  for (int i = 0; i < 20'000; ++i) filters.push_back({.mask = 0, .group = 1 + i % 20});
  const std::vector<Box2> boxes = boxes_at_one_place<2>(filters.size());
  Finder<2> finder("auto");
  finder.set_workers(
      {.threads = 2, .boxes_per_thread = 1, .checkpoint = [] { throw std::runtime_error("enough"); }});
  PairCounter counter;
  EXPECT_THROW(finder.find(boxes, counter, {.filters = filters}), std::runtime_error);
}

}  // namespace
}  // namespace broadside::find

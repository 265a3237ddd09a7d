// The law of searches with filters: each overlapping pair that they accept, once, by any algorithm and any
// number of threads.
#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "hard_inputs.hpp"
#include "law_case.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

/// Few filters, so that there are large groups; the share of those that meet none differs from call to call.
/// In every third call boxes accept only others of their own group, as equal keys make them.
std::vector<Filter> any_filters(Rng& rng, std::size_t count) {
  if (rng.one_in(3)) {
    const int groups = rng.whole(1, rng.one_in(2) ? 4 : 100);
    std::vector<Filter> filters(count);
    for (Filter& filter : filters) filter = {.mask = 0, .group = rng.whole(rng.one_in(50) ? -1 : 1, groups)};
    return filters;
  }
  std::vector<Filter> few(1 + rng.below(8));
  const int groups = rng.whole(0, 50);
  for (Filter& filter : few) {
    filter.category = std::uint64_t{1} << rng.below(4);
    filter.mask = rng.one_in(4) ? 0 : rng.bits();
    filter.is_static = rng.one_in(4);
  }
  std::vector<Filter> filters(count);
  for (Filter& filter : filters) {
    filter = rng.one_of<Filter>(few);
    if (rng.one_in(2)) filter.group = rng.whole(-groups, groups);
  }
  return filters;
}

class FilteredFindLaw : public Law {};

TEST_P(FilteredFindLaw, FindsEachAcceptedPairOnceWithAnyNumberOfThreads) {
  in_dimension([&]<int D>() {
    Rng rng(12);
    Finder<D> finder(algorithm(), spec());
    Finder<D> threaded(algorithm(), spec());
    threaded.set_workers({.threads = 3, .boxes_per_thread = 1});
    for (const Input<D>& input : hard_inputs<D>(algorithm(), reduced(1000))) {
      const std::vector<Box<D>>& boxes = input.boxes;
      const std::vector<Filter> filters = any_filters(rng, boxes.size());
      std::vector<Pair> expected;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (std::size_t j = i + 1; j < boxes.size(); ++j) {
          if (is_present(boxes[i]) && is_present(boxes[j]) && overlap(boxes[i], boxes[j]) &&
              accepts(filters[i], filters[j]))
            expected.push_back({BoxId(i), BoxId(j)});
        }
      }
      std::vector<Pair> found;
      PairCollector collector(found);
      finder.find(boxes, collector, {.filters = filters});
      std::vector<Pair> by_threads;
      PairCollector threaded_collector(by_threads);
      threaded.find(boxes, threaded_collector, {.filters = filters});
      if (algorithm().kind == AlgorithmKind::own) {
        EXPECT_EQ(found, by_threads) << input.name;
      }
      std::ranges::sort(found);
      EXPECT_EQ(found, expected) << input.name;
    }
  });
}

TEST_P(FilteredFindLaw, FindsEachAcceptedPairOfTwoSetsOnce) {
  in_dimension([&]<int D>() {
    Rng rng(13);
    Finder<D> finder(algorithm(), spec());
    for (const Input<D>& input : hard_inputs<D>(algorithm(), reduced(1000))) {
      std::vector<Box<D>> left;
      std::vector<Box<D>> right;
      for (const Box<D>& box : input.boxes) (rng.one_in(3) ? left : right).push_back(box);
      const std::vector<Filter> filters = any_filters(rng, left.size());
      std::vector<Filter> right_filters;
      if (!rng.one_in(4)) right_filters = any_filters(rng, right.size());
      std::vector<Pair> expected;
      for (std::size_t i = 0; i < left.size(); ++i) {
        for (std::size_t j = 0; j < right.size(); ++j) {
          if (is_present(left[i]) && is_present(right[j]) && overlap(left[i], right[j]) &&
              accepts(filters[i], right_filters.empty() ? Filter{} : right_filters[j]))
            expected.push_back({BoxId(i), BoxId(j)});
        }
      }
      std::vector<Pair> found;
      PairCollector collector(found);
      finder.find_between(left, right, collector, {.filters = filters, .right_filters = right_filters});
      std::ranges::sort(found);
      EXPECT_EQ(found, expected) << input.name;
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, FilteredFindLaw, testing::ValuesIn(law_cases()), case_name);

}  // namespace
}  // namespace broadside::laws

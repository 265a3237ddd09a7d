// The law of searches between two sets: each overlapping pair across, once, and none within a set.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "hard_inputs.hpp"
#include "law_case.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

template <int D>
std::vector<Pair> reference(const std::vector<Box<D>>& left, const std::vector<Box<D>>& right) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (std::size_t j = 0; j < right.size(); ++j) {
      if (is_present(left[i]) && is_present(right[j]) && overlap(left[i], right[j]))
        pairs.push_back({BoxId(i), BoxId(j)});
    }
  }
  return pairs;
}

template <int D>
std::vector<Pair> found(Finder<D>& finder, const std::vector<Box<D>>& left,
                        const std::vector<Box<D>>& right) {
  std::vector<Pair> pairs;
  PairCollector collector(pairs);
  finder.find_between(left, right, collector);
  std::ranges::sort(pairs);
  return pairs;
}

class BetweenLaw : public Law {};

TEST_P(BetweenLaw, FindsEachPairAcrossOnceAndNoneWithin) {
  in_dimension([&]<int D>() {
    Rng rng(11);
    Finder<D> finder(algorithm(), spec());
    for (const Input<D>& input : hard_inputs<D>(algorithm())) {
      std::vector<Box<D>> left;
      std::vector<Box<D>> right;
      for (const Box<D>& box : input.boxes) (rng.one_in(3) ? left : right).push_back(box);
      EXPECT_EQ(found<D>(finder, left, right), reference<D>(left, right)) << input.name;
      EXPECT_EQ(found<D>(finder, input.boxes, input.boxes), reference<D>(input.boxes, input.boxes))
          << input.name << ", against itself";
    }
  });
}

TEST_P(BetweenLaw, FindsTheSamePairsOfTwoSetsInOneArray) {
  in_dimension([&]<int D>() {
    Finder<D> finder(algorithm(), spec());
    for (const Input<D>& input : hard_inputs<D>(algorithm())) {
      const std::span<const Box<D>> boxes = input.boxes;
      for (const std::size_t left_count : {std::size_t{0}, boxes.size() / 3, boxes.size()}) {
        std::vector<Pair> pairs;
        PairCollector collector(pairs);
        finder.find_across(boxes, left_count, collector);
        std::ranges::sort(pairs);
        const std::span<const Box<D>> left = boxes.first(left_count);
        const std::span<const Box<D>> right = boxes.subspan(left_count);
        EXPECT_EQ(pairs, reference<D>({left.begin(), left.end()}, {right.begin(), right.end()}))
            << input.name << ", the left " << left_count;
      }
    }
  });
}

TEST_P(BetweenLaw, LeavesNoTraceInLaterSearches) {
  in_dimension([&]<int D>() {
    const Input<D> input = hard_inputs<D>(algorithm()).front();
    Finder<D> finder(algorithm(), spec());
    std::vector<Pair> before;
    PairCollector first(before);
    finder.find(input.boxes, first);
    found<D>(finder, input.boxes, input.boxes);
    std::vector<Pair> after;
    PairCollector second(after);
    finder.find(input.boxes, second);
    if (algorithm().kind == AlgorithmKind::peer) {  // promises no order
      std::ranges::sort(before);
      std::ranges::sort(after);
    }
    EXPECT_EQ(before, after);
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, BetweenLaw, testing::ValuesIn(law_cases_without_peers()), case_name);

TEST(FindBetween, AsksNothingOfEmptySets) {
  const std::vector<Box2> none;
  const std::vector<Box2> one = {{{0, 0}, {1, 1}}};
  const std::vector<Box2> absent = {absent_box<2>()};
  EXPECT_TRUE(find_pairs(none, one).empty());
  EXPECT_TRUE(find_pairs(one, none).empty());
  EXPECT_TRUE(find_pairs(absent, one).empty());
  EXPECT_EQ(find_pairs(one, one), (std::vector<Pair>{{BoxId{0}, BoxId{0}}}));
}

TEST(FindBetween, NamesTheSideOfAnInvalidBox) {
  const std::vector<Box2> good = {{{0, 0}, {1, 1}}};
  const std::vector<Box2> bad = {{{0, 0}, {1, 1}}, {{2, 0}, {1, 1}}};
  try {
    static_cast<void>(find_pairs(good, bad));
    FAIL() << "an inverted box was taken";
  } catch (const InvalidInput& error) {
    EXPECT_EQ(error.index(), 1u);
    EXPECT_EQ(std::string(error.what()).substr(0, 11), "right box 1");
  }
}

TEST(FindBetween, DoesNotReportPairsWithinASetOfManyCoincidentBoxes) {
  // Were they looked for, they would be 2 * 10^8.
  const std::vector<Box2> crowd(20000, Box2{{0, 0}, {1, 1}});
  const std::vector<Box2> other = {{{1, 1}, {2, 2}}, {{3, 3}, {4, 4}}};
  PairCounter counter;
  find_pairs(crowd, other, counter);
  EXPECT_EQ(counter.count(), crowd.size());
}

}  // namespace
}  // namespace broadside::laws

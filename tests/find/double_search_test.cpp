// Finders of doubles against the definition, where floats cannot tell many boxes apart: by searchers that
// test doubles in their kernels, and by one that knows nothing of them.
#include "find/double_search.hpp"

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"

#include "tests/support/model.hpp"
#include "tests/support/searchers.hpp"

namespace broadside::find {
namespace {

/// What a user's algorithm is: it searches floats.
template <int D>
class OfFloats final : public Searcher<D> {
 public:
  std::optional<Statistics> search(const SearchInput<D>& input, PairSink& pairs) override {
    for (std::size_t j = 0; j < input.boxes.size(); ++j) {
      for (std::size_t i = 0; i < j; ++i) {
        if (overlap(input.boxes[i], input.boxes[j])) pairs.add(BoxId(i), BoxId(j));
      }
    }
    return std::nullopt;
  }
};

/// About 2^24 + 60, where a float has steps of 2: many that lie apart touch as floats.
template <int D>
std::vector<Box<D, double>> boxes_that_round(Rng& rng, std::size_t count) {
  std::vector<Box<D, double>> boxes(count);
  for (Box<D, double>& box : boxes) {
    const Box<D> drawn = random_box<D>(rng, {.max_extent = 25});
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = 0x1p24 + drawn.min[axis] / 2;
      box.max[axis] = 0x1p24 + drawn.max[axis] / 2;
    }
  }
  // The origin goes far from all of them.
  for (int axis = 0; axis < D; ++axis) boxes[0].min[axis] = boxes[0].max[axis] = 0;
  for (std::size_t i = 1; i < count / 2 + 2 && i < count; ++i) boxes[i] = boxes[0];
  return boxes;
}

template <int D>
void expect_exact(Finder<D, double>& finder, const std::vector<Box<D, double>>& boxes) {
  EXPECT_EQ(sorted_pairs([&](PairSink& sink) { finder.find(boxes, sink); }), overlapping_pairs(boxes));
  const std::size_t left_count = boxes.size() / 3;
  std::vector<Pair> between = overlapping_pairs(boxes, left_count);
  for (Pair& pair : between) pair.second = BoxId(index(pair.second) - left_count);
  const std::span<const Box<D, double>> all = boxes;
  EXPECT_EQ(sorted_pairs([&](PairSink& sink) {
              finder.find_between(all.first(left_count), all.subspan(left_count), sink);
            }),
            between);
  EXPECT_EQ(sorted_pairs([&](PairSink& sink) { finder.find_across(all, left_count, sink); }), between);
}

TEST(DoubleSearch, IsExactWhateverSearchesTheFloats) {
  in_each_dimension([]<int D>() {
    Rng rng(1);
    for (const std::size_t count : {10, 200, 1200}) {
      const std::vector<Box<D, double>> boxes = boxes_that_round<D>(rng, count);
      Finder<D, double> of_user(std::make_unique<OfFloats<D>>());
      expect_exact(of_user, boxes);
      for (const Algorithm& algorithm : algorithms()) {
        if (algorithm.kind != AlgorithmKind::own) continue;
        SCOPED_TRACE(algorithm.name);
        Finder<D, double> finder(algorithm.name);
        expect_exact(finder, boxes);
      }
    }
  });
}

TEST(DoubleSearch, LeavesTheLastTestToTheKernelsOfEachAlgorithmThatHasThem) {
  for (const char* const name : {"auto", "brute_force", "grid", "sweep_and_prune", "quadtree", "bvh"})
    EXPECT_TRUE(find_algorithm(name)->tests_doubles) << name;
  in_each_dimension([]<int D>() {
    Rng rng(3);
    std::vector<Box<D, double>> boxes;
    std::vector<Box<D>> floats;
    for (int i = 0; i < 600; ++i) {
      floats.push_back(random_box<D>(rng, {.places = 40}));
      boxes.push_back(near_double(rng, floats.back()));
    }
    const std::vector<Pair> expected = overlapping_pairs(boxes);
    ASSERT_LT(expected.size(), overlapping_pairs(floats).size());
    for (const Algorithm& algorithm : algorithms()) {
      if (!algorithm.tests_doubles) continue;
      const SearchInput<D> input{.boxes = floats, .doubles = boxes.data()};
      const auto searcher = searcher_of<D>(algorithm.name);
      EXPECT_EQ(sorted_pairs([&](PairSink& sink) { searcher->search(input, sink); }), expected)
          << algorithm.name;
    }
  });
}

TEST(DoubleSearch, GoesBackToFloatsWhereRoundingLosesNothing) {
  in_each_dimension([]<int D>() {
    Rng rng(2);
    Finder<D, double> finder("grid");
    for (const bool rounds : {true, false, true}) {
      std::vector<Box<D, double>> boxes = boxes_that_round<D>(rng, 600);
      for (Box<D, double>& box : boxes) {
        for (int axis = 0; axis < D && !rounds; ++axis) {
          box.min[axis] = box.min[axis] == 0 ? 0 : box.min[axis] - 0x1p24;
          box.max[axis] = box.max[axis] == 0 ? 0 : box.max[axis] - 0x1p24;
        }
      }
      expect_exact(finder, boxes);
    }
  });
}

}  // namespace
}  // namespace broadside::find

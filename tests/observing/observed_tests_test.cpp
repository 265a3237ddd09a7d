// In a build that observes, the tests that are written down are those that a search counts.
#include "kernels/observed_tests.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"

#include "paper/listings/registry.hpp"
#include "tests/support/model.hpp"
#include "tests/support/rng.hpp"

namespace broadside::kernels {
namespace {

static_assert(is_observing);

/// What a search has written down, and what it has found and counted.
struct Observed {
  std::vector<Pair> tests;
  std::vector<Pair> pairs;  // in order
  Statistics statistics;
};

template <int D>
Observed observe(Finder<D>& finder, const std::vector<Box<D>>& boxes, std::size_t left_count = 0) {
  observed_tests().clear();
  Observed observed;
  observed.pairs = sorted_pairs([&](PairSink& sink) {
    observed.statistics =
        (left_count == 0 ? finder.find(boxes, sink) : finder.find_across(boxes, left_count, sink)).value();
  });
  observed.tests = observed_tests();
  return observed;
}

/// The tests of boxes that overlap, each once and in order.
template <int D>
std::vector<Pair> hits_of(std::vector<Pair> tests, const std::vector<Box<D>>& boxes) {
  std::erase_if(tests,
                [&](Pair test) { return !overlap(boxes[index(test.first)], boxes[index(test.second)]); });
  std::ranges::sort(tests);
  tests.erase(std::unique(tests.begin(), tests.end()), tests.end());
  return tests;
}

/// Boxes that take each of the ways through kernels and algorithms: none, one, a leaf, many, in one place,
/// along a line, of all sizes, infinite ones.
template <int D>
std::vector<std::vector<Box<D>>> scenes() {
  Rng rng(5);
  std::vector<std::vector<Box<D>>> scenes = {{}};
  for (const std::size_t count : {1U, 2U, 16U, 17U, 60U, 250U, 600U})
    scenes.push_back(random_boxes<D>(rng, count, {.places = 100}));
  scenes.push_back(random_boxes<D>(rng, 500, {.places = 2000, .max_extent = 3, .infinite_one_in = 0}));
  scenes.push_back(random_boxes<D>(rng, 250, {.places = 5, .infinite_one_in = 0}));
  scenes.push_back(std::vector<Box<D>>(200, random_box<D>(rng)));
  std::vector<Box<D>> mixed = random_boxes<D>(rng, 500, {.places = 600, .max_extent = 5});
  for (Box<D>& box : mixed) {
    for (int axis = 0; axis < D && rng.one_in(8); ++axis)
      box.max[axis] += static_cast<float>(1 << rng.whole(0, 10));
  }
  scenes.push_back(std::move(mixed));
  std::vector<Box<D>> line =
      random_boxes<D>(rng, 300, {.places = 4000, .max_extent = 3, .infinite_one_in = 0});
  for (Box<D>& box : line) {
    for (int axis = 1; axis < D; ++axis) box.min[axis] = box.max[axis] = 1;
  }
  scenes.push_back(std::move(line));
  return scenes;
}

/// Calls `body(finder, boxes)` for each of the algorithms in each of the scenes.
template <int D, typename Body>
void with_each_finder(Body body) {
  paper::register_listings();
  std::vector<std::string> specs = {"grid:cell=7", "sweep_and_prune:axes=2", "quadtree:capacity=4"};
  for (const Algorithm& algorithm : algorithms()) specs.push_back(algorithm.name);
  const std::vector<std::vector<Box<D>>> all = scenes<D>();
  for (const std::string& spec : specs) {
    if (!find_algorithm(Spec(spec).name)->has_dimension(D)) continue;
    Finder<D> finder(spec);
    for (std::size_t scene = 0; scene < all.size(); ++scene) {
      SCOPED_TRACE(testing::Message() << spec << " in " << D << "D, scene " << scene);
      body(finder, all[scene]);
      if (testing::Test::HasFailure()) return;
    }
  }
}

TEST(ObservedTests, AreThoseThatTheSearchCounts) {
  on_each_instruction_set([]<int D>() {
    with_each_finder<D>([](Finder<D>& finder, const std::vector<Box<D>>& boxes) {
      const Observed observed = observe(finder, boxes);
      EXPECT_EQ(observed.tests.size(), observed.statistics.tests);
      EXPECT_EQ(observed.pairs, overlapping_pairs(boxes));
      EXPECT_EQ(hits_of(observed.tests, boxes), observed.pairs);
    });
  });
}

TEST(ObservedTests, OfTwoSetsAreThoseThatTheSearchCounts) {
  in_each_dimension([]<int D>() {
    with_each_finder<D>([](Finder<D>& finder, const std::vector<Box<D>>& boxes) {
      if (boxes.size() < 2) return;
      const std::size_t left_count = boxes.size() / 3 + 1;
      const Observed observed = observe(finder, boxes, left_count);
      EXPECT_EQ(observed.tests.size(), observed.statistics.tests);
      std::vector<Pair> expected = overlapping_pairs(boxes, left_count);
      const std::vector<Pair> hits = hits_of(observed.tests, boxes);
      EXPECT_TRUE(std::ranges::includes(hits, expected));
    });
  });
}

TEST(ObservedTests, NameBoxesByTheirPlacesAmongAbsentOnes) {
  in_each_dimension([]<int D>() {
    with_each_finder<D>([](Finder<D>& finder, const std::vector<Box<D>>& present) {
      std::vector<Box<D>> boxes;
      for (const Box<D>& box : present) {
        boxes.push_back(box);
        boxes.push_back(absent_box<D>());
      }
      const Observed observed = observe(finder, boxes);
      EXPECT_EQ(observed.tests.size(), observed.statistics.tests);
      for (const Pair test : observed.tests)
        EXPECT_TRUE(is_present(boxes[index(test.first)]) && is_present(boxes[index(test.second)]));
      EXPECT_EQ(hits_of(observed.tests, boxes), observed.pairs);
    });
  });
}

TEST(ObservedTests, CompareEachPairOnceByBruteForce) {
  paper::register_listings();
  Rng rng(9);
  const std::vector<Box2> boxes = random_boxes<2>(rng, 100);
  for (const std::string_view spec : {"brute_force", "paper_brute_force"}) {
    Finder<2> finder(spec);
    std::vector<Pair> tests = observe(finder, boxes).tests;
    std::ranges::sort(tests);
    std::vector<Pair> expected;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      for (std::size_t j = i + 1; j < boxes.size(); ++j) expected.push_back(ordered(i, j));
    }
    EXPECT_EQ(tests, expected) << spec;
  }
}

/// Lines along three axes, which no choice of `auto`'s searches without far too many tests.
TEST(ObservedTests, GoOnWhereAutoHandsASearchOver) {
  Rng rng(2);
  std::vector<Box3> boxes(8000);
  for (Box3& box : boxes) {
    const std::size_t along = rng.below(3);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      box.min[axis] = static_cast<float>(rng.unit() * (axis == along ? 100 : 1000));
      box.max[axis] = box.min[axis] + (axis == along ? 900.0F : 0.0F);
    }
  }
  Finder<3> finder("auto");
  const Observed observed = observe(finder, boxes);
  ASSERT_NE(finder.explanation().find("gave up"), std::string::npos) << finder.explanation();
  EXPECT_EQ(observed.tests.size(), observed.statistics.tests);
  EXPECT_EQ(hits_of(observed.tests, boxes), observed.pairs);
}

}  // namespace
}  // namespace broadside::kernels

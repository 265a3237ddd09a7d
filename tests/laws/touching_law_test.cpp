// The law of half-open boxes: with `touching` off, a pair is two boxes that share a point without their
// maxima.
#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"
#include "broadside/world.hpp"

#include "law_case.hpp"
#include "tests/support/drawn_boxes.hpp"
#include "tests/support/model.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

/// Whether [a_min, a_max) and [b_min, b_max) share a number, where [x, x) has the number x, and [x, infinity)
/// has infinity.
template <typename Real>
bool share_number(Real a_min, Real a_max, Real b_min, Real b_max) {
  const auto has = [](Real min, Real max, Real x) {
    return min == max ? x == min : min <= x && (x < max || max == std::numeric_limits<Real>::infinity());
  };
  const Real x = std::max(a_min, b_min);
  return has(a_min, a_max, x) && has(b_min, b_max, x);
}

template <int D, typename Real>
bool share_point(const Box<D, Real>& a, const Box<D, Real>& b) {
  bool share = is_present(a) && is_present(b);
  for (int axis = 0; axis < D; ++axis)
    share = share && share_number(a.min[axis], a.max[axis], b.min[axis], b.max[axis]);
  return share;
}

/// Boxes on a lattice, of which many touch, and boxes of any numbers; some absent.
template <int D, typename Real>
Boxes<D, Real> drawn_boxes(Rng& rng, std::size_t count) {
  Boxes<D, Real> boxes(count);
  for (Box<D, Real>& box : boxes) {
    if (rng.one_in(20))
      box = absent_box<D, Real>();
    else if (rng.one_in(5))
      box = box_of_any_floats<D, Real>(rng);
    else
      box = random_box<D, Real>(rng, {.places = 12, .max_extent = 2});
  }
  return boxes;
}

/// The pairs of one set, or of its first `left_count` boxes with the others, as places in the whole.
template <int D, typename Real>
std::vector<Pair> reference(const Boxes<D, Real>& boxes, std::size_t left_count = 0) {
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < (left_count == 0 ? boxes.size() : left_count); ++i) {
    for (std::size_t j = std::max(i + 1, left_count); j < boxes.size(); ++j) {
      if (share_point(boxes[i], boxes[j])) pairs.push_back(ordered(i, j));
    }
  }
  return pairs;
}

class TouchingLaw : public Law {
 protected:
  template <int D, typename Real>
  void find(Rng& rng, std::size_t count) {
    const Boxes<D, Real> boxes = drawn_boxes<D, Real>(rng, count);
    Finder<D, Real> finder(algorithm(), spec());
    finder.set_touching(false);
    const auto sorted = [](std::vector<Pair> pairs) {
      std::ranges::sort(pairs);
      return pairs;
    };
    EXPECT_EQ(sorted(written_pairs([&](PairSink& pairs) { finder.find(boxes, pairs); })), reference(boxes));
    const std::size_t left_count = count / 3;
    const std::span<const Box<D, Real>> all = boxes;
    std::vector<Pair> between = reference(boxes, left_count);
    for (Pair& pair : between) pair.second = BoxId(index(pair.second) - left_count);
    EXPECT_EQ(sorted(written_pairs([&](PairSink& pairs) {
                finder.find_between(all.first(left_count), all.subspan(left_count), pairs);
              })),
              between);
    EXPECT_EQ(sorted(written_pairs([&](PairSink& pairs) { finder.find_across(all, left_count, pairs); })),
              between);
  }
};

TEST_P(TouchingLaw, FindsTheBoxesThatSharePointsWithoutTheirMaxima) {
  in_dimension([&]<int D>() {
    Rng rng(37);
    for (const std::size_t count : {std::size_t{7}, std::size_t{150}, reduced(700)}) {
      find<D, float>(rng, count);
      find<D, double>(rng, count);
    }
  });
}

TEST_P(TouchingLaw, FollowsThem) {
  in_dimension([&]<int D>() {
    Rng rng(38);
    Tracker<D> tracker(algorithm(), spec());
    tracker.set_touching(false);
    Boxes<D> boxes = drawn_boxes<D, float>(rng, 200);
    std::vector<Pair> held;
    for (int frame = 0; frame < 12; ++frame) {
      std::vector<BoxId> changed;
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        if (!rng.one_in(frame % 3 == 0 ? 1 : 5)) continue;
        boxes[i] = drawn_boxes<D, float>(rng, 1)[0];
        changed.push_back(BoxId(i));
      }
      std::vector<Pair> begun;
      std::vector<Pair> ended;
      PairCollector begun_sink(begun);
      PairCollector ended_sink(ended);
      tracker.update({.boxes = boxes, .changed = changed}, begun_sink, ended_sink);
      const std::vector<Pair> now = reference(boxes);
      std::vector<Pair> expected;
      std::ranges::set_difference(now, held, std::back_inserter(expected));
      EXPECT_EQ(begun, expected) << "frame " << frame;
      expected.clear();
      std::ranges::set_difference(held, now, std::back_inserter(expected));
      EXPECT_EQ(ended, expected) << "frame " << frame;
      held = now;
    }
  });
}

TEST(Touching, IsSetBeforeTheFirstUpdateOfATracker) {
  Tracker<2> tracker;
  const std::vector<Box2> boxes = {{{0, 0}, {1, 1}}};
  PairCounter pairs;
  tracker.update({.boxes = boxes}, pairs, pairs);
  EXPECT_THROW(tracker.set_touching(false), std::logic_error);
}

TEST(Touching, StaysWhatItIsWhereAWorldIsShifted) {
  World2 world({.touching = false});
  world.add({{0, 0}, {1, 1}});
  world.add({{1, 0}, {2, 1}});
  world.add({{0.5F, 0}, {1.5F, 1}});
  EXPECT_EQ(world.update().begun.size(), 2U);
  world.shift_origin({-1000, 0});
  EXPECT_TRUE(world.update().begun.empty());
  std::size_t found = 0;
  world.overlapping({{1001, 0}, {1002, 1}}, [&](Handle) { ++found; });
  EXPECT_EQ(found, 2U);
}

TEST(Touching, CountsForTheNearestBoxesOfABox) {
  World2 world({.touching = false});
  world.add({{0, 0}, {1, 1}});
  for (const Box2& box : {Box2{{1, 0}, {2, 1}}, Box2{{-1, 0}, {0, 1}}})
    EXPECT_TRUE(world.nearest(box, 1, {.max_distance = 0}).empty()) << "as overlapping() finds none";
  EXPECT_EQ(world.nearest(Box2{{0.5F, 0}, {2, 1}}, 1, {.max_distance = 0}).size(), 1U);
  EXPECT_EQ(world.nearest({0, 0}, 1, {.max_distance = 0}).size(), 1U);
}

TEST(Touching, IsAnOptionOfFindPairsWhoseErrorsNameTheGivenBoxes) {
  const std::vector<Box2> tiles = {
      {{0, 0}, {1, 1}}, {{1, 0}, {2, 1}}, {{1, 0.5F}, {1, 0.5F}}, {{0.5F, 0}, {1.5F, 1}}};
  EXPECT_EQ(find_pairs(tiles).size(), 6U);
  std::vector<Pair> pairs = find_pairs(tiles, {.touching = false});
  std::ranges::sort(pairs);
  EXPECT_EQ(pairs, (std::vector<Pair>{ordered(0, 3), ordered(1, 2), ordered(1, 3), ordered(2, 3)}));
  try {
    static_cast<void>(find_pairs(std::vector<Box2>{{{3, 0}, {2.5F, 1}}}, {.touching = false}));
    FAIL() << "expected InvalidInput";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("(2.5, 1)"), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, TouchingLaw, testing::ValuesIn(law_cases_without_peers()), case_name);

}  // namespace
}  // namespace broadside::laws

// Intervals against the definition on one axis: one set, two sets, keys, half-open ones, in motion, queries.
#include "broadside/interval.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/find_pairs.hpp"
#include "broadside/index.hpp"
#include "broadside/keys.hpp"
#include "broadside/tracker.hpp"
#include "broadside/world.hpp"

#include "tests/support/rng.hpp"

namespace broadside {
namespace {

struct Range {
  double start;
  double end;
};

bool overlap(Range a, Range b, bool touching) {
  const auto last = [touching](Range range) {
    return touching || range.start == range.end ? range.end : range.end - 0.5;  // the ends are whole numbers
  };
  return a.start <= last(b) && b.start <= last(a);
}

/// Whole numbers up to 4e9, which floats do not hold: with many ties, points, nested ranges, one that covers
/// all.
std::vector<Range> any_ranges(Rng& rng, std::size_t count) {
  const double origin = rng.one_in(2) ? 3e9 : 0;
  const std::size_t width = std::array<std::size_t, 4>{5, 100, 5000, 1'000'000'000}[rng.below(4)];
  std::vector<Range> ranges(count);
  for (Range& range : ranges) {
    range.start = origin + static_cast<double>(rng.below(width));
    const std::size_t most = rng.one_in(20) ? width : width / count + 3;
    range.end = range.start + static_cast<double>(rng.one_in(5) ? 0 : rng.below(most));
  }
  if (rng.one_in(3)) ranges[rng.below(count)] = {origin, origin + static_cast<double>(width)};
  return ranges;
}

std::vector<DoubleBox2> boxes_of_ranges(const std::vector<Range>& ranges) {
  return boxes_of(ranges, [](Range range) { return interval(range.start, range.end); });
}

std::vector<Pair> pairs_in_order(std::vector<Pair> pairs) {
  std::ranges::sort(pairs);
  return pairs;
}

TEST(IntervalTest, PairsAreThoseOfTheDefinition) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Rng rng(seed);
    const std::size_t count = rng.one_in(3) ? 2 + rng.below(40) : 300 + rng.below(200);
    const std::vector<Range> ranges = any_ranges(rng, count);
    const std::vector<DoubleBox2> boxes = boxes_of_ranges(ranges);
    const bool touching = rng.one_in(2);
    std::vector<int> keys(count);
    for (int& key : keys) key = rng.whole(0, 2);
    const std::size_t left = rng.below(count);
    std::vector<Pair> all;
    std::vector<Pair> same;
    std::vector<Pair> between;
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = a + 1; b < count; ++b) {
        if (!overlap(ranges[a], ranges[b], touching)) continue;
        all.push_back({BoxId(a), BoxId(b)});
        if (keys[a] == keys[b]) same.push_back({BoxId(a), BoxId(b)});
        if (a < left && b >= left) between.push_back({BoxId(a), BoxId(b - left)});
      }
    }
    const auto filters = filters_of_keys(KeyRule::same, keys);
    const std::span<const DoubleBox2> both = boxes;
    for (const std::string algorithm :
         {"auto", "grid", "bvh", "sweep_and_prune", "quadtree", "brute_force"}) {
      const std::string what = algorithm + ", seed " + std::to_string(seed);
      const Spec spec(algorithm);
      EXPECT_EQ(pairs_in_order(find_pairs(boxes, {.algorithm = spec, .touching = touching})), all) << what;
      EXPECT_EQ(
          pairs_in_order(find_pairs(boxes, {.algorithm = spec, .filters = filters, .touching = touching})),
          same)
          << what;
      EXPECT_EQ(pairs_in_order(find_pairs(both.first(left), both.subspan(left),
                                          {.algorithm = spec, .touching = touching})),
                between)
          << what;
    }
  }
}

TEST(IntervalTest, OneBoxBesideTheLineIsToldFromIt) {
  // As a float its y is that of all others.
  for (const double y : {1e-300, -1e-300}) {
    for (const std::size_t place : {0, 500, 999}) {
      Rng rng(place);
      std::vector<DoubleBox2> boxes(1000);
      for (DoubleBox2& box : boxes) {
        const double start = 3e9 + static_cast<double>(rng.below(100'000));
        box = interval(start, start + static_cast<double>(rng.below(300)));
      }
      const std::size_t on_the_line = find_pairs(boxes).size();
      std::size_t own = 0;
      for (std::size_t i = 0; i < boxes.size(); ++i) own += i != place && overlap(boxes[i], boxes[place]);
      boxes[place].min[1] = boxes[place].max[1] = y;
      EXPECT_EQ(find_pairs(boxes).size(), on_the_line - own) << y << " at " << place;
      boxes[place].min[1] = std::min(y, 0.0);
      boxes[place].max[1] = std::max(y, 0.0);
      EXPECT_EQ(find_pairs(boxes).size(), on_the_line) << y << " at " << place;
    }
  }
}

TEST(IntervalTest, MoveInTrackersAndWorlds) {
  Rng rng(7);
  std::vector<Range> ranges = any_ranges(rng, 300);
  Tracker<2, double> tracker;
  tracker.set_touching(false);
  DoubleWorld2 world({.touching = false});
  std::vector<Handle> handles;
  for (const Range range : ranges) handles.push_back(world.add(interval(range.start, range.end)));
  std::vector<Pair> held;
  std::vector<BoxId> all;
  for (std::size_t i = 0; i < ranges.size(); ++i) all.push_back(BoxId(i));
  for (int frame = 0; frame < 20; ++frame) {
    if (frame > 0) {
      for (std::size_t i = rng.below(30); i < ranges.size(); i += 1 + rng.below(30)) {
        ranges[i] = ranges[rng.below(ranges.size())];
        world.move(handles[i], interval(ranges[i].start, ranges[i].end));
      }
    }
    const std::vector<DoubleBox2> boxes = boxes_of_ranges(ranges);
    std::vector<Pair> begun;
    std::vector<Pair> ended;
    tracker.update(
        {.boxes = boxes, .changed = all}, [&](Pair pair) { begun.push_back(pair); },
        [&](Pair pair) { ended.push_back(pair); });
    std::vector<Pair> now;
    for (std::size_t a = 0; a < ranges.size(); ++a) {
      for (std::size_t b = a + 1; b < ranges.size(); ++b)
        if (overlap(ranges[a], ranges[b], false)) now.push_back({BoxId(a), BoxId(b)});
    }
    std::erase_if(held, [&](Pair pair) { return std::ranges::binary_search(ended, pair); });
    held.insert(held.end(), begun.begin(), begun.end());
    std::ranges::sort(held);
    EXPECT_EQ(held, now) << frame;
    world.update();
    std::vector<Pair> of_world;
    for (const HandlePair& pair : world.pairs())
      of_world.push_back({BoxId(pair.first.slot), BoxId(pair.second.slot)});
    EXPECT_EQ(pairs_in_order(of_world), now) << frame;
  }
}

TEST(IntervalTest, AreFoundByQueries) {
  const std::vector<DoubleBox2> genes = {interval(3e9, 3e9 + 1), interval(3e9 + 3, 3e9 + 9), interval(1, 2)};
  BoxIndex<2, double> index;
  index.update({.boxes = genes});
  std::vector<BoxId> found;
  index.overlapping(interval(3e9 + 1, 3e9 + 2), [&](BoxId id) { found.push_back(id); });
  EXPECT_EQ(found, std::vector{BoxId(0)});
  const auto nearest = index.nearest({3e9 + 2.5, 0}, 1);
  ASSERT_EQ(nearest.size(), 1U);
  EXPECT_EQ(nearest[0].box, BoxId(1));
}

}  // namespace
}  // namespace broadside

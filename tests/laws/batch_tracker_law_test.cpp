// The law of batch trackers: in each world, the pairs that a search of the new frame has and one of the frame
// before lacks begin, and the others end; in one order for any number of threads.
#include <algorithm>
#include <cstddef>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/batch.hpp"
#include "broadside/batch_tracker.hpp"

#include "law_case.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {
namespace {

using Pairs = std::vector<Pair>;

Pairs sorted(std::span<const Pair> pairs) {
  Pairs result(pairs.begin(), pairs.end());
  std::ranges::sort(result);
  return result;
}

Pairs difference(const Pairs& a, const Pairs& b) {
  Pairs result;
  std::ranges::set_difference(a, b, std::back_inserter(result));
  return result;
}

/// Worlds of many sizes, whose boxes move, vanish and return, and whose filters change.
template <int D, typename Real>
class MovingWorlds {
 public:
  MovingWorlds() {
    for (std::size_t world = 0; world < 60; ++world) offsets.push_back(offsets.back() + rng_.below(60));
    offsets.push_back(offsets.back());
    offsets.push_back(offsets.back() + reduced(1500));
    boxes.resize(offsets.back());
    move();
  }

  void move() {
    for (Box<D, Real>& box : boxes) {
      if (rng_.below(3) == 0) continue;
      for (int axis = 0; axis < D; ++axis) {
        box.min[axis] = static_cast<Real>(rng_.between(0, 12));
        box.max[axis] = box.min[axis] + static_cast<Real>(rng_.below(4));
      }
      if (rng_.below(10) == 0) box = absent_box<D, Real>();
    }
  }

  void filter() {
    filters.resize(boxes.size());
    for (Filter& filter : filters) {
      if (rng_.below(2) == 0) filter = {.category = 1U << rng_.below(3), .mask = rng_.below(8)};
    }
  }

  Pairs pairs_of(std::size_t world, bool touching) const {
    const std::size_t begin = offsets[world];
    const std::size_t count = offsets[world + 1] - begin;
    FindOptions options{.algorithm = "brute_force", .touching = touching};
    if (!filters.empty()) options.filters = std::span(filters).subspan(begin, count);
    return sorted(find_pairs(std::span(boxes).subspan(begin, count), options));
  }

  std::vector<Box<D, Real>> boxes;
  std::vector<std::size_t> offsets = {0};
  std::vector<Filter> filters;

 private:
  Rng rng_{1};
};

template <int D, typename Real>
void expect_the_law(const Spec& spec, const std::string& threads, bool touching) {
  MovingWorlds<D, Real> worlds;
  BatchTracker<D, Real> tracker(spec);
  BatchTracker<D, Real> other(Spec(spec.name + threads));
  tracker.set_touching(touching);
  other.set_touching(touching);
  std::vector<Pairs> before(worlds.offsets.size() - 1);
  for (int frame = 0; frame < 6; ++frame) {
    if (frame > 0) worlds.move();
    if (frame > 1) worlds.filter();
    const BatchEvents events = tracker.update(worlds.boxes, worlds.offsets, worlds.filters);
    for (std::size_t world = 0; world < before.size(); ++world) {
      const Pairs now = worlds.pairs_of(world, touching);
      ASSERT_EQ(sorted(events.begun.of(world)), difference(now, before[world])) << "world " << world;
      ASSERT_EQ(sorted(events.ended.of(world)), difference(before[world], now)) << "world " << world;
      ASSERT_EQ(sorted(tracker.pairs().of(world)), now) << "world " << world;
      before[world] = now;
    }
    const BatchEvents same = other.update(worlds.boxes, worlds.offsets, worlds.filters);
    ASSERT_TRUE(std::ranges::equal(same.begun.pairs, events.begun.pairs)) << "with" << threads;
    ASSERT_TRUE(std::ranges::equal(same.ended.pairs, events.ended.pairs)) << "with" << threads;
  }
}

class BatchTrackerLaw : public Law {};

TEST_P(BatchTrackerLaw, ReportsTheDifferencesOfEveryWorld) {
  in_dimension([&]<int D>() {
    const std::string threads = has_threads(algorithm()) ? ":threads=4" : "";
    expect_the_law<D, float>(spec(), threads, true);
    expect_the_law<D, double>(spec(), threads, true);
    expect_the_law<D, float>(spec(), threads, false);
  });
}

INSTANTIATE_TEST_SUITE_P(Catalogue, BatchTrackerLaw, testing::ValuesIn(cases_of(algorithms())), case_name);

using Offsets = std::vector<std::size_t>;

TEST(BatchTracker, RefusesWhatChangesTheWorldsAndKeepsItsFrame) {
  const Box2 box{{0, 0}, {1, 1}};
  BatchTracker<2> tracker;
  EXPECT_EQ(tracker.pairs().pairs.size(), 0U);
  std::vector<Box2> boxes(5, box);
  EXPECT_EQ(tracker.update(boxes, Offsets{0, 2, 5}).begun.offsets.back(), 4U);
  const auto message_of = [&](const std::vector<Box2>& given, const Offsets& offsets,
                              const std::vector<Filter>& filters = {}) -> std::string {
    try {
      tracker.update(given, offsets, filters);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "nothing was thrown";
  };
  EXPECT_EQ(message_of(boxes, {0, 5}), "1 worlds, after 2 in the update before; expected as many");
  EXPECT_EQ(
      message_of(boxes, {0, 3, 5}),
      "world 0 has 3 boxes, after 2 in the update before; expected as many, absent ones in the places of "
      "bodies that are missing");
  EXPECT_EQ(message_of(boxes, {0, 2, 4}), "the last offset of worlds is 4; expected 5, the number of boxes");
  EXPECT_EQ(message_of(boxes, {0, 2, 5}, std::vector<Filter>(2)),
            "2 filters for 5 boxes; expected one for each box, or none");
  EXPECT_THROW(tracker.set_touching(false), std::logic_error);
  std::vector<Box2> bad = boxes;
  bad[3].max[1] = -1;
  EXPECT_NE(message_of(bad, {0, 2, 5}).find("which is box 1 of world 1"), std::string::npos);

  boxes[0] = {{3, 3}, {4, 4}};
  const BatchEvents events = tracker.update(boxes, Offsets{0, 2, 5});
  EXPECT_EQ(events.begun.pairs.size(), 0U);
  EXPECT_EQ(sorted(events.ended.of(0)), (Pairs{{BoxId{0}, BoxId{1}}}));
  EXPECT_EQ(events.ended.pairs.size(), 1U);
  EXPECT_EQ(tracker.pairs().pairs.size(), 3U);
  EXPECT_GE(tracker.bytes(), 2 * boxes.size() * sizeof(Box2));
}

TEST(BatchTracker, RefusesAnUnknownAlgorithm) { EXPECT_THROW(BatchTracker<3>("gird"), InvalidSpec); }

}  // namespace
}  // namespace broadside::laws

// Motion: as many movers as asked for, within bounds; and random histories that contain everything.
#include "lab/scenes/motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"

#include "tests/support/boxes.hpp"

namespace broadside::lab {
namespace {

template <int D>
History<D> history_of(std::string_view text, const SceneRequest& request) {
  const NamedScene named = find_scene(text);
  return make_history<D>(named.scene, named.spec, request);
}

/// Calls `check` with the boxes of each frame.
template <int D, typename Check>
void for_each_frame(const History<D>& history, Check check) {
  std::vector<Box<D>> boxes = history.boxes;
  check(boxes);
  for (const Step<D>& step : history.steps) {
    lab::apply(step, boxes);
    check(boxes);
  }
}

template <int D>
Box<D> bounds_of(const std::vector<Box<D>>& boxes) {
  Box<D> bounds = absent_box<D>();
  for (const Box<D>& box : boxes) bounds = merged(bounds, box);
  return bounds;
}

TEST(Motion, MovesTheFractionAskedForAndTheSameBoxesInEveryFrame) {
  for (const double moving : {0.0, 0.01, 0.5, 1.0}) {
    const History<2> history = history_of<2>("uniform", {.boxes = 1000, .frames = 20, .moving = moving});
    ASSERT_EQ(history.steps.size(), 20u);
    for (const Step<2>& step : history.steps) {
      EXPECT_EQ(step.size, 1000u);
      EXPECT_EQ(static_cast<double>(step.changed.size()), 1000 * moving);
      EXPECT_EQ(step.changed, history.steps[0].changed);
      EXPECT_TRUE(std::ranges::is_sorted(step.changed));
    }
  }
}

TEST(Motion, StartsFromTheStillScene) {
  EXPECT_EQ(history_of<3>("clustered", {.boxes = 100, .frames = 3}).boxes,
            history_of<3>("clustered", {.boxes = 100}).boxes);
  EXPECT_TRUE(history_of<3>("clustered", {.boxes = 100}).steps.empty());
}

TEST(Motion, IsTheSameForASeedAndDifferentForAnother) {
  const auto last = [](std::uint64_t seed) {
    return history_of<2>("terdiman", {.boxes = 100, .seed = seed, .frames = 5}).steps.back().boxes;
  };
  EXPECT_EQ(last(3), last(3));
  EXPECT_NE(last(3), last(4));
}

TEST(Motion, GoesTheDriftTimesABoxsMeanExtentAFrame) {
  const std::vector<Box2> boxes = {{{0, 0}, {100, 100}}, {{50, 50}, {54, 56}}};
  const History<2> history = set_moving<2>(boxes, {.frames = 1, .moving = 1, .drift = 0.5}, false);
  const Step<2>& step = history.steps[0];
  ASSERT_EQ(step.changed, std::vector<BoxId>{BoxId{1}}) << "a box as large as the bounds has nowhere to go";
  const double x = step.boxes[0].min[0] - 50;
  const double y = step.boxes[0].min[1] - 50;
  EXPECT_NEAR(std::sqrt(x * x + y * y), 2.5, 1e-4);
}

TEST(Motion, StaysWithinTheBoundsAndKeepsEveryBoxPresent) {
  for (const Scene& scene : scenes()) {
    if (!scene.boxes_3d) continue;
    SCOPED_TRACE(scene.name);
    const History<3> history =
        history_of<3>(scene.name, {.boxes = 200, .frames = 100, .moving = 1, .drift = 3, .teleport = 0.1});
    const Box3 bounds = bounds_of(history.boxes);
    for_each_frame(history, [&](const std::vector<Box3>& boxes) {
      ASSERT_TRUE(std::ranges::all_of(boxes, [](const Box3& box) { return is_present(box); }));
      ASSERT_EQ(bounds_of<3>({bounds, bounds_of(boxes)}), bounds);
    });
  }
}

TEST(Motion, TurnsBackAtTheBoundsAndCrossesTheWorldAgainAndAgain) {
  const std::vector<Box2> boxes = {{{0, 0}, {20, 20}}, {{9, 9}, {11, 11}}};
  const History<2> history = set_moving<2>(boxes, {.frames = 400, .moving = 1, .drift = 0.5}, false);
  int crossings = 0;
  float before = boxes[1].min[0];
  for (const Step<2>& step : history.steps) {
    ASSERT_EQ(step.boxes.size(), 1u);
    const float now = step.boxes[0].min[0];
    crossings += (before < 9) != (now < 9) ? 1 : 0;
    before = now;
  }
  EXPECT_GT(crossings, 5);
}

TEST(Motion, KeepsIntegersIntegersAndSizesAsTheyWere) {
  for (const char* name : {"integers", "lattice", "terdiman"}) {
    SCOPED_TRACE(name);
    const History<2> history =
        history_of<2>(name, {.boxes = 200, .frames = 50, .moving = 0.5, .drift = 0.01, .teleport = 0.2});
    EXPECT_FALSE(history.steps[0].changed.empty());
    for_each_frame(history, [&](const std::vector<Box2>& boxes) {
      for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (int axis = 0; axis < 2; ++axis) {
          ASSERT_EQ(boxes[i].min[axis], std::floor(boxes[i].min[axis]));
          ASSERT_EQ(boxes[i].max[axis] - boxes[i].min[axis],
                    history.boxes[i].max[axis] - history.boxes[i].min[axis]);
        }
      }
    });
  }
}

TEST(Motion, TeleportsTheFractionOfMoversAskedFor) {
  const History<2> history =
      history_of<2>("uniform", {.boxes = 5000, .frames = 20, .moving = 1, .drift = 0.01, .teleport = 0.25});
  std::size_t jumps = 0;
  std::vector<Box2> before = history.boxes;
  for (const Step<2>& step : history.steps) {
    for (std::size_t i = 0; i < step.changed.size(); ++i)
      jumps += std::abs(step.boxes[i].min[0] - before[index(step.changed[i])].min[0]) > 1;
    lab::apply(step, before);
  }
  EXPECT_NEAR(static_cast<double>(jumps) / (5000 * 20), 0.25, 0.02);
}

TEST(Motion, LeavesInfiniteAndAbsentBoxesWhereTheyAre) {
  constexpr float largest = std::numeric_limits<float>::max();
  const std::vector<Box2> boxes = {{{-infinity, 0}, {infinity, 1}},
                                   absent_box<2>(),
                                   {{-largest, -largest}, {largest, largest}},
                                   {{3, 3}, {3, 3}},
                                   {{1, 1}, {2, 2}}};
  const History<2> history = set_moving<2>(boxes, {.frames = 30, .moving = 1, .teleport = 0.3}, false);
  for_each_frame(history, [&](const std::vector<Box2>& now) {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(now[i], boxes[i]);
    for (std::size_t i = 3; i < 5; ++i) EXPECT_TRUE(is_present(now[i]));
  });
}

TEST(Motion, RefusesWhatIsNoFractionOrNoDrift) {
  EXPECT_THROW(set_moving<2>({}, {.frames = 1, .moving = 1.5}, false), InvalidSpec);
  EXPECT_THROW(set_moving<2>({}, {.frames = 1, .moving = -0.1}, false), InvalidSpec);
  EXPECT_THROW(set_moving<2>({}, {.frames = 1, .drift = -1}, false), InvalidSpec);
  EXPECT_THROW(set_moving<2>({}, {.frames = 1, .teleport = std::nan("")}, false), InvalidSpec);
}

TEST(RandomHistory, ContainsEverythingThatAHistoryMayDo) {
  std::set<std::string> seen;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const History<2> history = random_history<2>({.seed = seed});
    std::vector<Box2> before = history.boxes;
    std::vector<std::uint8_t> was_present(1000);
    for (const Step<2>& step : history.steps) {
      if (step.size > before.size()) seen.insert("grows");
      if (step.size < before.size()) seen.insert("shrinks");
      if (step.changed.empty()) seen.insert("nothing changes");
      if (step.changed.size() == step.size) seen.insert("everything changes");
      std::set<BoxId> once(step.changed.begin(), step.changed.end());
      ASSERT_EQ(once.size(), step.changed.size());
      for (std::size_t i = 0; i < step.changed.size(); ++i) {
        const std::size_t place = index(step.changed[i]);
        ASSERT_LT(place, step.size);
        const Box2 now = step.boxes[i];
        ASSERT_TRUE(is_present(now) || is_absent(now));
        const bool is_new = place >= before.size();
        if (is_new || is_absent(before[place])) {
          if (is_present(now)) seen.insert(was_present[place] != 0 ? "place used again" : "added");
        } else if (is_absent(now)) {
          seen.insert("removed");
        } else if (now == before[place]) {
          seen.insert("listed unchanged");
        } else {
          const float extent = before[place].max[0] - before[place].min[0];
          seen.insert(now.max[0] - now.min[0] == extent ? "moved" : "replaced within a frame");
        }
        if (is_present(now) && now.min == now.max) seen.insert("point");
        if (std::isinf(now.max[0]) && is_present(now)) seen.insert("infinite");
        if (now.min[0] == 0 && std::signbit(now.min[0])) seen.insert("-0.0");
      }
      lab::apply(step, before);
      for (std::size_t i = 0; i < before.size(); ++i) was_present[i] |= is_present(before[i]) ? 1 : 0;
    }
  }
  EXPECT_EQ(seen, (std::set<std::string>{"grows", "shrinks", "nothing changes", "everything changes", "added",
                                         "place used again", "removed", "listed unchanged", "moved",
                                         "replaced within a frame", "point", "infinite", "-0.0"}));
}

TEST(RandomHistory, HasFiniteBoxesOnlyWhereAskedTo) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    for_each_frame(random_history<3>({.seed = seed, .infinite_boxes = false}), [](const auto& boxes) {
      for (const Box3& box : boxes) {
        if (!is_present(box)) continue;
        ASSERT_LT(*std::ranges::max_element(box.max), 1000);
      }
    });
  }
}

}  // namespace
}  // namespace broadside::lab

// Recordings: what an engine was asked for, the same each time, and at rest where bodies are at rest.
#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside::lab {
namespace {

template <int D>
History<D> record(std::string_view name, const SceneRequest& request) {
  const NamedScene named = find_scene(name);
  return make_history<D>(named.scene, named.spec, request);
}

template <int D>
std::vector<Box<D>> last_boxes(const History<D>& history) {
  std::vector<Box<D>> boxes = history.boxes;
  for (const Step<D>& step : history.steps) lab::apply(step, boxes);
  return boxes;
}

/// What holds for every recording, with few bodies.
template <int D>
void check_recording(const Scene& scene) {
  SCOPED_TRACE(scene.name);
  for (const std::size_t count : {0, 1, 2, 7, 150}) {
    const History<D> history = record<D>(scene.name, {.boxes = count, .frames = 10});
    EXPECT_EQ(history.boxes.size(), count);
    ASSERT_EQ(history.steps.size(), 10u);
    for (const Step<D>& step : history.steps) EXPECT_EQ(step.size, count);
    const std::vector<Box<D>> last = last_boxes(history);
    EXPECT_TRUE(std::ranges::all_of(last, [](const Box<D>& box) { return is_present(box); }));
  }
  const SceneRequest request{.boxes = 150, .seed = 5, .frames = 10};
  const std::vector<Box<D>> last = last_boxes(record<D>(scene.name, request));
  EXPECT_EQ(last, last_boxes(record<D>(scene.name, request)));
  EXPECT_NE(last, last_boxes(record<D>(scene.name, {.boxes = 150, .seed = 6, .frames = 10})));
  EXPECT_EQ(record<D>(scene.name, {.boxes = 150, .seed = 5}).boxes, record<D>(scene.name, request).boxes);
  EXPECT_GT(find_pairs(last).size(), 20u) << "bodies that never meet are no test of collision detection";
}

TEST(Recordings, HoldTheBodiesAskedForAndAreTheSameForASeed) {
  for (const Scene& scene : scenes()) {
    if (scene.kind != SceneKind::recorded) continue;
    ASSERT_NE(bool(scene.history_2d), bool(scene.history_3d)) << scene.name;
    EXPECT_FALSE(scene.source.empty());
    if (scene.history_2d) check_recording<2>(scene);
    if (scene.history_3d) check_recording<3>(scene);
  }
}

TEST(Recordings, ThatAreMissingNameThePackageToInstall) {
  std::size_t recorded = 0;
  for (const Scene& scene : scenes()) recorded += scene.kind == SceneKind::recorded ? 1 : 0;
  for (const Scene& scene : missing_scenes()) {
    recorded += scene.kind == SceneKind::recorded ? 1 : 0;
    try {
      find_scene(scene.name);
      FAIL() << "found " << scene.name;
    } catch (const InvalidSpec& error) {
      EXPECT_NE(std::string(error.what()).find(scene.missing), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(recorded, 6u);
}

/// A test of one engine's scene, skipped where the engine is missing.
bool is_there(std::string_view name) {
  return std::ranges::any_of(scenes(), [name](const Scene& scene) { return scene.name == name; });
}

TEST(Box2dPyramid, SleepsWhereNoBallHasHit) {
  if (!is_there("box2d_pyramid")) GTEST_SKIP() << "Box2D is missing";
  const History<2> history = record<2>("box2d_pyramid", {.boxes = 600, .frames = 20});
  for (const Step<2>& step : history.steps) {
    EXPECT_GT(step.changed.size(), 0u);
    EXPECT_LT(step.changed.size(), 500u);
  }
}

TEST(Box2dRain, KeepsFallingHoweverLongItRains) {
  if (!is_there("box2d_rain")) GTEST_SKIP() << "Box2D is missing";
  const History<2> history = record<2>("box2d_rain", {.boxes = 100, .frames = 600});
  EXPECT_GT(history.steps.back().changed.size(), 50u);
  for (const Box2& box : last_boxes(history)) EXPECT_GT(box.min[1], -20);
}

TEST(BulletFreeFall, HeapsBodiesOnTheGround) {
  if (!is_there("bullet_free_fall")) GTEST_SKIP() << "Bullet is missing";
  const History<3> history = record<3>("bullet_free_fall", {.boxes = 200, .frames = 100});
  EXPECT_GT(find_pairs(last_boxes(history)).size(), find_pairs(history.boxes).size());
  EXPECT_LT(last_boxes(history).back().max[1], history.boxes.back().max[1]);
}

TEST(BulletBrownian, KeepsBodiesWithinItsWalls) {
  if (!is_there("bullet_brownian")) GTEST_SKIP() << "Bullet is missing";
  const History<3> history = record<3>("bullet_brownian", {.boxes = 100, .frames = 200});
  const std::vector<Box3> last = last_boxes(history);
  for (const Box3& box : last) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GE(box.min[axis], last[2 * axis].min[axis]);
      EXPECT_LE(box.max[axis], last[2 * axis + 1].max[axis]);
    }
  }
}

}  // namespace
}  // namespace broadside::lab

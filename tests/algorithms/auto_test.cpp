// What auto chooses: for boxes of one kind always the same.
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/debug/history.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "algorithms/auto/auto_thresholds.hpp"
#include "algorithms/grid/tile_cells.hpp"
#include "lab/scenes/scene.hpp"
#include "tests/support/rng.hpp"

namespace broadside {
namespace {

/// What auto says that it took for a scene's boxes.
template <int D = 2>
std::string chosen_for(const char* scene, std::size_t boxes, std::uint64_t seed) {
  const lab::NamedScene named = lab::find_scene(scene);
  const lab::History<D> history =
      lab::make_history<D>(named.scene, named.spec, {.boxes = boxes, .seed = seed});
  Finder<D> finder("auto");
  PairCounter pairs;
  finder.find(history.boxes, pairs);
  const std::string text = finder.explanation();
  return text.substr(0, text.find(','));
}

TEST(Auto, TakesTheSameForEachSeedOfAScene) {
  for (const char* const scene : {"uniform", "clustered", "power_law", "one_line", "one_point", "lattice"}) {
    for (const std::size_t boxes : {200, 2'000, 4'000}) {
      for (const std::uint64_t seed : {2, 3, 4}) {
        EXPECT_EQ(chosen_for(scene, boxes, seed), chosen_for(scene, boxes, 1)) << scene << boxes;
        EXPECT_EQ(chosen_for<3>(scene, boxes, seed), chosen_for<3>(scene, boxes, 1)) << scene << boxes;
      }
    }
  }
}

static_assert(algorithm::AutoThresholds<2>::boxes_of_an_even_tile == algorithm::TileCells<2>::max_boxes);
static_assert(algorithm::AutoThresholds<3>::boxes_of_an_even_tile == algorithm::TileCells<3>::max_boxes);

TEST(Auto, TakesWhatSuitsWhereThatIsBeyondDoubt) {
  EXPECT_EQ(chosen_for("uniform", 20, 1), "brute_force");
  EXPECT_EQ(chosen_for("uniform", 200, 1), "brute_force");
  EXPECT_EQ(chosen_for<3>("uniform", 300, 1), "brute_force");
  EXPECT_EQ(chosen_for<3>("one_point", 500, 1), "grid") << "all overlap, which one row shows";
  EXPECT_EQ(chosen_for("uniform", 5'000, 1), "grid");
  EXPECT_EQ(chosen_for("clustered", 10'000, 1), "grid") << "these clusters are even enough for a tile";
  EXPECT_EQ(chosen_for<3>("clustered", 50'000, 1), "bvh");
  // One overlap by chance among the sampled boxes would stand for a dozen tests a box.
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6})
    EXPECT_EQ(chosen_for("one_line", 100'000, seed), "sweep_and_prune") << seed;
}

/// Half of them far away from the others.
template <int D>
std::vector<Box<D>> boxes_in_two_places() {
  Rng rng(1);
  std::vector<Box<D>> boxes(200);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      boxes[i].min[axis] = rng.between(0, 1000) + (i % 2 == 0 ? 0.0F : 1e9F);
      boxes[i].max[axis] = boxes[i].min[axis] + 1;
    }
  }
  return boxes;
}

TEST(Auto, SortsFewBoxesThatBytesCannotTellApart) {
  const auto boxes = boxes_in_two_places<2>();
  Finder<2> finder("auto");
  Finder<2> reference("brute_force");
  PairHasher pairs;
  PairHasher expected;
  EXPECT_TRUE(finder.find(boxes, pairs));
  const auto statistics = reference.find(boxes, expected);
  EXPECT_THAT(finder.explanation(), testing::StartsWith("grid, since 200 boxes"));
  EXPECT_EQ(pairs.hash(), expected.hash());
  EXPECT_EQ(statistics->tests, 200 * 199 / 2) << "brute force compares them as floats";
}

TEST(Auto, TakesATreeForTwoSetsIfOneIsSmall) {
  const lab::NamedScene uniform = lab::find_scene("uniform");
  const lab::History<2> history = lab::make_history<2>(uniform.scene, uniform.spec, {.boxes = 10'000});
  Finder<2> finder("auto");
  PairCounter pairs;
  for (const std::size_t left : {1, 2'500, 7'500, 9'999}) {
    finder.find_across(history.boxes, left, pairs);
    EXPECT_THAT(finder.explanation(), testing::StartsWith("bvh, since one set has only ")) << left;
  }
  finder.find_across(history.boxes, 5'000, pairs);
  EXPECT_THAT(finder.explanation(), testing::StartsWith("grid"));
}

/// What auto's tracker says after some frames of a pile at rest.
template <int D>
std::string chosen_for_a_pile() {
  const lab::NamedScene named = lab::find_scene("pile");
  const History<D> history = lab::make_history<D>(named.scene, named.spec, {.boxes = 5'051, .frames = 6});
  Tracker<D> tracker("auto");
  PairCounter none;
  Replay<D> replay(history);
  tracker.update(replay.frame(), none, none);
  for (const Step<D>& step : history.steps) tracker.update(replay.next(step), none, none);
  return tracker.explanation();
}

TEST(AutoTracker, TestsThePairsOfEnlargedBoxesInAPileAtRest) {
  EXPECT_THAT(chosen_for_a_pile<2>(), testing::HasSubstr("pairs of boxes enlarged"));
  EXPECT_THAT(chosen_for_a_pile<3>(), testing::HasSubstr("pairs of boxes enlarged"));
}

std::vector<Box2> boxes_anywhere(std::size_t count, Rng& random) {
  std::vector<Box2> boxes(count);
  for (Box2& box : boxes) {
    for (int axis = 0; axis < 2; ++axis) {
      box.min[axis] = static_cast<float>(random.below(40));
      box.max[axis] = box.min[axis] + static_cast<float>(random.below(4));
    }
  }
  return boxes;
}

TEST(AutoTracker, ComparesFewBoxesAndKeepsToItForSomeMore) {
  Rng random(1);
  PairCounter none;
  Tracker<2> tracker("auto");
  const auto compares = [&](std::size_t count) {
    const std::vector<Box2> boxes = boxes_anywhere(count, random);
    for (int frame = 0; frame < 2; ++frame) tracker.update({boxes, {}}, none, none);
    return tracker.explanation().starts_with("brute_force, because so few");
  };
  std::size_t most = 100;
  while (compares(most) && most < 2000) most += 20;
  std::size_t again = most;
  while (!compares(again) && again > 0) again -= 20;
  EXPECT_GT(most, 100U);
  EXPECT_LT(most, 2000U);
  EXPECT_GT(again, 0U);
  EXPECT_LT(again + 20, most) << "the number at which it begins is that at which it ends";
}

TEST(AutoTracker, MissesNoEventWhereBoxesBecomeFewOrMany) {
  Rng random(7);
  Tracker<2> automatic("auto");
  Tracker<2> expected("brute_force:update=rebuild");
  std::vector<Box2> boxes;
  for (const std::size_t count : {300, 300, 500, 500, 500, 300, 280, 280, 390, 450, 450, 0, 310, 700, 20}) {
    std::vector<BoxId> changed;
    const std::vector<Box2> others = boxes_anywhere(count, random);
    boxes.resize(count, absent_box<2>());
    for (std::size_t i = 0; i < count; ++i) {
      if (is_present(boxes[i]) && !random.one_in(10)) continue;
      boxes[i] = others[i];
      changed.push_back(BoxId(i));
    }
    std::array<std::vector<Pair>, 4> events;
    PairCollector begun(events[0]);
    PairCollector ended(events[1]);
    PairCollector expected_begun(events[2]);
    PairCollector expected_ended(events[3]);
    automatic.update({boxes, changed}, begun, ended);
    expected.update({boxes, changed}, expected_begun, expected_ended);
    EXPECT_EQ(events[0], events[2]) << count;
    EXPECT_EQ(events[1], events[3]) << count;
  }
}

}  // namespace
}  // namespace broadside

// What auto chooses: for boxes of one kind always the same.
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside {
namespace {

/// What auto says that it took for a scene's boxes.
template <int D = 2>
std::string chosen_for(const char* scene, std::size_t boxes, std::uint64_t seed) {
  const lab::NamedScene named = lab::find_scene(scene);
  const lab::History<D> history =
      lab::make_history<D>(named.scene, named.spec, {.boxes = boxes, .seed = seed});
  const auto finder = make_finder<D>("auto");
  PairCounter pairs;
  finder->find(history.boxes, pairs);
  const std::string text = finder->explanation();
  return text.substr(0, text.find(','));
}

TEST(Auto, TakesTheSameForEachSeedOfAScene) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    EXPECT_EQ(chosen_for("uniform", 200, seed), "brute_force") << seed;
    EXPECT_EQ(chosen_for("uniform", 5'000, seed), "bvh") << seed;
    EXPECT_EQ(chosen_for("uniform", 50'000, seed), "grid") << seed;
    EXPECT_EQ(chosen_for("uniform:neighbours=20", 50'000, seed), "bvh") << seed;
  }
}

TEST(Auto, SeesAGoodAxisByFewOfManyBoxes) {
  // One overlap by chance among the sampled boxes would stand for a dozen tests a box.
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6})
    EXPECT_EQ(chosen_for("one_line", 100'000, seed), "sweep_and_prune") << seed;
}

TEST(Auto, SweepsAlongAThousandBoxesInALine) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    EXPECT_EQ(chosen_for("one_line", 1'000, seed), "sweep_and_prune") << seed;
    EXPECT_EQ(chosen_for("one_line", 5'000, seed), "sweep_and_prune") << seed;
  }
}

TEST(Auto, PartsNoBoxesThatAllOverlap) {
  EXPECT_EQ(chosen_for("one_point", 500, 1), "brute_force");
  EXPECT_EQ(chosen_for<3>("one_point", 500, 1), "brute_force");
  EXPECT_EQ(chosen_for("one_point", 2'000, 1), "sweep_and_prune");
  EXPECT_EQ(chosen_for<3>("one_point", 2'000, 1), "sweep_and_prune");
  EXPECT_EQ(chosen_for("one_point", 7'000, 1), "sweep_and_prune");
}

TEST(Auto, TakesCellsForFewBoxesWhereShapesSuitThem) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    EXPECT_EQ(chosen_for<3>("thin", 2'000, seed), "grid") << seed;
    EXPECT_EQ(chosen_for<3>("one_line", 3'000, seed), "grid") << seed;
    EXPECT_EQ(chosen_for<3>("lattice", 3'000, seed), "grid") << seed;
    EXPECT_EQ(chosen_for<3>("power_law", 5'000, seed), "grid") << seed;
    EXPECT_EQ(chosen_for("power_law", 5'000, seed), "grid") << seed;
    EXPECT_EQ(chosen_for<3>("uniform", 5'000, seed), "bvh") << seed;
    EXPECT_EQ(chosen_for<3>("clustered", 5'000, seed), "bvh") << seed;
    EXPECT_EQ(chosen_for("clustered", 5'000, seed), "bvh") << seed;
  }
}

std::vector<Box2> boxes_anywhere(std::size_t count, std::mt19937& random) {
  std::vector<Box2> boxes(count);
  for (Box2& box : boxes) {
    for (int axis = 0; axis < 2; ++axis) {
      box.min[axis] = static_cast<float>(random() % 40);
      box.max[axis] = box.min[axis] + static_cast<float>(random() % 4);
    }
  }
  return boxes;
}

TEST(AutoTracker, ComparesFewBoxesAndKeepsThemForSomeMore) {
  std::mt19937 random(1);
  PairCounter none;
  const auto way_of = [&](PairTracker<2>& tracker, std::size_t count) {
    const std::vector<Box2> boxes = boxes_anywhere(count, random);
    tracker.update({boxes, {}}, none, none);
    return tracker.explanation();
  };
  const auto tracker = make_tracker<2>("auto");
  EXPECT_THAT(way_of(*tracker, 360), testing::Not(testing::StartsWith("brute_force, since so few")));
  EXPECT_THAT(way_of(*tracker, 300), testing::Not(testing::StartsWith("brute_force, since so few")))
      << "360 boxes were in the frame before";
  EXPECT_THAT(way_of(*tracker, 300), testing::StartsWith("brute_force, since so few"));
  EXPECT_THAT(way_of(*tracker, 360), testing::StartsWith("brute_force, since so few"));
  EXPECT_THAT(way_of(*tracker, 410), testing::Not(testing::StartsWith("brute_force, since so few")));
}

TEST(AutoTracker, MissesNoEventWhereBoxesBecomeFewOrMany) {
  std::mt19937 random(7);
  const auto automatic = make_tracker<2>("auto");
  const auto expected = make_tracker<2>("brute_force:update=rebuild");
  std::vector<Box2> boxes;
  for (const std::size_t count : {300, 300, 500, 500, 500, 300, 280, 280, 390, 450, 450, 0, 310, 700, 20}) {
    std::vector<BoxId> changed;
    const std::vector<Box2> others = boxes_anywhere(count, random);
    boxes.resize(count, absent_box<2>());
    for (std::size_t i = 0; i < count; ++i) {
      if (is_present(boxes[i]) && random() % 10 != 0) continue;
      boxes[i] = others[i];
      changed.push_back(BoxId(i));
    }
    std::array<std::vector<Pair>, 4> events;
    PairCollector begun(events[0]);
    PairCollector ended(events[1]);
    PairCollector expected_begun(events[2]);
    PairCollector expected_ended(events[3]);
    automatic->update({boxes, changed}, begun, ended);
    expected->update({boxes, changed}, expected_begun, expected_ended);
    EXPECT_EQ(events[0], events[2]) << count;
    EXPECT_EQ(events[1], events[3]) << count;
  }
}

}  // namespace
}  // namespace broadside

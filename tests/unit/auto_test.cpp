// What auto chooses: for boxes of one kind always the same.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/sinks.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside {
namespace {

/// What auto says that it took for a scene's boxes.
std::string chosen_for(const char* scene, std::size_t boxes, std::uint64_t seed) {
  const lab::NamedScene named = lab::find_scene(scene);
  const lab::History<2> history =
      lab::make_history<2>(named.scene, named.spec, {.boxes = boxes, .seed = seed});
  const auto finder = make_finder<2>("auto");
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

}  // namespace
}  // namespace broadside

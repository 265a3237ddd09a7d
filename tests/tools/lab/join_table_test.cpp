// The SIGMOD 2025 join table's data: NumPy's numbers, rounded as they were written.
#include "lab/scenes/join_table.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"

#include "lab/scenes/scene.hpp"

namespace broadside::lab {
namespace {

TEST(JoinTable, BeginsWithTheNumbersThatNumpyDraws) {
  // numpy.random.seed(123); numpy.random.rand(3) is 0.69646919, 0.28613933, 0.22685145.
  const std::vector<DoubleBox2> boxes = join_table_set(3, join_table_left);
  EXPECT_EQ(boxes[0].min[0], 6964.69);
  EXPECT_EQ(boxes[1].min[0], 2861.39);
  EXPECT_EQ(boxes[2].min[0], 2268.51);
  EXPECT_EQ(boxes[0].max[0], 6965.69);
}

TEST(JoinTable, HasThePairsThatItsDefinitionGives) {
  // A thirtieth of the smaller published set, of whose 40,428 pairs a nine-hundredth would be 45 by chance.
  const auto left = join_table_set(30'000, join_table_left);
  const auto right = join_table_set(30'000, join_table_right);
  const std::vector<Pair> pairs = find_pairs(left, right, {.algorithm = "brute_force"});
  EXPECT_EQ(pairs.size(), 31u);
  EXPECT_EQ(find_pairs(left, right, {.algorithm = "auto"}).size(), pairs.size());
}

TEST(JoinTable, IsASceneOfEitherSetAsFloats) {
  const NamedScene scene = find_scene("join_table:set=right");
  const History<2> history = make_history<2>(scene.scene, scene.spec, {.boxes = 2});
  const std::vector<DoubleBox2> exact = join_table_set(2, join_table_right);
  EXPECT_EQ(history.boxes[1].max[1], static_cast<float>(exact[1].max[1]));
}

}  // namespace
}  // namespace broadside::lab

// What the pairs under measurement are compared with.
#include "lab/measure/reference.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

namespace broadside::lab {
namespace {

Algorithm called(std::string name) {
  Algorithm algorithm;
  algorithm.name = std::move(name);
  return algorithm;
}

TEST(Reference, IsTheDefinitionForFewBoxes) {
  const Reference reference(called("grid"), algorithms(), 20'000, 20'000);
  EXPECT_TRUE(reference.is_definition());
  EXPECT_EQ(reference.text(), "the definition");
}

TEST(Reference, IsOfAnotherStructureForMany) {
  const auto text_for = [](std::string name) {
    return Reference(called(name), algorithms(), 20'001, 20'000).text();
  };
  EXPECT_EQ(text_for("grid"), "quadtree + 200 sampled boxes");
  EXPECT_EQ(text_for("brute_force"), "quadtree + 200 sampled boxes");
  EXPECT_EQ(text_for("quadtree"), "sweep_and_prune + 200 sampled boxes");
  EXPECT_EQ(text_for("paper_quadtree"), "sweep_and_prune + 200 sampled boxes");
}

TEST(Reference, IsTheDefinitionWhereNothingElseIsKnown) {
  const std::vector<Algorithm> known = {called("mine"), called("grid")};
  EXPECT_TRUE(Reference(called("grid"), known, 1'000'000, 20'000).is_definition());
}

std::vector<Box2> some_boxes(std::size_t count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> place(0, 100);
  std::vector<Box2> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const float x = place(random);
    const float y = place(random);
    boxes.push_back({{x, y}, {x + 3, y + 3}});
  }
  return boxes;
}

TEST(CheckSample, FindsNothingWrongWithTheDefinition) {
  for (const std::size_t count : {std::size_t{2}, sampled_boxes, std::size_t{1'000}}) {
    std::vector<Box2> boxes = some_boxes(count);
    boxes[1] = absent_box<2>();
    EXPECT_FALSE(check_sample<2>(boxes, reference_pairs<2>(boxes)));
  }
}

TEST(CheckSample, FindsAMissingPairOfASampledBox) {
  const std::vector<Box2> boxes = some_boxes(1'000);
  std::vector<Pair> pairs = reference_pairs<2>(boxes);
  const std::size_t sampled = sample_of(boxes.size(), sampled_boxes).front();
  std::erase_if(pairs,
                [&](Pair pair) { return index(pair.first) == sampled || index(pair.second) == sampled; });
  const auto divergence = check_sample<2>(boxes, pairs);
  ASSERT_TRUE(divergence);
  EXPECT_EQ(divergence->kind, PairDivergence::Kind::missing);
}

TEST(CheckSample, FindsARepeatedPairOfASampledBox) {
  const std::vector<Box2> boxes = some_boxes(200);
  std::vector<Pair> pairs = reference_pairs<2>(boxes);
  pairs.insert(pairs.begin(), pairs.front());
  ASSERT_TRUE(check_sample<2>(boxes, pairs));
}

TEST(CheckSample, LooksAtOtherBoxesForAnotherSeed) {
  const std::vector<Box2> boxes = some_boxes(1'000);
  const std::vector<Pair> all = reference_pairs<2>(boxes);
  std::size_t found = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    std::vector<Pair> pairs = all;
    pairs.erase(pairs.begin());
    if (check_sample<2>(boxes, pairs, seed)) ++found;
  }
  // 36 % of the samples hold one of the pair's boxes.
  EXPECT_GT(found, 5u);
  EXPECT_LT(found, 30u);
}

TEST(ReferencePairs, AreWhatEachTestSays) {
  std::vector<Box2> boxes = some_boxes(700);
  boxes[3] = absent_box<2>();
  boxes[130] = {{-INFINITY, -INFINITY}, {INFINITY, INFINITY}};
  boxes[131] = boxes[127];
  boxes[500].min = boxes[131].max;
  boxes[500].max = boxes[131].max;
  std::vector<Pair> expected;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      if (is_present(boxes[i]) && is_present(boxes[j]) && overlap(boxes[i], boxes[j]))
        expected.push_back({BoxId(i), BoxId(j)});
    }
  }
  EXPECT_EQ(reference_pairs<2>(boxes), expected);
  const std::vector<std::size_t> some = {3, 130, 131};
  std::erase_if(expected, [&](Pair pair) {
    return std::ranges::count(some, index(pair.first)) + std::ranges::count(some, index(pair.second)) == 0;
  });
  EXPECT_EQ(reference_pairs_of<2>(boxes, some), expected);
}

TEST(SampleOf, DrawsDifferentNumbersInOrderAndAlwaysTheSame) {
  const std::vector<std::size_t> sample = sample_of(1'000, 100);
  EXPECT_EQ(std::set(sample.begin(), sample.end()).size(), 100u);
  EXPECT_TRUE(std::ranges::is_sorted(sample));
  EXPECT_LT(sample.back(), 1'000u);
  EXPECT_GT(sample.back(), 900u);
  EXPECT_EQ(sample, sample_of(1'000, 100));
  EXPECT_EQ(sample_of(3, 100), (std::vector<std::size_t>{0, 1, 2}));
}

}  // namespace
}  // namespace broadside::lab

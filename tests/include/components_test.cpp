// Components against a flood fill over the pairs, and filters_of_keys() against the keys themselves.
#include "broadside/components.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/finder.hpp"
#include "broadside/keys.hpp"

#include "tests/support/boxes.hpp"
#include "tests/support/rng.hpp"

namespace broadside {
namespace {

/// By definition: spreads each box's id to all that a pair leads to.
std::vector<BoxId> labels_by_definition(std::size_t boxes, const std::vector<Pair>& pairs) {
  std::vector<BoxId> labels(boxes);
  for (std::size_t i = 0; i < boxes; ++i) labels[i] = BoxId(i);
  for (bool changes = true; changes;) {
    changes = false;
    for (const Pair pair : pairs) {
      const BoxId least = std::min(labels[pair.first], labels[pair.second]);
      changes |= labels[pair.first] != labels[pair.second];
      labels[pair.first] = labels[pair.second] = least;
    }
  }
  return labels;
}

Box2 any_box(Rng& rng, std::size_t width) {
  const auto x = static_cast<float>(rng.below(width));
  const auto y = static_cast<float>(rng.below(width));
  return {{x, y}, {x + static_cast<float>(rng.below(3)), y + static_cast<float>(rng.below(3))}};
}

std::vector<Box2> any_boxes(Rng& rng, std::size_t count, std::size_t width) {
  std::vector<Box2> boxes(count);
  for (Box2& box : boxes) box = rng.one_in(50) ? absent_box<2>() : any_box(rng, width);
  return boxes;
}

TEST(ComponentsTest, AreThoseOfThePairsInAnyOrderAndBySeveralThreads) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Rng rng(seed);
    const std::vector<Box2> boxes = any_boxes(rng, rng.below(400), 8 + rng.below(60));
    std::vector<Pair> pairs = find_pairs(boxes);
    const std::vector<BoxId> expected = labels_by_definition(boxes.size(), pairs);
    EXPECT_EQ(components(boxes), expected) << "seed " << seed;
    Components backwards(boxes.size());
    std::ranges::reverse(pairs);
    for (const Pair pair : pairs) backwards.add(pair.second, pair.first);
    EXPECT_EQ(backwards.labels(), expected) << "seed " << seed;
    Components by_threads(boxes.size());
    Finder<2> finder("grid");
    finder.set_workers({.threads = 3, .boxes_per_thread = 1});
    finder.find(boxes, static_cast<PairSink&>(by_threads));
    EXPECT_EQ(by_threads.labels(), expected) << "seed " << seed;
  }
}

TEST(ComponentsTest, MergesTheComponentsOfClones) {
  Components all(6);
  all.add(BoxId(4), BoxId(5));
  const std::unique_ptr<PairSink> clone = all.empty_clone();
  clone->add(BoxId(1), BoxId(3));
  clone->add(BoxId(3), BoxId(5));
  clone->flush();
  all.merge(*clone);
  EXPECT_EQ(all.labels(), (std::vector{BoxId(0), BoxId(1), BoxId(2), BoxId(1), BoxId(1), BoxId(1)}));
}

TEST(ComponentsTest, RefuseABoxBeyondTheirNumber) {
  Components three(3);
  three.add(BoxId(0), BoxId(3));
  EXPECT_THROW(three.flush(), InvalidFrame);
  EXPECT_EQ(three.labels(), (std::vector{BoxId(0), BoxId(1), BoxId(2)}));
}

/// The pairs of boxes whose keys are equal, or not.
template <typename Key>
std::vector<Pair> pairs_by_keys(const std::vector<Box2>& boxes, const std::vector<Key>& keys,
                                bool are_equal) {
  std::vector<Pair> pairs = find_pairs(boxes);
  std::erase_if(pairs, [&](Pair pair) { return (keys[pair.first] == keys[pair.second]) != are_equal; });
  std::ranges::sort(pairs);
  return pairs;
}

std::vector<Pair> sorted(std::vector<Pair> pairs) {
  std::ranges::sort(pairs);
  return pairs;
}

TEST(KeysTest, OnlyTheSameOrOnlyDifferentOnesPair) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Rng rng(seed);
    const std::vector<Box2> boxes = any_boxes(rng, 100 + rng.below(900), rng.one_in(2) ? 4 : 40);
    const std::size_t kinds = std::array{1, 2, 30, 300, 3000}[rng.below(5)];
    const bool is_layered = rng.one_in(2);
    std::vector<int> keys(boxes.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
      keys[i] = static_cast<int>(is_layered ? i * kinds / keys.size() : rng.below(kinds)) - 5;
    const auto same = filters_of_keys(KeyRule::same, keys);
    const auto different = filters_of_keys(KeyRule::different, keys);
    EXPECT_EQ(sorted(find_pairs(boxes, {.filters = same})), pairs_by_keys(boxes, keys, true))
        << "seed " << seed;
    EXPECT_EQ(sorted(find_pairs(boxes, {.filters = different})), pairs_by_keys(boxes, keys, false))
        << "seed " << seed;
  }
}

TEST(KeysTest, MayBeTextsAndMeanTheSameInTwoSets) {
  const std::vector<std::string> left{"chr1", "chr2", ""};
  const std::vector<std::string> right{"chr2", "chr3"};
  const std::vector<Box2> boxes(3, Box2{{0, 0}, {1, 1}});
  const std::vector<Box2> others(2, Box2{{1, 1}, {2, 2}});
  const auto [of_left, of_right] = filters_of_keys(KeyRule::same, left, right);
  EXPECT_EQ(find_pairs(boxes, others, {.filters = of_left, .right_filters = of_right}),
            (std::vector{Pair{BoxId(1), BoxId(0)}}));
}

TEST(KeysTest, OfTwoKindsPairWhereBothRulesHold) {
  Rng rng(4);
  const std::vector<Box2> boxes = any_boxes(rng, 300, 12);
  std::vector<int> images(boxes.size());
  std::vector<std::string> classes(boxes.size());
  for (int& image : images) image = rng.whole(0, 3);
  for (std::string& one : classes) one = rng.one_in(2) ? "cat" : "dog";
  std::vector<Pair> expected = find_pairs(boxes);
  std::erase_if(expected, [&](Pair pair) {
    return images[pair.first] != images[pair.second] || classes[pair.first] == classes[pair.second];
  });
  std::ranges::sort(expected);
  std::vector<Pair> found;
  PairCollector collector(found);
  auto different = only_different(classes, classes, collector);
  find_pairs(boxes, different, {.filters = filters_of_keys(KeyRule::same, images)});
  std::ranges::sort(found);
  EXPECT_EQ(found, expected);
  EXPECT_GT(found.size(), 9U);
}

TEST(KeysTest, ApplyFiltersAsWellOrRefuseThem) {
  const std::vector<int> keys{1, 2};
  const std::vector<Filter> statics(2, Filter{.is_static = true});
  EXPECT_FALSE(accepts(filters_of_keys(KeyRule::same, std::vector{1, 1}, statics)[0], statics[0]));
  EXPECT_EQ(filters_of_keys(KeyRule::different, keys, std::vector(2, Filter{.mask = 6}))[1],
            (Filter{.mask = 6, .group = -2}));
  EXPECT_THROW(std::ignore = filters_of_keys(KeyRule::same, keys, std::vector(2, Filter{.mask = 6})),
               InvalidFrame);
  EXPECT_THROW(std::ignore = filters_of_keys(KeyRule::different, keys, std::vector(2, Filter{.group = 1})),
               InvalidFrame);
  for (const std::size_t wrong : {1, 3})
    EXPECT_THROW(std::ignore = filters_of_keys(KeyRule::same, keys, std::vector<Filter>(wrong)),
                 InvalidFrame);
}

}  // namespace
}  // namespace broadside

// The generated scenes: the same everywhere, as many boxes and as many neighbours as asked for.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"
#include "broadside/sinks.hpp"

#include "lab/scenes/scatter.hpp"
#include "lab/scenes/scene.hpp"

namespace broadside::lab {
namespace {

template <int D>
std::vector<Box<D>> boxes_of(std::string_view text, std::size_t count, std::uint64_t seed = 1) {
  const NamedScene named = find_scene(text);
  return make_history<D>(named.scene, named.spec, {.boxes = count, .seed = seed}).boxes;
}

template <int D>
std::uint64_t count_pairs(const std::vector<Box<D>>& boxes) {
  PairCounter counter;
  find_pairs(boxes, counter, {.algorithm = "brute_force"});
  return counter.count();
}

/// Over several seeds, because where few boxes are huge, much hangs on where they lie.
template <int D>
double mean_neighbours(std::string_view text, std::size_t count) {
  constexpr int seeds = 5;
  double sum = 0;
  for (int seed = 1; seed <= seeds; ++seed)
    sum +=
        2.0 * static_cast<double>(count_pairs(boxes_of<D>(text, count, seed))) / static_cast<double>(count);
  return sum / seeds;
}

/// Calls `check` with each generated scene and the boxes it makes, in each of its dimensions.
template <typename Check>
void for_each_generated(std::size_t count, Check check) {
  for (const Scene& scene : scenes()) {
    if (scene.kind != SceneKind::generated) continue;
    SCOPED_TRACE(scene.name);
    if (scene.boxes_2d) check(scene, boxes_of<2>(scene.name, count));
    if (scene.boxes_3d) check(scene, boxes_of<3>(scene.name, count));
  }
}

TEST(Scenes, MakeAsManyValidBoxesAsAskedFor) {
  for (const std::size_t count : {0, 1, 2, 3, 500}) {
    for_each_generated(count, [count](const Scene&, const auto& boxes) {
      EXPECT_EQ(boxes.size(), count);
      EXPECT_TRUE(std::ranges::all_of(boxes, [](const auto& box) { return is_present(box); }));
    });
  }
}

TEST(Scenes, AreTheSameForASeedAndDifferentForAnother) {
  for (const Scene& scene : scenes()) {
    if (scene.kind != SceneKind::generated) continue;
    SCOPED_TRACE(scene.name);
    EXPECT_EQ(boxes_of<2>(scene.name, 100, 7), boxes_of<2>(scene.name, 100, 7));
    EXPECT_EQ(boxes_of<2>(scene.name, 100, 7) == boxes_of<2>(scene.name, 100, 8), scene.fixed_seed);
    if (!scene.has_dimension(3)) continue;
    EXPECT_EQ(boxes_of<3>(scene.name, 100, 7), boxes_of<3>(scene.name, 100, 7));
    EXPECT_EQ(boxes_of<3>(scene.name, 100, 7) == boxes_of<3>(scene.name, 100, 8), scene.fixed_seed);
  }
}

TEST(Scenes, HaveIntegerCoordinatesWhereTheySaySo) {
  for_each_generated(500, [](const Scene& scene, const auto& boxes) {
    const auto is_whole = [](float coordinate) { return coordinate == std::floor(coordinate); };
    const bool whole = std::ranges::all_of(boxes, [&](const auto& box) {
      return std::ranges::all_of(box.min, is_whole) && std::ranges::all_of(box.max, is_whole);
    });
    EXPECT_EQ(whole, scene.integers);
  });
}

/// A number that tells any two arrays of boxes apart, their order included.
template <int D>
std::uint64_t fingerprint(const std::vector<Box<D>>& boxes) {
  std::uint64_t fingerprint = 0;
  for (const Box<D>& box : boxes) {
    for (const auto& corner : {box.min, box.max}) {
      for (const float coordinate : corner)
        fingerprint =
            fingerprint * 0x9e3779b97f4a7c15U + static_cast<std::uint64_t>(std::int64_t(coordinate));
    }
  }
  return fingerprint;
}

TEST(Scenes, MadeOfIntegersAreTheSameUnderEveryCompiler) {
  EXPECT_EQ(fingerprint(boxes_of<2>("integers", 1000)), 0x92b62a4ba609a3d9U);
  EXPECT_EQ(fingerprint(boxes_of<3>("integers", 1000)), 0x40f12bae98da8ad1U);
  EXPECT_EQ(fingerprint(boxes_of<2>("lattice", 1000)), 0x1fd039b1e1b24658U);
  EXPECT_EQ(fingerprint(boxes_of<3>("lattice", 1000)), 0x9449edc6b0ee5500U);
  EXPECT_EQ(fingerprint(boxes_of<2>("terdiman", 1000)), 0x47c3e149dc09e378U);
  EXPECT_EQ(fingerprint(boxes_of<3>("terdiman", 1000)), 0x68d509b3321d965aU);
}

TEST(Scenes, GiveABoxFourNeighboursOnAverage) {
  for (const char* name : {"uniform", "power_law", "mixed", "clustered", "one_line", "thin"}) {
    SCOPED_TRACE(name);
    for (const std::size_t count : {500, 2000}) {
      EXPECT_NEAR(mean_neighbours<2>(name, count), 4, 0.8);
      EXPECT_NEAR(mean_neighbours<3>(name, count), 4, 0.8);
    }
  }
}

TEST(Integers, GiveABoxFewNeighbours) {
  EXPECT_NEAR(mean_neighbours<2>("integers", 2000), 3.8, 0.4);
  EXPECT_NEAR(mean_neighbours<3>("integers", 2000), 3.3, 0.4);
}

TEST(Scenes, GiveABoxAsManyNeighboursAsTheTunableSays) {
  for (const char* name : {"uniform", "power_law", "mixed", "clustered", "one_line", "thin"}) {
    SCOPED_TRACE(name);
    const std::string dense = std::string(name) + ":neighbours=40";
    EXPECT_NEAR(mean_neighbours<2>(dense, 2000), 40, 8);
    EXPECT_NEAR(mean_neighbours<3>(dense, 2000), 40, 14);
  }
}

TEST(Scenes, LetEveryBoxTouchEveryOtherWhereMoreNeighboursAreAskedForThanThereAre) {
  EXPECT_EQ(count_pairs(boxes_of<2>("uniform:neighbours=1000", 50)), 50u * 49 / 2);
  EXPECT_EQ(count_pairs(boxes_of<3>("one_line:neighbours=1000", 50)), 50u * 49 / 2);
}

TEST(OnePoint, MakesEveryPairOverlap) {
  EXPECT_EQ(count_pairs(boxes_of<2>("one_point", 300)), 300u * 299 / 2);
  EXPECT_EQ(count_pairs(boxes_of<3>("one_point", 300)), 300u * 299 / 2);
}

TEST(OneLine, GivesAllBoxesTheSameIntervalOnX) {
  for (const Box3& box : boxes_of<3>("one_line", 100)) {
    EXPECT_EQ(box.min[0], -0.5F);
    EXPECT_EQ(box.max[0], 0.5F);
  }
}

TEST(Lattice, TouchesAllNeighboursAndNothingElse) {
  // On a full lattice of side s: (pairs one step apart in each direction of half the neighbourhood).
  EXPECT_EQ(count_pairs(boxes_of<2>("lattice", 100)), 2u * 10 * 9 + 2u * 9 * 9);
  EXPECT_EQ(count_pairs(boxes_of<3>("lattice", 1000)), 3u * 100 * 9 + 6u * 10 * 81 + 4u * 729);
}

TEST(Mixed, MakesOneBoxInAHundredHuge) {
  const std::vector<Box2> boxes = boxes_of<2>("mixed", 1000);
  EXPECT_EQ(std::ranges::count_if(boxes, [](const Box2& box) { return box.max[0] - box.min[0] > 10; }), 10);
}

TEST(PowerLaw, KeepsSizesWithinTheRatioAndMostOfThemSmall) {
  std::vector<double> sizes;
  for (const Box2& box : boxes_of<2>("power_law:exponent=2:ratio=100", 10000))
    sizes.push_back(box.max[0] - box.min[0]);
  std::ranges::sort(sizes);
  EXPECT_GT(sizes.front(), 0.49);
  EXPECT_LT(sizes.back(), 151);
  EXPECT_GT(sizes.back(), 50);
  // With density s^-2 half of the sizes lie below 2.
  EXPECT_NEAR(sizes[sizes.size() / 2], 2, 0.3);
}

TEST(Churn, KeepsAboutAsManyBoxesAndNeighboursAsItHadAtFirst) {
  const NamedScene named = find_scene("churn");
  const History<2> history = make_history<2>(named.scene, named.spec, {.boxes = 2000, .frames = 40});
  std::vector<Box2> boxes = history.boxes;
  for (const Step<2>& step : history.steps) lab::apply(step, boxes);
  EXPECT_EQ(history.boxes.size(), 2000u);
  EXPECT_NEAR(static_cast<double>(boxes.size()), 2000, 1000);
  EXPECT_GT(count_pairs(boxes), boxes.size() / 2);
  EXPECT_LT(count_pairs(boxes), boxes.size() * 4);
}

TEST(Terdiman, HasExactlyThePublishedPairs) {
  EXPECT_EQ(count_pairs(boxes_of<3>("terdiman", 10000)), 11811u);
}

TEST(Power, AgreesWithTheStandardLibrarys) {
  for (const double base : {0.001, 0.5, 1.0, 7.0, 1e6}) {
    for (const double exponent : {-3.25, -0.5, 0.0, 1.0 / 3, 1.0, 2.75})
      EXPECT_NEAR(power(base, exponent) / std::pow(base, exponent), 1, 1e-8);
  }
}

TEST(FindScene, NamesTheScenesThereAre) {
  try {
    find_scene("unifrom");
    FAIL() << "found a scene that does not exist";
  } catch (const InvalidSpec& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'unifrom'"));
    EXPECT_THAT(error.what(), testing::HasSubstr("uniform, power_law"));
  }
}

TEST(FindScene, RefusesUnknownTunablesAndValuesOutOfRange) {
  EXPECT_THROW(find_scene("uniform:colour=red"), InvalidSpec);
  EXPECT_THROW(find_scene("uniform:neighbours=-1"), InvalidSpec);
  EXPECT_THROW(find_scene("clustered:clusters=1.5"), InvalidSpec);
}

TEST(MakeHistory, RefusesADimensionThatTheSceneDoesNotHave) {
  Scene flat = find_scene("uniform").scene;
  flat.boxes_3d = nullptr;
  EXPECT_THROW(make_history<3>(flat, Spec{flat.name, {}}, {}), InvalidSpec);
}

/// The pile's frames, one after the other.
template <int D>
std::vector<std::vector<Box<D>>> pile_frames(std::string_view text, const SceneRequest& request) {
  const NamedScene named = find_scene(text);
  const History<D> history = make_history<D>(named.scene, named.spec, request);
  std::vector<std::vector<Box<D>>> frames = {history.boxes};
  for (const Step<D>& step : history.steps) {
    frames.push_back(frames.back());
    lab::apply(step, frames.back());
  }
  return frames;
}

template <int D>
std::vector<Pair> pairs_of(const std::vector<Box<D>>& boxes) {
  std::vector<Pair> pairs = find_pairs(boxes, {.algorithm = "brute_force"});
  std::ranges::sort(pairs);
  return pairs;
}

template <int D>
void check_that_a_pile_rests(std::size_t min_pairs) {
  constexpr std::size_t count = 800;
  const auto frames = pile_frames<D>("pile", {.boxes = count, .seed = 3, .frames = 20});
  std::vector<Pair> pairs = pairs_of(frames[0]);
  EXPECT_GT(pairs.size(), min_pairs);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    std::size_t moved = 0;
    float furthest = 0;
    for (std::size_t box = 0; box < count; ++box) {
      moved += frames[i][box] == frames[i - 1][box] ? 0 : 1;
      for (int axis = 0; axis < D; ++axis)
        furthest = std::max(furthest, std::abs(frames[i][box].min[axis] - frames[i - 1][box].min[axis]));
    }
    EXPECT_GT(moved, count - 10) << "all but the ground tremble";
    EXPECT_LT(furthest, 0.01F);
    EXPECT_GT(furthest, 0.0005F) << "it sways, beside trembling";
    const std::vector<Pair> now = pairs_of(frames[i]);
    std::vector<Pair> changed;
    std::ranges::set_symmetric_difference(pairs, now, std::back_inserter(changed));
    EXPECT_LT(changed.size(), min_pairs / 100);
    pairs = now;
  }
}

TEST(PileScene, TremblesAndHardlyChangesItsPairs) {
  check_that_a_pile_rests<2>(2000);
  check_that_a_pile_rests<3>(4000);
}

TEST(PileScene, IsTheSameUnderEveryCompiler) {
  const auto hash = []<int D>() {
    std::uint64_t sum = 0;
    for (const auto& boxes : pile_frames<D>("pile", {.boxes = 500, .seed = 1, .frames = 10})) {
      for (const Box<D>& box : boxes) {
        for (const auto& corner : {box.min, box.max}) {
          for (const float coordinate : corner)
            sum = sum * 0x9e3779b97f4a7c15U + std::bit_cast<std::uint32_t>(coordinate);
        }
      }
    }
    return sum;
  };
  EXPECT_EQ(hash.operator()<2>(), 0x8bcb3a95b5102fbeU);
  EXPECT_EQ(hash.operator()<3>(), 0xab7f04e57ff83e32U);
}

TEST(PileScene, HasAsManyBoxesAsAskedFor) {
  const auto check = []<int D>(std::size_t count) {
    for (const auto& boxes : pile_frames<D>("pile", {.boxes = count, .frames = 3})) {
      EXPECT_EQ(boxes.size(), count);
      EXPECT_TRUE(std::ranges::all_of(boxes, [](const Box<D>& box) { return is_present(box); })) << count;
    }
  };
  for (const std::size_t count : {0, 1, 2, 3, 5, 2000}) {
    check.operator()<2>(count);
    check.operator()<3>(count);
  }
}

TEST(PileScene, BeginsAlikeForAnyNumberOfFrames) {
  const auto few = pile_frames<2>("pile:speed=0", {.boxes = 300, .frames = 2});
  const auto many = pile_frames<2>("pile:speed=0", {.boxes = 300, .frames = 5});
  EXPECT_TRUE(std::equal(few.begin(), few.end(), many.begin()));
}

TEST(JumpsScene, PutsEveryBoxElsewhereInOneFrameAndATenthOnALittleInOthers) {
  const NamedScene named = find_scene("jumps:every=3");
  const History<2> history = make_history<2>(named.scene, named.spec, {.boxes = 200, .seed = 5, .frames = 7});
  ASSERT_EQ(history.steps.size(), 7u);
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_EQ(history.steps[i].changed.size(), (i + 1) % 3 == 0 ? 200u : 20u) << i;
  EXPECT_NE(history.steps[2].boxes, history.boxes);
  EXPECT_NE(history.steps[5].boxes, history.steps[2].boxes);
}

}  // namespace
}  // namespace broadside::lab

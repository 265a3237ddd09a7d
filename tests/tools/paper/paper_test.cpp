// The paper's four algorithms, mended: right on every kind of input, and they count as the listings would.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"
#include "broadside/find_pairs.hpp"
#include "broadside/finder.hpp"

#include "lab/verify/verify.hpp"
#include "tests/support/boxes.hpp"

namespace broadside {
namespace {

constexpr float largest = std::numeric_limits<float>::max();

/// Expects `spec` to find exactly the pairs of `boxes`, each once; returns what it counted.
template <int D>
Statistics expect_right(const std::string& spec, const std::vector<Box<D>>& boxes) {
  Finder<D> finder(spec);
  const auto divergence = lab::check_finder<D>(finder, boxes, spec);
  EXPECT_FALSE(divergence) << divergence->text;
  PairCounter pairs;
  return finder.find(boxes, pairs).value_or(Statistics{});
}

/// Every paper algorithm, and those with a world in one that is far too small as well.
template <int D>
std::vector<std::string> specs() {
  std::vector<std::string> specs = {"paper_brute_force", "paper_sweep_and_prune"};
  if (D == 2) {
    for (const char* const spec :
         {"paper_grid", "paper_grid:cell=0.01", "paper_grid:left=4:top=4:width=2:height=2:cell=0.5",
          "paper_quadtree", "paper_quadtree:capacity=1",
          "paper_quadtree:left=4:top=4:width=2:height=2:capacity=2"})
      specs.emplace_back(spec);
  }
  return specs;
}

template <int D>
void expect_all_right(const std::vector<Box<D>>& boxes) {
  for (const std::string& spec : specs<D>()) expect_right<D>(spec, boxes);
}

/// `count` boxes in a world of `world` units, with extents of up to `size`.
template <int D>
std::vector<Box<D>> uniform(std::size_t count, float world, float size) {
  std::mt19937 random(1);
  std::vector<Box<D>> boxes(count);
  const auto below = [&random](float most) { return most * static_cast<float>(random() >> 8) * 0x1p-24F; };
  for (Box<D>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = below(world);
      box.max[axis] = box.min[axis] + below(size);
    }
  }
  return boxes;
}

/// Boxes with all combinations of extents from `values` on the first two axes, and [0, 1] on a third.
template <int D>
std::vector<Box<D>> combinations(const std::vector<float>& values) {
  std::vector<Box<D>> boxes;
  for (const float a : values) {
    for (const float b : values) {
      for (const float c : values) {
        for (const float d : values) {
          Box<D> box{};
          box.max.fill(1);
          box.min[0] = std::min(a, b);
          box.max[0] = std::max(a, b);
          box.min[1] = std::min(c, d);
          box.max[1] = std::max(c, d);
          boxes.push_back(box);
        }
      }
    }
  }
  return boxes;
}

template <typename Dimension>
class Paper : public testing::Test {};

template <int D>
struct Dimension {
  static constexpr int value = D;
};

using Dimensions = testing::Types<Dimension<2>, Dimension<3>>;
TYPED_TEST_SUITE(Paper, Dimensions);

TYPED_TEST(Paper, IsRightOnRandomBoxes) {
  constexpr int D = TypeParam::value;
  for (const float size : {0.0F, 0.1F, 1.0F, 8.0F}) expect_all_right<D>(uniform<D>(400, 10, size));
}

TYPED_TEST(Paper, IsRightOnNoneOneAndTwo) {
  constexpr int D = TypeParam::value;
  const std::vector<Box<D>> boxes(2);
  for (std::size_t count : {0, 1, 2}) expect_all_right<D>({boxes.begin(), boxes.begin() + count});
}

TYPED_TEST(Paper, IsRightOnTiesAndZeros) {
  expect_all_right<TypeParam::value>(combinations<TypeParam::value>({-1, -0.0F, 0.0F, 1, 2}));
}

TYPED_TEST(Paper, IsRightOnInfiniteBoxesAndTheLargestFloats) {
  expect_all_right<TypeParam::value>(
      combinations<TypeParam::value>({-infinity, -largest, 0, largest, infinity}));
}

TYPED_TEST(Paper, IsRightWhereAllBoxesCoincide) {
  constexpr int D = TypeParam::value;
  for (const float extent : {0.0F, 1.0F}) {
    Box<D> box;
    box.min.fill(5);
    box.max.fill(5 + extent);
    expect_all_right<D>(std::vector<Box<D>>(300, box));
  }
}

TYPED_TEST(Paper, IsRightWhereAllXAreEqual) {
  constexpr int D = TypeParam::value;
  for (const float extent : {0.0F, 1.0F}) {
    std::vector<Box<D>> boxes = uniform<D>(300, 10, 0.1F);
    for (Box<D>& box : boxes) {
      box.min[0] = 3;
      box.max[0] = 3 + extent;
    }
    expect_all_right<D>(boxes);
  }
}

TYPED_TEST(Paper, IsRightOnTinyBoxesFarFromEachOther) {
  constexpr int D = TypeParam::value;
  std::vector<Box<D>> boxes = uniform<D>(300, 1, 0.1F);
  for (std::size_t i = 0; i < boxes.size(); i += 3) {
    boxes[i].min[0] += 1e30F;
    boxes[i].max[0] += 1e30F;
  }
  expect_all_right<D>(boxes);
}

TEST(PaperBruteForce, TestsEveryTwoBoxesOnce) {
  const Statistics statistics = expect_right<2>("paper_brute_force", uniform<2>(100, 10, 1));
  EXPECT_EQ(statistics.tests, 100U * 99U / 2U);
  EXPECT_EQ(statistics.references, 100U);
}

TEST(PaperSweepAndPrune, TestsTheBoxesThatOverlapOnTheXAxis) {
  std::vector<Box2> boxes = uniform<2>(200, 10, 1);
  std::vector<Box2> projections = boxes;
  for (Box2& box : projections) {
    box.min[1] = 0;
    box.max[1] = 0;
  }
  const Statistics statistics = expect_right<2>("paper_sweep_and_prune", boxes);
  EXPECT_EQ(statistics.tests, lab::reference_pairs<2>(projections).size());
  EXPECT_EQ(statistics.references, 200U);
}

TEST(PaperGrid, FilesABoxInEveryCellThatItTouches) {
  const std::vector<Box2> boxes = {{{0, 0}, {10, 10}}, {{5, 5}, {5, 5}}, {{9, 0}, {10, 1}}};
  const Statistics statistics = expect_right<2>("paper_grid:cell=5", boxes);
  EXPECT_EQ(statistics.references, 4U + 1U + 1U);
  EXPECT_EQ(statistics.tests, 2U);
}

TEST(PaperGrid, ChoosesACellThatSparesTests) {
  const std::vector<Box2> boxes = uniform<2>(2000, 100, 2);
  const Statistics statistics = expect_right<2>("paper_grid", boxes);
  EXPECT_LT(statistics.tests, 20U * boxes.size());
  EXPECT_LT(statistics.references, 4U * boxes.size());
}

TEST(PaperQuadtree, SplitsALeafThatHoldsMoreThanItsCapacity) {
  const std::vector<Box2> boxes = {{{0, 0}, {1, 1}}, {{9, 9}, {10, 10}}, {{9, 0}, {10, 1}}};
  EXPECT_EQ(expect_right<2>("paper_quadtree:capacity=3", boxes).tests, 3U);
  EXPECT_EQ(expect_right<2>("paper_quadtree:capacity=2", boxes).tests, 0U);
}

TEST(PaperQuadtree, SplitsWhereAllBoxesLieInOneCorner) {
  std::vector<Box2> boxes = uniform<2>(1000, 1, 0.01F);
  boxes.push_back({{1e6F, 1e6F}, {1e6F, 1e6F}});
  EXPECT_LT(expect_right<2>("paper_quadtree", boxes).tests, 20U * boxes.size());
}

TEST(PaperGridAndQuadtree, HoldFewReferencesWhereBoxesAreInfinite) {
  std::vector<Box2> boxes = uniform<2>(1000, 100, 1);
  for (std::size_t i = 0; i < boxes.size(); i += 2) boxes[i] = {{-infinity, -infinity}, {infinity, infinity}};
  for (const char* const spec : {"paper_grid", "paper_quadtree"})
    EXPECT_LE(expect_right<2>(spec, boxes).references, 16U * boxes.size()) << spec;
}

/// Counts pairs, and makes all boxes invalid at the first ones: as another thread might.
class SpoilingSink final : public PairSink {
 public:
  explicit SpoilingSink(std::vector<Box2>& boxes) : boxes_(boxes) {}
  std::size_t count() const { return count_; }

 private:
  void consume(std::span<const Pair> pairs) override {
    count_ += pairs.size();
    std::ranges::fill(boxes_, Box2{{NAN, infinity}, {-infinity, NAN}});
  }

  std::vector<Box2>& boxes_;
  std::size_t count_ = 0;
};

TEST(PaperListings, LookAtNoBoxThatChangesWhileTheySearch) {
  const std::vector<Box2> boxes = uniform<2>(3000, 100, 4);
  const std::size_t expected = find_pairs(boxes, {.algorithm = "brute_force"}).size();
  ASSERT_GT(expected, 2000u);
  for (const std::string& spec : specs<2>()) {
    std::vector<Box2> spoiled = boxes;
    SpoilingSink pairs(spoiled);
    Finder<2>(spec).find(spoiled, pairs);
    EXPECT_EQ(pairs.count(), expected) << spec;
  }
}

TEST(PaperGridAndQuadtree, Are2DOnly) {
  for (const char* const name : {"paper_grid", "paper_quadtree"}) {
    const Algorithm* const algorithm = find_algorithm(name);
    ASSERT_NE(algorithm, nullptr);
    EXPECT_THAT(algorithm->summary, testing::HasSubstr("2D only"));
    EXPECT_THROW(Finder<3>{name}, InvalidSpec);
  }
}

}  // namespace
}  // namespace broadside

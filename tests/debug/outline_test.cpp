// outline(): what algorithms lay over boxes holds these boxes, and is finite.
#include "broadside/debug/outline.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "broadside/algorithm.hpp"
#include "broadside/error.hpp"
#include "broadside/sinks.hpp"

#include "tests/support/boxes.hpp"

namespace broadside {
namespace {

/// Boxes of up to some cells' size, a few large ones among them, at whole places of a world of 1000.
template <int D, typename Real = float>
std::vector<Box<D, Real>> scattered(std::size_t count) {
  std::vector<Box<D, Real>> boxes(count);
  std::uint32_t state = 7;
  const auto up_to = [&state](std::uint32_t most) {
    state = state * 1664525 + 1013904223;
    return static_cast<Real>((state >> 8) % (most + 1));
  };
  for (std::size_t i = 0; i < count; ++i) {
    for (int axis = 0; axis < D; ++axis) {
      boxes[i].min[axis] = up_to(1000);
      boxes[i].max[axis] = boxes[i].min[axis] + up_to(i % 50 == 0 ? 300 : 8);
    }
  }
  return boxes;
}

/// The library's algorithms that do D dimensions and lay something over boxes.
template <int D>
std::vector<std::string> outlined() {
  std::vector<std::string> all;
  for (const Algorithm& algorithm : algorithms()) {
    if (algorithm.has_dimension(D) && !algorithm.name.ends_with("brute_force")) all.push_back(algorithm.name);
  }
  return all;
}

template <int D>
Outline<D> outline_by(const std::string& spec, const std::vector<Box<D>>& boxes) {
  return outline<D, float>(spec, boxes);
}

template <int D>
bool holds(const Box<D>& part, const std::array<float, D>& point) {
  return overlap(part, Box<D>{point, point});
}

/// Whether two parts share more than a border.
template <int D>
bool share_room(const Box<D>& a, const Box<D>& b) {
  bool sharing = true;
  for (int axis = 0; axis < D; ++axis)
    sharing &= std::max(a.min[axis], b.min[axis]) < std::min(a.max[axis], b.max[axis]);
  return sharing;
}

template <int D>
void expect_each_box_begins_in_a_part() {
  const std::vector<Box<D>> boxes = scattered<D>(7000);  // so many that `auto` takes cells
  for (const std::string& name : outlined<D>()) {
    const Outline<D> outline = outline_by<D>(name, boxes);
    ASSERT_FALSE(outline.levels.empty()) << name;
    for (const Box<D>& box : boxes) {
      const auto& parts = outline.levels.front();
      ASSERT_TRUE(std::ranges::any_of(parts, [&](const Box<D>& part) { return holds<D>(part, box.min); }))
          << name << ": " << box.min[0] << ", " << box.min[1];
    }
  }
}

TEST(Outline, HasAPartForWhereEachBoxBegins) {
  expect_each_box_begins_in_a_part<2>();
  expect_each_box_begins_in_a_part<3>();
}

template <int D>
void expect_parts_share_no_room() {
  const std::vector<Box<D>> boxes = scattered<D>(1500);
  for (const std::string& name : outlined<D>()) {
    if (name == "bvh" || name == "auto") continue;  // bounds may overlap
    const Outline<D> outline = outline_by<D>(name, boxes);
    for (const auto& level : outline.levels) {
      for (std::size_t i = 0; i < level.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) ASSERT_FALSE(share_room<D>(level[i], level[j])) << name;
      }
    }
  }
}

TEST(Outline, HasPartsThatShareNoRoomOnALevel) {
  expect_parts_share_no_room<2>();
  expect_parts_share_no_room<3>();
}

TEST(Outline, OfATreeOfBoundsHasALeafAroundEachBox) {
  const std::vector<Box2> boxes = scattered<2>(1500);
  const Outline<2> outline = outline_by<2>("bvh", boxes);
  for (const Box2& box : boxes) {
    EXPECT_TRUE(std::ranges::any_of(outline.levels.back(), [&](const Box2& leaf) {
      return holds<2>(leaf, box.min) && holds<2>(leaf, box.max);
    }));
  }
}

TEST(Outline, OfAQuadtreeSplitsNodesIntoTheirChildren) {
  for (const std::string name : {"quadtree:capacity=20", "paper_quadtree"}) {
    const Outline<2> outline = outline_by<2>(name, scattered<2>(1500));
    ASSERT_GE(outline.levels.size(), 3U) << name;
    EXPECT_EQ(outline.levels[0].size(), 1U);
    for (std::size_t level = 1; level < outline.levels.size(); ++level) {
      for (const Box2& node : outline.levels[level]) {
        EXPECT_TRUE(std::ranges::any_of(outline.levels[level - 1], [&](const Box2& parent) {
          return holds<2>(parent, node.min) && holds<2>(parent, node.max);
        })) << name;
      }
    }
  }
}

template <int D>
void expect_finite_parts() {
  std::vector<Box<D>> boxes = scattered<D>(700);
  boxes[3].min.fill(-infinity);
  boxes[5].max.fill(infinity);
  boxes[7].min[0] = -infinity;
  boxes[7].max[0] = infinity;
  boxes[9] = absent_box<D>();
  for (const std::string& name : outlined<D>()) {
    const Outline<D> outline = outline_by<D>(name, boxes);
    EXPECT_FALSE(outline.caption.empty()) << name;
    ASSERT_FALSE(outline.levels.empty()) << name;
    for (const auto& level : outline.levels) {
      EXPECT_FALSE(level.empty()) << name;
      for (const Box<D>& part : level) {
        ASSERT_TRUE(is_present(part)) << name;
        for (int axis = 0; axis < D; ++axis)
          ASSERT_TRUE(std::isfinite(part.min[axis]) && std::isfinite(part.max[axis])) << name;
      }
    }
  }
}

TEST(Outline, IsFiniteWhateverTheBoxes) {
  expect_finite_parts<2>();
  expect_finite_parts<3>();
}

TEST(Outline, TakesNoBoxesOneAndOnlyInfiniteOnes) {
  for (const std::string& name : outlined<2>()) {
    EXPECT_TRUE(outline_by<2>(name, {}).levels.empty()) << name;
    EXPECT_TRUE(outline_by<2>(name, {absent_box<2>()}).levels.empty()) << name;
    for (const Box2& only : {Box2{{1, 2}, {3, 4}}, Box2{{-infinity, -infinity}, {infinity, infinity}}}) {
      for (const auto& level : outline_by<2>(name, {only}).levels) {
        for (const Box2& part : level) EXPECT_TRUE(is_present(part) && std::isfinite(part.max[0])) << name;
      }
    }
  }
}

TEST(Outline, IsEmptyWhereAFinderLaysNothingOverBoxes) {
  const Outline<2> outline = outline_by<2>("brute_force", scattered<2>(10));
  EXPECT_TRUE(outline.kind.empty());
  EXPECT_TRUE(outline.levels.empty());
}

TEST(Outline, TellsTheAxisThatIsSwept) {
  const std::vector<Box2> boxes = scattered<2>(1000);
  EXPECT_EQ(outline_by<2>("sweep_and_prune:axis=y", boxes).swept_axis, 1);
  EXPECT_EQ(outline_by<2>("sweep_and_prune:axis=x:axes=1", boxes).caption, "one sweep along x");
  EXPECT_EQ(outline_by<2>("paper_sweep_and_prune", boxes).swept_axis, 0);
  EXPECT_EQ(outline_by<2>("quadtree", boxes).swept_axis, -1);
}

TEST(Outline, OfStripesHasAsManyAsTheCaptionSays) {
  const Outline<2> outline = outline_by<2>("sweep_and_prune:axis=x:axes=2", scattered<2>(1000));
  EXPECT_EQ(outline.kind, "stripes");
  EXPECT_EQ(outline.caption, std::to_string(outline.levels[0].size()) + " stripes of y, each swept along x");
}

TEST(Outline, OfAGridHasCellsOfTheSizeAskedFor) {
  const Outline<2> outline = outline_by<2>("paper_grid:cell=100:width=1000:height=500", scattered<2>(1000));
  EXPECT_EQ(outline.caption, "10 x 5 cells of 100");
  ASSERT_EQ(outline.levels[0].size(), 50U);
  EXPECT_EQ(outline.levels[0][0].max[0] - outline.levels[0][0].min[0], 100);
}

TEST(Outline, OfAnAlgorithmThatChoosesIsThatOfItsChoice) {
  const std::vector<Box2> few = scattered<2>(20);
  EXPECT_EQ(outline_by<2>("auto", few).caption, "brute_force");
  const std::vector<Box2> some = scattered<2>(2000);
  EXPECT_EQ(outline_by<2>("auto", some).levels, outline_by<2>("grid", some).levels);
  EXPECT_EQ(outline_by<2>("auto", some).caption, "grid: " + outline_by<2>("grid", some).caption);
}

TEST(Outline, OfDoublesIsThatOfTheirFloats) {
  std::vector<Box<2, double>> boxes = scattered<2, double>(500);
  for (Box<2, double>& box : boxes) {
    for (double* const x : {&box.min[0], &box.max[0]}) *x += 1e9;
  }
  const Outline<2, double> doubles = outline<2, double>("quadtree:capacity=20", boxes);
  const Outline<2> floats = outline_by<2>("quadtree:capacity=20", scattered<2>(500));
  ASSERT_EQ(doubles.levels.size(), floats.levels.size());
  EXPECT_EQ(doubles.caption, floats.caption);
  EXPECT_EQ(doubles.levels[1][0].max[0] - 1e9, floats.levels[1][0].max[0]);
}

TEST(Outline, RefusesWhatAFindRefuses) {
  std::vector<Box2> boxes = scattered<2>(10);
  boxes[4].min[0] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(outline_by<2>("grid", boxes), InvalidInput);
}

}  // namespace
}  // namespace broadside

// Drawings: boxes and what algorithms lay over them as paths, as JSON and as SVG.
#include "lab/report/drawing.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "lab/report/drawing_paths.hpp"
#include "tests/support/boxes.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

/// Of a hundred units both ways, ten to one of the world.
const Window ten_by_ten = {{0, 0}, {10, 10}, 100, 100};

std::string rectangle(const Rectangle& rectangle) {
  std::string path;
  append_rectangle(path, rectangle, ten_by_ten);
  return path;
}

TEST(DrawingPaths, ShowWhatIsGreaterInYHigherUp) {
  EXPECT_EQ(rectangle({{1, 2}, {4, 4}}), "M10 60h30v20h-30z");
  EXPECT_EQ(rectangle({{1.25, 2}, {4, 4.01}}), "M12.5 59.9h27.5v20.1h-27.5z");
}

TEST(DrawingPaths, AreClippedToTheWindow) {
  EXPECT_EQ(rectangle({{-infinity, 9}, {infinity, infinity}}), "M0 0h100v10h-100z");
  EXPECT_EQ(rectangle({{11, 0}, {12, 1}}), "");
  EXPECT_EQ(rectangle({{5, 5}, {5, 5}}), "M48 48h4v4h-4z") << "a point is seen";
  EXPECT_EQ(rectangle({{5, 5}, {6, 5}}), "M50 50h10v0h-10z");
}

TEST(DrawingPaths, HaveALineOnceWhereCellsMeet) {
  Edges edges(ten_by_ten);
  EXPECT_EQ(edges.next_level(std::vector<Rectangle>{{{0, 0}, {5, 10}}, {{5, 0}, {10, 10}}}),
            "M0 0h100M0 100h100M0 0v100M50 0v100M100 0v100");
  EXPECT_EQ(edges.next_level(std::vector<Rectangle>{{{0, 0}, {5, 5}}, {{2, 2}, {7, 8}}}),
            "M20 20h50M0 50h50M20 80h50M20 20v60M70 20v60");
}

TEST(DrawingPaths, ShowAWindowThatLeavesOutliersOut) {
  std::vector<Rectangle> rectangles;
  for (int i = 0; i <= 200; ++i) {
    const double x = i;
    rectangles.push_back({{x, x / 2}, {x + 1, x / 2 + 1}});
  }
  rectangles.push_back({{1e30, 1e30}, {1e31, 1e31}});
  const Window window = window_on(rectangles);
  EXPECT_LT(window.high[0], 300);
  EXPECT_GT(window.high[0], 200);
  EXPECT_EQ(window.width, 1000);
  EXPECT_GT(window.height, 450);
  EXPECT_LT(window.height, 600);
}

TEST(DrawingPaths, HaveAWindowForPointsLinesAndNothingFinite) {
  for (const std::vector<Rectangle>& rectangles : {std::vector<Rectangle>{},
                                                   {{{3, 3}, {3, 3}}},
                                                   {{{-infinity, -infinity}, {infinity, infinity}}},
                                                   {{{0, 5}, {9, 5}}}}) {
    const Window window = window_on(rectangles);
    EXPECT_LT(window.low[0], window.high[0]);
    EXPECT_LT(window.low[1], window.high[1]);
    EXPECT_GE(window.height, 200);
    EXPECT_LE(window.height, 1000);
  }
}

std::vector<Box2> ladder(std::size_t count) {
  std::vector<Box2> boxes;
  for (std::size_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(i % 40);
    const auto y = static_cast<float>(i / 40);
    boxes.push_back({{x, y}, {x + 0.75F, y + 0.75F}});
  }
  return boxes;
}

Drawing drawn(const std::string& algorithms, const std::vector<Box2>& boxes) {
  const Catalogue catalogue;
  return draw<2>("ladder", boxes, boxes.size(), catalogue.select(algorithms));
}

TEST(Drawing, TellsBoxesThatOverlapFromOthers) {
  const Drawing drawing =
      draw<2>("three", std::vector<Box2>{{{0, 0}, {2, 2}}, {{1, 1}, {3, 3}}, {{8, 8}, {9, 9}}}, 3, {});
  EXPECT_EQ(std::ranges::count(drawing.views[0].touching, 'M'), 2);
  EXPECT_EQ(std::ranges::count(drawing.views[0].alone, 'M'), 1);
}

TEST(Drawing, LeavesAbsentBoxesOut) {
  std::vector<Box2> boxes = ladder(100);
  boxes[7] = absent_box<2>();
  const Drawing drawing = drawn("grid", boxes);
  EXPECT_EQ(drawing.boxes, 99U);
  EXPECT_EQ(std::ranges::count(drawing.views[0].alone, 'M'), 99);
}

TEST(Drawing, HasALevelOfLinesForEachLevelOfATree) {
  const Drawing drawing = drawn("quadtree:capacity=16,brute_force", ladder(400));
  const std::vector<DrawingLayer>& layers = drawing.views[0].layers;
  ASSERT_EQ(layers.size(), 2U);
  EXPECT_GE(layers[0].levels.size(), 3U);
  EXPECT_EQ(layers[0].algorithm, "quadtree:capacity=16");
  EXPECT_THAT(layers[0].caption, HasSubstr("nodes on"));
  EXPECT_TRUE(layers[1].levels.empty());
}

TEST(Drawing, ShowsASweepHalfWay) {
  const Drawing drawing = drawn("paper_sweep_and_prune,grid", ladder(400));
  const std::vector<DrawingLayer>& layers = drawing.views[0].layers;
  // The line, and the ten boxes of the column that it is at.
  EXPECT_EQ(std::ranges::count(layers[0].active, 'M'), 11);
  EXPECT_EQ(std::ranges::count(layers[0].active, 'z'), 10);
  EXPECT_EQ(layers[1].active, "");
}

TEST(Drawing, ShowsThreeDimensionsFromThreeSides) {
  const std::vector<Box3> boxes = {{{0, 0, 0}, {4, 2, 1}}, {{5, 5, 5}, {6, 6, 6}}};
  const Drawing drawing = draw<3>("two", boxes, 2, Catalogue().select("bvh"));
  ASSERT_EQ(drawing.views.size(), 3U);
  EXPECT_EQ(drawing.views[0].axes, "xy");
  EXPECT_EQ(drawing.views[1].axes, "xz");
  EXPECT_EQ(drawing.views[2].axes, "yz");
}

TEST(Drawing, StaysWithinTheViewWhateverTheBoxes) {
  std::vector<Box2> boxes = ladder(300);
  boxes[3] = {{-infinity, 2}, {infinity, 3}};
  boxes[5] = {{1e30F, 2}, {2e30F, 3}};
  boxes[9] = {{-infinity, -infinity}, {infinity, infinity}};
  const Drawing drawing = drawn("own,paper", boxes);
  for (const DrawingView& view : drawing.views) {
    for (const DrawingLayer& layer : view.layers) {
      for (const std::string& path : layer.levels) {
        EXPECT_THAT(path, Not(HasSubstr("M-"))) << layer.algorithm;
        EXPECT_THAT(path, Not(HasSubstr("nan"))) << layer.algorithm;
        EXPECT_LT(path.size(), 20'000U) << layer.algorithm;
      }
    }
  }
}

TEST(Drawing, OfManyBoxesKeepsTheirDensity) {
  const std::vector<Box2> all = ladder(4000);
  const std::vector<Box2> some = thinned<2>(all, 400).boxes;
  ASSERT_EQ(some.size(), 400U);
  const auto area = [](const std::vector<Box2>& boxes) {
    double sum = 0;
    for (const Box2& box : boxes) sum += (box.max[0] - box.min[0]) * double{box.max[1] - box.min[1]};
    return sum;
  };
  EXPECT_NEAR(area(some), area(all), 1e-3 * area(all));
  EXPECT_EQ(thinned<2>(ladder(10), 10).boxes, ladder(10));
  EXPECT_EQ(thinned<2>(std::vector<Box2>(3, {{-infinity, 0}, {infinity, 1}}), 1).boxes[0].min[0], -infinity);
}

/// The picture of a scene of these boxes, limited to 40.
std::string picture_of_40(const std::vector<Box2>& all) {
  NamedScene named;
  named.spec = Spec("level");
  named.scene.fixed_count = true;
  named.scene.boxes_2d = [&all](const Settings&, std::size_t, std::uint64_t) { return all; };
  return svg_of(draw_scene(named, 2, 0, Catalogue().select("bvh"), 40));
}

TEST(Drawing, OfManyBoxesKeepsTheLargest) {
  std::vector<Box2> all = ladder(4000);
  const Box2 floor = {{0, -1}, {4000, 0}};
  all.insert(all.begin() + 1234, floor);
  const Thinned<2> some = thinned<2>(all, 40);
  EXPECT_EQ(some.boxes.size(), 40U);
  EXPECT_THAT(some.boxes, Contains(floor));
  EXPECT_THAT(picture_of_40(all),
              AllOf(HasSubstr("40 of 4,001 boxes, the largest among them."), HasSubstr("that of these 40.")));
}

TEST(Drawing, OfManyLargestBoxesKeepsAQuarterOfItsOwn) {
  std::vector<Box2> all = ladder(4000);
  for (int i = 0; i < 100; ++i)
    all.push_back({{0, -1 - static_cast<float>(i)}, {4000, -static_cast<float>(i)}});
  const Thinned<2> some = thinned<2>(all, 40);
  EXPECT_EQ(some.boxes.size(), 40U);
  EXPECT_EQ(some.largest, 10U);
  EXPECT_THAT(some.boxes, IsSupersetOf(std::span(all).subspan(4000, 10)));
  EXPECT_THAT(picture_of_40(all), HasSubstr("40 of 4,100 boxes, the 10 largest among them."));
}

TEST(Drawing, OfManyBoxesOfSimilarSizesSaysNothingOfTheLargest) {
  EXPECT_EQ(thinned<2>(ladder(4000), 40).largest, 0U);
  EXPECT_THAT(picture_of_40(ladder(4000)), AllOf(HasSubstr("40 of 4,000 boxes."), Not(HasSubstr("largest"))));
}

TEST(Drawing, OfASceneHasFewerBoxesOfTheSameDensity) {
  const Catalogue catalogue;
  const Drawing drawing =
      draw_scene(find_scene("uniform"), 3, 100'000, catalogue.select("bvh,paper_grid"), 200);
  EXPECT_EQ(drawing.scene, "uniform");
  EXPECT_EQ(drawing.boxes, 200U);
  EXPECT_EQ(drawing.of, 100'000U);
  ASSERT_EQ(drawing.views[0].layers.size(), 1U);  // paper_grid does not support 3D
}

TEST(Drawing, IsJsonOfTheShapeThatTheReportReads) {
  const nlohmann::json json = json_of(drawn("paper_sweep_and_prune", ladder(80)));
  EXPECT_EQ(json["scene"], "ladder");
  EXPECT_EQ(json["dimension"], 2);
  EXPECT_EQ(json["boxes"], 80);
  EXPECT_EQ(json["of"], 80);
  const nlohmann::json& view = json["views"][0];
  EXPECT_EQ(view["axes"], "xy");
  EXPECT_EQ(view["width"], 1000);
  EXPECT_EQ(view["height"], 265);
  const std::string boxes = view["boxes"];
  EXPECT_EQ(std::ranges::count(boxes, 'M'), 80);
  const nlohmann::json& layer = view["layers"][0];
  EXPECT_EQ(layer["algorithm"], "paper_sweep_and_prune");
  EXPECT_EQ(layer["caption"], "one sweep along x");
  EXPECT_EQ(layer["levels"].size(), 2U);  // all of space, and the sweep's line
}

TEST(DrawingSvg, HasATitleADescriptionAndAPanelForEachAlgorithm) {
  Drawing drawing = drawn("grid,paper_sweep_and_prune", ladder(100));
  drawing.scene = "a<b>&\"c\"\n";
  const std::string svg = svg_of(drawing);
  EXPECT_THAT(svg, HasSubstr("role=\"img\""));
  EXPECT_THAT(svg, HasSubstr("<title id=\"title\">Boxes of the scene a&lt;b&gt;&amp;&quot;c&quot;?</title>"));
  EXPECT_THAT(svg, HasSubstr("100 boxes in 2D"));
  EXPECT_THAT(svg, HasSubstr(">grid</text>"));
  EXPECT_THAT(svg, HasSubstr(">paper_sweep_and_prune</text>"));
  EXPECT_THAT(svg, HasSubstr(">one sweep along x</text>"));
  EXPECT_THAT(svg, HasSubstr("Green: a sweep half way."));
}

TEST(DrawingSvg, ShowsBoxesAloneWhereNoAlgorithmIsAsked) {
  const std::string svg = svg_of(draw<2>("ladder", ladder(10), 10, {}));
  EXPECT_THAT(svg, HasSubstr(">ladder</text>"));
  EXPECT_THAT(svg, HasSubstr("<use href=\"#b0\"/>"));
}

}  // namespace
}  // namespace broadside::lab

// Maps: the boxes of their features, pieces and segments, and what is wrong with those that are refused.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lab/formats/format.hpp"
#include "lab/scenes/registry.hpp"
#include "tests/support/files.hpp"
#include "tests/support/message.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class MapTest : public Files {
 protected:
  std::vector<DoubleBox2> boxes_of(const std::string& text, const std::string& part = "") const {
    const BoxFile opened = open_file(put("a.json", text), {.boxes = part});
    return std::get<std::unique_ptr<FrameReader<2, double>>>(opened.frames)->first();
  }

  std::string refusal_of(const std::string& text) const {
    return message_of<FileError>([&] { boxes_of(text); });
  }
};

const DoubleBox2 absent = absent_box<2, double>();

/// A map with one of everything.
const std::string collection =
    R"({"type": "FeatureCollection", "name": "everything", "features": [
  {"type": "Feature", "properties": {"name": "holed", "coordinates": [9]}, "geometry":
    {"type": "Polygon", "coordinates": [[[0, 0], [4, 0], [4, 4], [0, 0]], [[1, 1], [2, 1], [1, 2], [1, 1]]]}},
  {"type": "Feature", "properties": null, "geometry": null},
  {"type": "Feature", "geometry": {"coordinates": [[1, 2, 300], [4, 5, 600]], "type": "MultiPoint"}},
  {"type": "Feature", "geometry": {"type": "MultiPolygon", "coordinates": [
    [[[10, 0], [11, 0], [10, 1], [10, 0]]], [[[20, 0], [21, 0], [20, 1], [20, 0]]]]}},
  {"type": "Feature", "geometry": {"type": "GeometryCollection", "geometries": [
    {"type": "Point", "coordinates": [-7, 8.5]},
    {"type": "LineString", "coordinates": [[0.1, -1e3], [2, 3]]}]}},
  {"type": "Feature", "geometry": {"type": "MultiLineString", "coordinates": [[], [[1, 1]], [[2, 2], [3, 1], [3, 3]]]}}
]})";

TEST_F(MapTest, GivesABoxAFeatureAndAnAbsentOneWhereThereIsNoGeometry) {
  EXPECT_THAT(boxes_of(collection),
              ElementsAre(DoubleBox2{{0, 0}, {4, 4}}, absent, DoubleBox2{{1, 2}, {4, 5}},
                          DoubleBox2{{10, 0}, {21, 1}}, DoubleBox2{{-7, -1000}, {2, 8.5}},
                          DoubleBox2{{1, 1}, {3, 3}}));
  EXPECT_EQ(boxes_of(collection), boxes_of(collection, "features"));
}

TEST_F(MapTest, TakesMultiGeometriesApartIntoPieces) {
  EXPECT_THAT(boxes_of(collection, "pieces"),
              ElementsAre(DoubleBox2{{0, 0}, {4, 4}}, DoubleBox2{{1, 2}, {1, 2}}, DoubleBox2{{4, 5}, {4, 5}},
                          DoubleBox2{{10, 0}, {11, 1}}, DoubleBox2{{20, 0}, {21, 1}},
                          DoubleBox2{{-7, 8.5}, {-7, 8.5}}, DoubleBox2{{0.1, -1000}, {2, 3}},
                          DoubleBox2{{1, 1}, {1, 1}}, DoubleBox2{{2, 1}, {3, 3}}));
}

TEST_F(MapTest, GivesABoxASegmentOfLinesAndRings) {
  EXPECT_THAT(
      boxes_of(collection, "segments"),
      ElementsAre(DoubleBox2{{0, 0}, {4, 0}}, DoubleBox2{{4, 0}, {4, 4}}, DoubleBox2{{0, 0}, {4, 4}},
                  DoubleBox2{{1, 1}, {2, 1}}, DoubleBox2{{1, 1}, {2, 2}}, DoubleBox2{{1, 1}, {1, 2}},
                  DoubleBox2{{10, 0}, {11, 0}}, DoubleBox2{{10, 0}, {11, 1}}, DoubleBox2{{10, 0}, {10, 1}},
                  DoubleBox2{{20, 0}, {21, 0}}, DoubleBox2{{20, 0}, {21, 1}}, DoubleBox2{{20, 0}, {20, 1}},
                  DoubleBox2{{0.1, -1000}, {2, 3}}, DoubleBox2{{2, 1}, {3, 2}}, DoubleBox2{{3, 1}, {3, 3}}));
}

TEST_F(MapTest, ReadsAFeatureOrAGeometryByItself) {
  EXPECT_THAT(boxes_of(R"({"type":"Feature","geometry":{"type":"Point","coordinates":[1,2]}})"),
              ElementsAre(DoubleBox2{{1, 2}, {1, 2}}));
  EXPECT_THAT(boxes_of(R"({"coordinates":[[1,2],[0,5]],"type":"LineString"})"),
              ElementsAre(DoubleBox2{{0, 2}, {1, 5}}));
  EXPECT_THAT(boxes_of(R"({"type":"GeometryCollection","geometries":[
                {"type":"Point","coordinates":[1,2]},{"type":"Point","coordinates":[]}]})"),
              ElementsAre(DoubleBox2{{1, 2}, {1, 2}}, absent));
  EXPECT_THAT(boxes_of(R"({"type":"FeatureCollection","features":[]})"), IsEmpty());
}

TEST_F(MapTest, ReadsAValueALine) {
  const std::string feature = R"({"type":"Feature","geometry":{"type":"Point","coordinates":[1,2]}})";
  const DoubleBox2 box{{1, 2}, {1, 2}};
  EXPECT_THAT(boxes_of(feature + "\n" + feature + "\r\n\n" + feature), ElementsAre(box, box, box));
  EXPECT_THAT(boxes_of("\x1e" + feature + "\n\x1e" + feature + "\n"), ElementsAre(box, box));
  EXPECT_THAT(refusal_of(feature + "\n" + feature + "\n{\"type\":\"Feature\"}\n"),
              HasSubstr("a.json: feature 2: an object without 'geometry'"));
  EXPECT_THAT(refusal_of(feature + "\n" + feature + "\n\n{\"type\"}\n"),
              AllOf(HasSubstr("a.json:4: parse error at line 1, column 8"), HasSubstr("expected JSON")));
}

TEST_F(MapTest, ReadsEveryDoubleExactly) {
  const auto boxes = boxes_of(R"({"type":"MultiPoint","coordinates":[
      [500000.001, 5000000.0009999997], [9007199254740993, 1.7976931348623157e308], [-0.1, 5e-324], [-0, 0]]})",
                              "pieces");
  ASSERT_EQ(boxes.size(), 4u);
  EXPECT_TRUE(std::signbit(boxes[3].min[0]) && !std::signbit(boxes[3].min[1]));
  EXPECT_EQ(boxes[0].min, (std::array{500000.001, 5000000.0009999997}));
  EXPECT_EQ(boxes[1].min, (std::array{9007199254740992.0, std::numeric_limits<double>::max()}));
  EXPECT_EQ(boxes[2].min, (std::array{-0.1, std::numeric_limits<double>::denorm_min()}));
}

TEST_F(MapTest, ReadsTheBoxesOfCocosImagesAsFrames) {
  const std::string text = R"({"info": {}, "images": [{"id": 7}, {"id": 3}], "annotations": [
      {"id": 1, "image_id": 7, "bbox": [0, 0, 10, 10], "segmentation": [[0, 0, 1, 1]]},
      {"id": 2, "image_id": 3, "bbox": [1, 2, 3, 4]},
      {"bbox": [12, 12, 6, 4], "image_id": 7, "id": 5},
      {"id": 6, "image_id": 3}]})";
  EXPECT_EQ(boxes_of(text), (std::vector<DoubleBox2>{{{0, 0}, {10, 10}}, {{12, 12}, {18, 16}}}));
  const BoxFile file = open_file(put("coco.json", text), {.ids = "id"});
  auto& frames = *std::get<std::unique_ptr<FrameReader<2, double>>>(file.frames);
  std::vector<DoubleBox2> boxes = frames.first();
  EXPECT_EQ(frames.labels()->ids, (std::vector<std::string>{"1", "5"}));
  Step<2, double> step{};
  ASSERT_TRUE(frames.next(step));
  broadside::apply(step, boxes);
  EXPECT_EQ(boxes, (std::vector<DoubleBox2>{{{1, 2}, {4, 6}}, absent}));
  EXPECT_EQ(frames.labels()->ids, (std::vector<std::string>{"2", "6"}));
  EXPECT_FALSE(frames.next(step));
  EXPECT_TRUE(frames.is_computed());
  EXPECT_THAT(frames.warning(), HasSubstr("a frame for each of 2 images, from --frame 0, image '7'"));
  EXPECT_THAT(
      refusal_of(R"({"annotations": [{"bbox": [1, 2, 3, -4]}]})"),
      AllOf(HasSubstr("feature 0: a bbox of 4 numbers (1, 2, 3, -4)"), HasSubstr("height of 0 or more")));
  EXPECT_THAT(message_of<FileError>([&] { boxes_of(text, "pieces"); }),
              HasSubstr("expected no --boxes other than features"));
  EXPECT_TRUE(boxes_of(R"({"annotations": []})").empty());
}

TEST_F(MapTest, ReadsTheShapesOfLabelMeWhateverCornerComesFirst) {
  EXPECT_EQ(boxes_of(R"({"version": "5", "flags": {}, "shapes": [
      {"label": "a", "points": [[5, 1.5], [2, 8]], "shape_type": "rectangle"},
      {"label": "b", "points": [[0, 0], [4, 1], [2, 3]], "shape_type": "polygon"}], "imagePath": "a.png"})"),
            (std::vector<DoubleBox2>{{{2, 1.5}, {5, 8}}, {{0, 0}, {4, 3}}}));
  EXPECT_THAT(refusal_of(R"({"shapes": [{"points": [[5, 1], [2, 8]], "shape_type": "circle"}]})"),
              HasSubstr("feature 0: a circle; expected rectangles"));
  EXPECT_THAT(refusal_of(R"({"shapes": [{"points": [[5]]}]})"), HasSubstr("a position of 1 number"));
}

TEST_F(MapTest, IsRecognisedByContentOrName) {
  const std::string point = R"({"type":"Point","coordinates":[1,2]})";
  for (const std::string name : {"map", "map.txt", "map.geojson", "map.JSON"})
    EXPECT_EQ(open_file(put(name, point)).format->name, "map") << name;
  EXPECT_EQ(open_file(put("bom.txt", "\xEF\xBB\xBF" + point)).format->name, "map");
  EXPECT_THAT(refusal(put("other.json", R"({"schema": "broadside.results/1"})")),
              AllOf(HasSubstr("other.json"), HasSubstr("an object without 'type'")));
}

TEST_F(MapTest, RefusesWhatIsWrongNamingTheFeatureOrThePlace) {
  const auto point = [&](const std::string& coordinates) {
    return refusal_of(R"({"type":"FeatureCollection","features":[{"type":"Feature","geometry":null},
{"type":"Feature","geometry":{"type":"Point","coordinates":)" +
                      coordinates + "}}]}");
  };
  EXPECT_THAT(point("[1,\"two\"]"), HasSubstr("a.json: feature 1: 'two'; expected a number"));
  EXPECT_THAT(point("[1,null]"), HasSubstr("feature 1: null; expected a number"));
  EXPECT_THAT(point("[1e999,2]"),
              HasSubstr("a.json: number overflow parsing '1e999'; expected a number that a double can hold"));
  EXPECT_THAT(point("[NaN,2]"), HasSubstr("a.json: parse error at line 2, column 61"));
  EXPECT_THAT(point("[[1,2]]"), HasSubstr("an array; expected a number"));
  EXPECT_THAT(point("[1]"), HasSubstr("a position of 1 number; expected at least 2"));
  EXPECT_THAT(point("{}"), HasSubstr("an object; expected a position"));
  EXPECT_THAT(point("null"), HasSubstr("null; expected a position"));
  EXPECT_THAT(point("[1,2"), HasSubstr("unexpected '}'; expected ']'"));
  EXPECT_THAT(refusal_of(R"({"type":"Point","coordinates":[1,2])"),
              HasSubstr("a.json: parse error at line 1, column 36"));
  EXPECT_THAT(refusal_of(R"({"type":"LineString","coordinates":[[],[1,2]]})"), HasSubstr("of no numbers"));
  EXPECT_THAT(refusal_of(R"({"type":"LineString","coordinates":[1,2]})"), HasSubstr("the number 1"));
  EXPECT_THAT(refusal_of(R"({"type":"Circle","coordinates":[1,2]})"),
              AllOf(HasSubstr("'Circle'"), HasSubstr("Point, MultiPoint")));
  EXPECT_THAT(refusal_of(R"({"type":7})"), AllOf(HasSubstr("'7'"), HasSubstr("the type of a map")));
  EXPECT_THAT(refusal_of("[1,2,3]"), HasSubstr("an array; expected an object of GeoJSON, COCO or LabelMe"));
  EXPECT_THAT(refusal_of(R"({"type":"Point","coordinates":[1,2]} {})"), HasSubstr("expected end of input"));
  EXPECT_THAT(refusal_of("{\"type\":\"Point\xff\",\"coordinates\":[1,2]}"), HasSubstr("UTF-8"));
  EXPECT_THAT(refusal_of(""), HasSubstr("a.json: parse error at line 1, column 1"));
  EXPECT_THAT(refusal_of(R"({"arcs":[],"objects":{},"type":"Topology"})"),
              AllOf(HasSubstr("a.json: is TopoJSON"), HasSubstr("topo2geo LAYER=out.geojson < ")));
}

TEST_F(MapTest, KeepsIdsAsTheyAreWritten) {
  const auto ids_of = [this](const std::string& text, const std::string& name) {
    const BoxFile file = open_file(put("ids.json", text), {.ids = name});
    const auto& frames = std::get<std::unique_ptr<FrameReader<2, double>>>(file.frames);
    frames->first();
    return frames->labels()->ids;
  };
  const auto feature = [](const std::string& id) {
    return R"({"type":"Feature","id":)" + id + R"(,"geometry":null,"properties":{"id":"p","n":)" + id + "}}";
  };
  for (const std::string id : {"12345678901234567890123", "1.50", "-7", "\"a\""}) {
    const std::string plain = id == "\"a\"" ? "a" : id;
    for (const std::string name : {"id", "n", "properties.n"})
      EXPECT_THAT(ids_of(feature(id), name), ElementsAre(plain)) << name;
    EXPECT_THAT(ids_of(feature(id), "properties.id"), ElementsAre("p"));
  }
  EXPECT_THAT(message_of<FileError>([&] { ids_of(feature("1"), "x"); }),
              HasSubstr("no feature has a property 'x'"));
}

TEST_F(MapTest, TakesOnlyTheListOfItsType) {
  const std::string rest =
      R"("annotations":[{"bbox":[0,0,1,1]}],"features":[{"type":"Feature","geometry":null}]})";
  EXPECT_THAT(boxes_of(R"({"type":"FeatureCollection",)" + rest), ElementsAre(absent));
  EXPECT_THAT(refusal_of("{" + rest), HasSubstr("'features' beside 'annotations'"));
}

TEST_F(MapTest, RefusesWhatIsCutOffAnywhere) {
  for (std::size_t length = 0; length < collection.size(); length += 23)
    EXPECT_THAT(refusal_of(collection.substr(0, length)), HasSubstr("a.json")) << "cut off at " << length;
}

TEST_F(MapTest, RefusesNestingThatWouldTakeTheStack) {
  const auto nested = [](int depth) {
    std::string text;
    for (int i = 0; i < depth; ++i) text += R"({"type":"GeometryCollection","geometries":[)";
    text += R"({"type":"Point","coordinates":[1,2]})";
    for (int i = 0; i < depth; ++i) text += "]}";
    return text;
  };
  EXPECT_EQ(boxes_of(nested(32)).size(), 1u);
  EXPECT_THAT(refusal_of(nested(33)), HasSubstr("nested more than 32 deep"));
  EXPECT_THAT(refusal_of(nested(100'000)), HasSubstr("nested more than 32 deep"));
  EXPECT_THAT(refusal_of(R"({"type":"Polygon","coordinates":)" + std::string(100'000, '[')),
              HasSubstr("a.json"));
}

TEST_F(MapTest, MakesScenesOfTheMapsThatWereFetched) {
  setenv("BROADSIDE_DATA", path("").c_str(), 1);
  EXPECT_THAT(generated::counties().missing,
              AllOf(HasSubstr("counties.geojson"), HasSubstr("tools/setup/setup")));
  for (const std::string name : {"counties", "land"}) put(name + ".geojson", collection);
  EXPECT_THAT(generated::counties().missing, HasSubstr("county_borders.geojson"));
  for (const std::string name : {"county_borders", "coastlines"})
    put(name + ".geojson", R"({"type":"MultiLineString","coordinates":[[[0,0],[1,0],[1,1]],[[5,5],[6,6]]]})");
  const Scene counties = generated::counties();
  const Scene coastlines = generated::coastlines();
  unsetenv("BROADSIDE_DATA");
  const auto count = [](const Scene& scene, const std::string& spec) {
    return make_history<2>(scene, Spec(spec), {}).boxes.size();
  };
  EXPECT_EQ(count(counties, "counties"), 6u);
  EXPECT_EQ(count(counties, "counties:boxes=segments"), 3u);
  EXPECT_EQ(count(coastlines, "coastlines"), 9u) << "a box an island, though all are one feature";
  EXPECT_EQ(count(coastlines, "coastlines:boxes=segments"), 3u);
  EXPECT_FALSE(counties.has_dimension(3));
}

}  // namespace
}  // namespace broadside::lab

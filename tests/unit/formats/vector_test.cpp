// Vector data through GDAL: files that GDAL writes here, box by box against what went in.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <gdal.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_api.h>

#include "broadside/box.hpp"

#include "lab/formats/format.hpp"
#include "tests/support/files.hpp"

namespace broadside::lab {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// What stands for a NaN in well-known text, which has no word for it that every GDAL reads.
constexpr double stands_for_nan = -9999;

/// A feature to write: well-known text, or none; and a name, or none.
struct Written {
  std::string geometry;
  std::optional<std::string> name = "somebody";
};

struct Layer {
  std::string name;
  std::vector<Written> features;
};

class VectorData : public Files {
 protected:
  /// Writes a file by the GDAL driver of that name.
  std::filesystem::path write(const char* driver, const std::string& file, const std::vector<Layer>& layers,
                              OGRwkbGeometryType type = wkbUnknown) const {
    GDALAllRegister();
    GDALDriverH const found = GDALGetDriverByName(driver);
    EXPECT_NE(found, nullptr) << driver;
    GDALDatasetH const dataset =
        GDALCreate(found, path(file).string().c_str(), 0, 0, 0, GDT_Unknown, nullptr);
    EXPECT_NE(dataset, nullptr) << file;
    for (const Layer& layer : layers) add(dataset, layer, type);
    GDALClose(dataset);
    return path(file);
  }

  static std::vector<DoubleBox2> boxes_of(const std::filesystem::path& file,
                                          const ReadOptions& options = {}) {
    BoxFile opened = open_file(file, options);
    EXPECT_EQ(opened.format->name, "vector");
    return std::get<std::unique_ptr<FrameReader<2, double>>>(opened.frames)->first();
  }

 private:
  static void add(GDALDatasetH dataset, const Layer& layer, OGRwkbGeometryType type) {
    OGRLayerH const made = GDALDatasetCreateLayer(dataset, layer.name.c_str(), nullptr, type, nullptr);
    ASSERT_NE(made, nullptr) << layer.name;
    OGRFieldDefnH const field = OGR_Fld_Create("name", OFTString);
    OGR_L_CreateField(made, field, 1);
    OGR_Fld_Destroy(field);
    for (const Written& written : layer.features) {
      OGRFeatureH const feature = OGR_F_Create(OGR_L_GetLayerDefn(made));
      if (written.name) OGR_F_SetFieldString(feature, 0, written.name->c_str());
      if (!written.geometry.empty()) {
        std::vector<char> text(written.geometry.begin(), written.geometry.end());
        text.push_back('\0');
        char* rest = text.data();
        OGRGeometryH geometry = nullptr;
        ASSERT_EQ(OGR_G_CreateFromWkt(&rest, nullptr, &geometry), OGRERR_NONE) << written.geometry;
        for (int i = 0; i < OGR_G_GetPointCount(geometry); ++i) {
          if (OGR_G_GetX(geometry, i) == stands_for_nan)
            OGR_G_SetPoint_2D(geometry, i, std::nan(""), OGR_G_GetY(geometry, i));
        }
        OGR_F_SetGeometryDirectly(feature, geometry);
      }
      EXPECT_EQ(OGR_L_CreateFeature(made, feature), OGRERR_NONE);
      OGR_F_Destroy(feature);
    }
  }
};

const DoubleBox2 nothing = absent_box<2, double>();

TEST_F(VectorData, AreABoxAFeatureInTheOrderOfTheFile) {
  const auto file = write("GPKG", "a.gpkg",
                          {{"places",
                            {{"POINT (0.1 0.2)"},
                             {"LINESTRING (3 1, 1 4)"},
                             {"POLYGON ((0 0, 5 0, 5 6, 0 6, 0 0), (1 1, 2 1, 2 2, 1 1))"},
                             {"MULTIPOINT (7 7, -1e300 8)"},
                             {"GEOMETRYCOLLECTION (POINT (1 1), LINESTRING (2 2, 9 0))"},
                             {"POINT Z (1 2 30)"}}}});
  EXPECT_THAT(boxes_of(file), ElementsAre(DoubleBox2{{0.1, 0.2}, {0.1, 0.2}}, DoubleBox2{{1, 1}, {3, 4}},
                                          DoubleBox2{{0, 0}, {5, 6}}, DoubleBox2{{-1e300, 7}, {7, 8}},
                                          DoubleBox2{{1, 0}, {9, 2}}, DoubleBox2{{1, 2}, {1, 2}}));
}

TEST_F(VectorData, AreAbsentBoxesWhereAFeatureHasNoGeometryOrAnEmptyOne) {
  const auto file =
      write("GPKG", "a.gpkg",
            {{"places", {{"POINT (1 1)"}, {""}, {"POLYGON EMPTY"}, {"POINT EMPTY"}, {"POINT (2 2)"}}}});
  EXPECT_THAT(boxes_of(file),
              ElementsAre(DoubleBox2{{1, 1}, {1, 1}}, nothing, nothing, nothing, DoubleBox2{{2, 2}, {2, 2}}));
}

TEST_F(VectorData, AreReadFromShapefilesAndFlatGeobufAndByTheirContent) {
  const std::vector<Layer> layers = {{"lines", {{"LINESTRING (0 0, 1 2)"}, {"LINESTRING (5 5, 4 6)"}}}};
  const auto expected = ElementsAre(DoubleBox2{{0, 0}, {1, 2}}, DoubleBox2{{4, 5}, {5, 6}});
  const auto shapefile = write("ESRI Shapefile", "lines.shp", layers, wkbLineString);
  EXPECT_THAT(boxes_of(shapefile), expected);
  const auto flat = write("FlatGeobuf", "lines.fgb", layers, wkbLineString);
  EXPECT_THAT(boxes_of(flat),
              testing::UnorderedElementsAre(DoubleBox2{{0, 0}, {1, 2}}, DoubleBox2{{4, 5}, {5, 6}}));
  const auto package = write("GPKG", "lines.gpkg", layers);
  std::filesystem::rename(package, path("lines"));
  EXPECT_THAT(boxes_of(path("lines")), expected);
}

TEST_F(VectorData, OfSeveralLayersTakeTheOneThatIsNamed) {
  const auto file =
      write("GPKG", "a.gpkg", {{"roads", {{"POINT (1 1)"}}}, {"rivers", {{"POINT (2 2)"}, {"POINT (3 3)"}}}});
  EXPECT_THAT(refusal(file),
              AllOf(HasSubstr("has 2 layers"), HasSubstr("--layer"), HasSubstr("roads, rivers")));
  EXPECT_EQ(boxes_of(file, {.layer = "roads"}).size(), 1);
  EXPECT_EQ(boxes_of(file, {.layer = "rivers"}).size(), 2);
  EXPECT_THAT(refusal(file, {.layer = "river"}),
              AllOf(HasSubstr("no layer 'river'"), HasSubstr("did you mean"), HasSubstr("roads, rivers")));
}

TEST_F(VectorData, HaveIdsOfAFieldOrTheirOwn) {
  const auto file = write("GPKG", "a.gpkg", {{"places", {{"POINT (1 1)", "Ulm"}, {"POINT (2 2)", "Köln"}}}});
  const auto ids = [](const std::filesystem::path& of, const std::string& field) {
    const BoxFile opened = open_file(of, {.ids = field});
    return std::get<std::unique_ptr<FrameReader<2, double>>>(opened.frames)->labels()->ids;
  };
  EXPECT_THAT(ids(file, "name"), ElementsAre("Ulm", "Köln"));
  EXPECT_THAT(ids(file, "fid"), ElementsAre("1", "2"));
  EXPECT_THAT(refusal(file, {.ids = "title"}),
              AllOf(HasSubstr("layer 'places' has no field 'title'"), HasSubstr("fid or one of: name")));
  const auto unnamed =
      write("GPKG", "b.gpkg", {{"places", {{"POINT (1 1)", "Ulm"}, {"POINT (2 2)", std::nullopt}}}});
  EXPECT_THAT(ids(unnamed, "name"), ElementsAre("Ulm", ""));
}

TEST_F(VectorData, WithANanAreRefusedByLayerAndFeatureOrLeftOut) {
  // Where GDAL takes bounds, the NaN behind the first point is passed over.
  const auto file =
      write("GPKG", "a.gpkg", {{"lines", {{"POINT (1 1)"}, {"LINESTRING (0 0, -9999 1, 2 2)"}}}});
  EXPECT_THAT(refusal(file),
              AllOf(HasSubstr("a.gpkg: layer 'lines', feature 1 (counted from 0): a coordinate is NaN"),
                    HasSubstr("expected a number")));
  std::vector<std::string> said;
  const ReadOptions skipping{.say_invalid = [&](std::string_view why) { said.emplace_back(why); }};
  EXPECT_THAT(boxes_of(file, skipping), ElementsAre(DoubleBox2{{1, 1}, {1, 1}}, nothing));
  EXPECT_THAT(said, ElementsAre(HasSubstr("feature 1")));
}

TEST_F(VectorData, ThatAreCutOffAreRefused) {
  std::vector<Written> features;
  for (int i = 0; i < 1000; ++i) features.push_back({"LINESTRING (0 0, " + std::to_string(i) + " 1)"});
  const auto file = write("ESRI Shapefile", "lines.shp", {{"lines", features}}, wkbLineString);
  std::filesystem::resize_file(file, std::filesystem::file_size(file) / 2);
  EXPECT_THAT(refusal(file), HasSubstr("lines.shp: layer 'lines', feature 4"));
}

TEST_F(VectorData, WithoutGeometriesOrAFileAreRefused) {
  const auto table = write("GPKG", "table.gpkg", {{"names", {{""}}}}, wkbNone);
  EXPECT_THAT(refusal(table), HasSubstr("has no layer with geometries"));
  const std::string bytes = text_of("table.gpkg");
  Input memory("memory", bytes);
  const auto vector = std::ranges::find(formats(), "vector", &Format::name);
  EXPECT_THROW(vector->open(Input::keeping("memory", bytes), {}), FileError);
}

}  // namespace
}  // namespace broadside::lab

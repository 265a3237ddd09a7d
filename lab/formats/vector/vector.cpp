// Vector data of geographic information systems, through GDAL: a box a feature, of one layer.
#include <cmath>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "broadside/box.hpp"
#include "broadside/error.hpp"

#include "lab/formats/descriptions.hpp"
#include "lab/formats/quarantine.hpp"
#include "lab/formats/text.hpp"
#include "lab/formats/vector/gdal.hpp"
#include "src/core/suggestion.hpp"

namespace broadside::lab::readers {
namespace {

/// Keeps GDAL from printing what it finds wrong, in this thread.
class QuietErrors {
 public:
  QuietErrors() { gdal().CPLPushErrorHandler(gdal().CPLQuietErrorHandler); }
  ~QuietErrors() { gdal().CPLPopErrorHandler(); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;
};

template <auto Gdal::*Function>
struct Free {
  template <typename Thing>
  void operator()(Thing* thing) const {
    (gdal().*Function)(thing);
  }
};
using Dataset = std::unique_ptr<std::remove_pointer_t<GDALDatasetH>, Free<&Gdal::GDALClose>>;
using Feature = std::unique_ptr<std::remove_pointer_t<OGRFeatureH>, Free<&Gdal::OGR_F_Destroy>>;

/// What GDAL found wrong since CPLErrorReset() was called last; empty if nothing.
std::string fault() {
  if (gdal().CPLGetLastErrorType() < CE_Failure) return {};
  const std::string_view text = gdal().CPLGetLastErrorMsg();
  return text.empty() ? "GDAL does not say why" : plainly(text);
}

/// Opens a file with any driver where the user has named the format. Otherwise with those of the formats that
/// are recognised, since others would follow what the file says to other files, or to servers.
Dataset opened(const Input& input, bool is_named) {
  static std::once_flag once;
  std::call_once(once, gdal().GDALAllRegister);
  constexpr const char* recognised[] = {"GPKG", "SQLite", "ESRI Shapefile", "FlatGeobuf", "LIBKML", "KML",
                                        "GML",  "GPX",    "MapInfo File",   nullptr};
  if (input.path().empty())
    throw FileError(
        fmt::format("{}: cannot be opened by its name, as GDAL does; expected a file that is not compressed",
                    input.name()));
  gdal().CPLErrorReset();
  Dataset dataset(gdal().GDALOpenEx(input.path().string().c_str(),
                                    GDAL_OF_VECTOR | GDAL_OF_READONLY | GDAL_OF_VERBOSE_ERROR,
                                    is_named ? nullptr : recognised, nullptr, nullptr));
  if (dataset == nullptr)
    throw FileError(fmt::format("{}: cannot be read by GDAL: {}", input.name(), fault()));
  return dataset;
}

/// The layer of that name or, where it is empty, the only one that has geometries.
OGRLayerH chosen_layer(GDALDatasetH dataset, const std::string& name, const std::string& file) {
  std::vector<std::string> names;
  OGRLayerH only = nullptr;
  for (int i = 0; i < gdal().GDALDatasetGetLayerCount(dataset); ++i) {
    const OGRLayerH layer = gdal().GDALDatasetGetLayer(dataset, i);
    if (layer == nullptr || gdal().OGR_FD_GetGeomFieldCount(gdal().OGR_L_GetLayerDefn(layer)) == 0) continue;
    names.emplace_back(gdal().OGR_L_GetName(layer));
    if (names.back() == name) return layer;
    only = layer;
  }
  if (names.empty())
    throw FileError(fmt::format("{}: has no layer with geometries; expected features with bounds", file));
  if (!name.empty())
    throw FileError(fmt::format("{}: has no layer '{}'{}; expected one of: {}", file, name,
                                core::did_you_mean(name, names), fmt::join(names, ", ")));
  if (names.size() > 1)
    throw FileError(fmt::format("{}: has {} layers; expected --layer with one of: {}", file, names.size(),
                                fmt::join(names, ", ")));
  return only;
}

/// Whether a coordinate of a geometry is no number. GDAL's bounds pass over most of them.
bool has_nan(OGRGeometryH geometry) {
  for (int i = 0; i < gdal().OGR_G_GetGeometryCount(geometry); ++i) {
    if (has_nan(gdal().OGR_G_GetGeometryRef(geometry, i))) return true;
  }
  if (gdal().OGR_G_GetGeometryCount(geometry) > 0 || gdal().OGR_G_IsEmpty(geometry)) return false;
  for (int i = 0; i < gdal().OGR_G_GetPointCount(geometry); ++i) {
    if (std::isnan(gdal().OGR_G_GetX(geometry, i)) || std::isnan(gdal().OGR_G_GetY(geometry, i))) return true;
  }
  return false;
}

/// Reads the features of a layer, in its order.
class LayerReader {
 public:
  LayerReader(OGRLayerH layer, const ReadOptions& options, const std::string& file)
      : layer_(layer),
        definition_(gdal().OGR_L_GetLayerDefn(layer)),
        options_(options),
        quarantine_(options),
        file_(file),
        id_field_(options.ids.empty() ? -1 : gdal().OGR_FD_GetFieldIndex(definition_, options.ids.c_str())) {
    if (!options.ids.empty() && id_field_ < 0 && options.ids != "fid")
      throw FileError(fmt::format("{}: layer '{}' has no field '{}'; expected fid or one of: {}", file_,
                                  gdal().OGR_L_GetName(layer_), options.ids, fmt::join(fields(), ", ")));
  }

  AnyFrameReader read() {
    History<2, double> boxes;
    auto labels = std::make_shared<BoxLabels>();
    labels->has_ids = !options_.ids.empty();
    const auto total = static_cast<std::int64_t>(gdal().OGR_L_GetFeatureCount(layer_, 0));
    gdal().OGR_L_ResetReading(layer_);
    while (true) {
      gdal().CPLErrorReset();
      const Feature feature(gdal().OGR_L_GetNextFeature(layer_));
      number_ = boxes.boxes.size();
      if (feature == nullptr && fault().empty()) break;
      // Behind a fault in the file there may be no end.
      if (feature == nullptr) refuse(fault(), "a feature");
      DoubleBox2 box = absent_box<2, double>();
      std::string id;
      quarantine_.holds([&] {
        if (labels->has_ids) id = id_of(feature.get());
        box = box_of(feature.get());
      });
      boxes.boxes.push_back(box);
      if (labels->has_ids) labels->ids.push_back(std::move(id));
      constexpr std::size_t features_a_report = 4096;
      if (options_.progress && total > 0 && boxes.boxes.size() % features_a_report == 0)
        options_.progress(boxes.boxes.size(), static_cast<std::uint64_t>(total));
    }
    return std::make_unique<HistoryReader<2, double>>(std::move(boxes), std::move(labels),
                                                      quarantine_.warning(file_));
  }

 private:
  [[noreturn]] void refuse(std::string_view found, std::string_view expected) const {
    throw FileError(fmt::format("{}: layer '{}', feature {} (counted from 0): {}; expected {}", file_,
                                gdal().OGR_L_GetName(layer_), number_, found, expected));
  }

  std::vector<std::string> fields() const {
    std::vector<std::string> names;
    for (int i = 0; i < gdal().OGR_FD_GetFieldCount(definition_); ++i)
      names.emplace_back(gdal().OGR_Fld_GetNameRef(gdal().OGR_FD_GetFieldDefn(definition_, i)));
    return names;
  }

  std::string id_of(OGRFeatureH feature) const {
    if (id_field_ < 0) return fmt::format("{}", static_cast<std::int64_t>(gdal().OGR_F_GetFID(feature)));
    if (!gdal().OGR_F_IsFieldSetAndNotNull(feature, id_field_)) return {};
    return gdal().OGR_F_GetFieldAsString(feature, id_field_);
  }

  DoubleBox2 box_of(OGRFeatureH feature) const {
    if (const std::string found = fault(); !found.empty()) refuse(found, "a feature that can be read");
    const OGRGeometryH geometry = gdal().OGR_F_GetGeometryRef(feature);
    if (geometry == nullptr || gdal().OGR_G_IsEmpty(geometry)) return absent_box<2, double>();
    if (has_nan(geometry)) refuse("a coordinate is NaN", "a number");
    OGREnvelope bounds;
    gdal().OGR_G_GetEnvelope(geometry, &bounds);
    return {{bounds.MinX, bounds.MinY}, {bounds.MaxX, bounds.MaxY}};
  }

  OGRLayerH layer_;
  OGRFeatureDefnH definition_;
  const ReadOptions& options_;
  Quarantine quarantine_;
  const std::string& file_;
  int id_field_;
  std::size_t number_ = 0;  // of the feature that is being read
};

AnyFrameReader open_vector(std::unique_ptr<Input> input, const ReadOptions& options) {
  const QuietErrors quiet;
  const Dataset dataset = opened(*input, !options.format.empty());
  const OGRLayerH layer = chosen_layer(dataset.get(), options.layer, input->name());
  return LayerReader(layer, options, input->name()).read();
}

}  // namespace

Format vector() {
  Format format = vector_description();
  format.open = open_vector;
  return format;
}

}  // namespace broadside::lab::readers

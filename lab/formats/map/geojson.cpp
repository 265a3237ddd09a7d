// GeoJSON, RFC 7946. Positions are taken as they stand, the first two numbers of each; "bbox" is not read.
#include <string>

#include <fmt/format.h>

#include "lab/formats/map/boxes.hpp"
#include "lab/formats/map/text.hpp"

namespace broadside::lab {
namespace {

class GeoJson {
 public:
  GeoJson(MapText& text, MapIds& ids, Quarantine& quarantine, MapBoxes& boxes)
      : text_(text), ids_(ids), quarantine_(quarantine), boxes_(boxes) {}

  void read(std::string_view type) {
    json::object root = text_.root();
    if (type == "FeatureCollection") {
      for (auto result : text_.array(text_.field(root, "features"), "an array of features"))
        read_whole([&] { read_feature(text_.object(text_.element(result), "a feature")); });
    } else if (type == "Feature") {
      read_whole([&] { read_feature(root); });
    } else if (type == "GeometryCollection") {
      ids_.refuse(text_, "geometries");
      for (auto result : text_.array(text_.field(root, "geometries"), "an array of geometries")) {
        read_whole([&] {
          read_geometry(text_.object(text_.element(result), "a geometry"), 1);
          boxes_.end_feature();
        });
      }
    } else {
      ids_.refuse(text_, "a geometry");
      read_whole([&] {
        read_geometry(root, 0);
        boxes_.end_feature();
      });
    }
    text_.end_features();
  }

 private:
  /// Reads what is a feature, or leaves it out.
  template <typename Read>
  void read_whole(const Read& read) {
    text_.begin_feature();
    boxes_.begin_feature();
    if (!quarantine_.holds(read)) boxes_.drop_feature();
  }

  void read_feature(json::object feature) {
    boxes_.set_id(ids_.of(text_, feature));
    json::value geometry = text_.field(feature, "geometry");
    if (!text_.is_null(geometry)) read_geometry(text_.object(geometry, "a geometry, or null"), 0);
    boxes_.end_feature();
  }

  void read_geometry(json::object geometry, int nested) {
    const std::string_view type = text_.string(text_.field(geometry, "type"), geometry_types);
    if (type == "GeometryCollection") {
      if (nested == most_nested_collections)
        text_.refuse(fmt::format("collections nested more than {} deep", nested), "fewer");
      for (auto result : text_.array(text_.field(geometry, "geometries"), "an array of geometries"))
        read_geometry(text_.object(text_.element(result), "a geometry"), nested + 1);
      return;
    }
    const GeometryKind* const kind = GeometryKind::find(type);
    if (kind == nullptr) text_.refuse(fmt::format("a geometry of type '{}'", type), geometry_types);
    read_coordinates(text_.field(geometry, "coordinates"), *kind, kind->depth);
  }

  void read_coordinates(json::value value, const GeometryKind& kind, int depth) {
    if (depth == 0) {
      read_position(value, true);
    } else if (depth == 1 && kind.has_lines) {
      boxes_.begin_line();
      for (auto result : text_.array(value, "an array of positions"))
        read_position(text_.element(result), false);
    } else {
      for (auto result : text_.array(value, "an array"))
        read_coordinates(text_.element(result), kind, depth - 1);
    }
    if (depth == kind.piece_depth) boxes_.end_piece();
  }

  void read_position(json::value value, bool is_alone) {
    double place[2] = {};
    int count = 0;
    for (auto result : text_.array(value, "a position: an array of numbers")) {
      json::value number = text_.element(result);
      // What follows is an altitude, or somebody's own.
      if (count < 2) place[count] = text_.number(number);
      ++count;
    }
    // Some programs write an empty point so.
    if (count == 0 && is_alone) return;
    if (count < 2)
      text_.refuse(fmt::format("a position of {}", count == 0 ? "no numbers" : "1 number"),
                   "at least 2 numbers");
    boxes_.add(place[0], place[1], is_alone);
  }

  MapText& text_;
  MapIds& ids_;
  Quarantine& quarantine_;
  MapBoxes& boxes_;
};

}  // namespace

void read_geojson(MapText& text, std::string_view type, MapIds& ids, Quarantine& quarantine,
                  MapBoxes& boxes) {
  GeoJson(text, ids, quarantine, boxes).read(type);
}

}  // namespace broadside::lab

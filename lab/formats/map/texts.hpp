// Maps: what the two formats share.
#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "lab/formats/map/boxes.hpp"
#include "lab/formats/map/text.hpp"
#include "lab/formats/quarantine.hpp"

namespace broadside::lab {

/// Where a map's features have their ids.
class MapIds {
 public:
  /// `name` is "id" for the member of that name, or a property, before whose name "properties." may stand;
  /// empty: ids are not read.
  explicit MapIds(std::string name) : name_(std::move(name)) {}

  bool any() const noexcept { return !name_.empty(); }

  /// The id of a feature of GeoJSON, or of a geometry of TopoJSON, as text; empty if ids are not read.
  /// Refuses a feature that has none.
  std::string of(MapText& text, json::object& feature) const;

  /// Refuses a map that has no features, if ids are wanted.
  void refuse(MapText& text, std::string_view found) const;

 private:
  std::string name_;
};

/// Reads GeoJSON of this outermost type: a FeatureCollection, a Feature or a geometry. A GeometryCollection
/// that stands by itself has a feature for each of its geometries.
void read_geojson(MapText& text, std::string_view type, const MapIds& ids, Quarantine& quarantine,
                  MapBoxes& boxes);

/// Reads TopoJSON: the layer of that name, or all, in the file's order, where `layer` is empty. A layer that
/// is a GeometryCollection has a feature for each of its geometries. Segments are those of the arcs that the
/// layers name, each arc once, in the file's order.
void read_topojson(MapText& text, std::string_view layer, const MapIds& ids, Quarantine& quarantine,
                   MapBoxes& boxes);

}  // namespace broadside::lab

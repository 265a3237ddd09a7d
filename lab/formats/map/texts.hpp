// The two kinds of map: each read from a text that was begun.
#pragma once

#include <string_view>

#include "lab/formats/map/boxes.hpp"
#include "lab/formats/map/ids.hpp"
#include "lab/formats/map/text.hpp"
#include "lab/formats/quarantine.hpp"

namespace broadside::lab {

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

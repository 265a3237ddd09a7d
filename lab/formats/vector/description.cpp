// The description of vector data, and how they are recognised.
#include "lab/formats/descriptions.hpp"
#include "lab/formats/unread_formats.hpp"

namespace broadside::lab::readers {

Format vector_description() {
  return {
      .name = "vector",
      .summary =
          "GeoPackage, shapefiles, FlatGeobuf and what else GDAL reads, in doubles; altitudes are left out",
      .extensions = {".gpkg", ".shp", ".fgb", ".sqlite", ".kml", ".kmz", ".gml", ".gpx", ".tab", ".mif"},
      .parts = {{"features", "a box a feature, and none for one without a geometry"}},
      .has_layers = true,
      .can_skip = true,
      .has_ids = true,
      .recognises = is_vector_data,
  };
}

}  // namespace broadside::lab::readers

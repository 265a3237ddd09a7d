// The description of maps, and how they are recognised.
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "lab/formats/descriptions.hpp"

namespace broadside::lab::readers {
namespace {

// Much JSON is not a map, but no other format has these extensions: an error then says what a map lacks.
std::vector<std::string> extensions() { return {".geojson", ".topojson", ".json", ".geojsonl", ".ndjson"}; }

/// Whether the bytes begin an object that says early on to be a map, or a geometry.
bool says_map(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(" \t\r\n\x1e\xEF\xBB\xBF");
  if (first == std::string_view::npos || bytes[first] != '{') return false;
  constexpr std::array<std::string_view, 13> types = {"\"FeatureCollection\"",
                                                      "\"Feature\"",
                                                      "\"Topology\"",
                                                      "\"Polygon\"",
                                                      "\"MultiPolygon\"",
                                                      "\"LineString\"",
                                                      "\"MultiLineString\"",
                                                      "\"Point\"",
                                                      "\"MultiPoint\"",
                                                      "\"GeometryCollection\"",
                                                      "\"annotations\"",
                                                      "\"licenses\"",
                                                      "\"shapes\""};
  return std::ranges::any_of(
      types, [&](std::string_view type) { return bytes.find(type) != std::string_view::npos; });
}

bool is_map(std::string_view bytes, std::string_view extension) {
  const std::vector<std::string> own = extensions();
  return std::ranges::find(own, extension) != own.end() || says_map(bytes);
}

}  // namespace

Format map_description() {
  return {
      .name = "map",
      .summary = "GeoJSON, TopoJSON, COCO's and LabelMe's JSON, in doubles",
      .extensions = extensions(),
      .parts = {{"features", "a box a feature, and none for one without a geometry"},
                {"pieces", "a box a point, line or polygon; those of a multi-geometry apart"},
                {"segments", "a box a segment of a line or of a polygon's rings"}},
      .has_layers = true,
      .can_skip = true,
      .has_ids = true,
      .recognises = is_map,
  };
}

}  // namespace broadside::lab::readers

// The kinds of geometry that GeoJSON and TopoJSON have, and how deep their numbers lie in arrays.
#pragma once

#include <algorithm>
#include <array>
#include <string_view>

namespace broadside::lab {

/// A kind of geometry: an array of points or of lines, `depth` arrays deep.
struct GeometryKind {
  std::string_view name;
  int depth;        ///< arrays around a point, or a line's points
  int piece_depth;  ///< arrays around what is in one piece
  bool has_lines;

  /// The kind of this name; nullptr if there is none.
  static const GeometryKind* find(std::string_view name) {
    static constexpr std::array<GeometryKind, 6> kinds = {{{"Point", 0, 0, false},
                                                           {"MultiPoint", 1, 0, false},
                                                           {"LineString", 1, 1, true},
                                                           {"MultiLineString", 2, 1, true},
                                                           {"Polygon", 2, 2, true},
                                                           {"MultiPolygon", 3, 2, true}}};
    const auto* const found = std::ranges::find(kinds, name, &GeometryKind::name);
    return found == kinds.end() ? nullptr : found;
  }
};

/// What errors say they expected for a geometry's type.
inline constexpr std::string_view geometry_types =
    "Point, MultiPoint, LineString, MultiLineString, Polygon, MultiPolygon or GeometryCollection";

/// Collections in collections beyond this are refused: reading them takes the stack.
inline constexpr int most_nested_collections = 32;

}  // namespace broadside::lab

// The ids of a map's features: their own, or one of their properties.
#pragma once

#include <string>
#include <utility>

#include "lab/formats/map/text.hpp"

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

}  // namespace broadside::lab

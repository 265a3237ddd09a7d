// The JSON of a map: its values by their types, and errors that say where they are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <simdjson.h>

#include "lab/formats/frames.hpp"
#include "lab/formats/input.hpp"
#include "lab/formats/map/boxes.hpp"
#include "lab/formats/quarantine.hpp"

namespace broadside::lab {

namespace json = simdjson::ondemand;

/// The text of a map, which may be one JSON value or one a line. All values come from the text begun last and
/// are good for one reading, in order. Throws FileError naming the input, the byte, and the feature.
class MapText {
 public:
  /// Copies all bytes of the input, which must outlive this.
  explicit MapText(Input& input);

  /// Begins the next text, after checking that it is JSON; false at the end.
  bool next();

  /// The text's outermost value, to be read from its start.
  json::object root();

  /// The field's value; refuses an object without it.
  json::value field(json::object& object, std::string_view name);

  /// The field's value, if it is there and not null.
  std::optional<json::value> optional_field(json::object& object, std::string_view name);

  json::object object(json::value value, std::string_view expected);
  json::array array(json::value value, std::string_view expected);
  std::string_view string(json::value value, std::string_view expected);
  std::string_view key(json::field& field);
  std::int64_t integer(json::value value, std::string_view expected);
  double number(json::value value);
  bool is_null(json::value value);

  /// A string, or a number as it is written.
  std::string label(json::value value, std::string_view expected);

  /// An array's element, or an object's.
  template <typename Element>
  Element element(simdjson::simdjson_result<Element> result) {
    Element element;
    if (const auto error = std::move(result).get(element)) refuse(error, "JSON");
    return element;
  }

  /// Counts features from 0, for errors and for progress.
  void begin_feature();

  /// No feature is being read.
  void end_features() noexcept { is_in_feature_ = false; }

  [[noreturn]] void refuse(std::string_view found, std::string_view expected);

 private:
  [[noreturn]] void refuse(simdjson::error_code error, std::string_view expected);

  std::size_t offset();
  void take_room_for_strings(std::size_t text_bytes);

  Input& input_;
  simdjson::padded_string bytes_;
  bool is_lines_ = false;
  bool has_begun_ = false;
  std::size_t begin_ = 0;  // where the text begins
  std::size_t end_ = 0;    // and ends
  json::parser parser_;
  json::document document_;
  std::unique_ptr<std::uint8_t[]> strings_;  // of the text begun last, unescaped
  std::size_t string_bytes_ = 0;
  std::uint8_t* next_string_ = nullptr;  // where the next one goes
  std::uint64_t features_ = 0;           // those begun
  bool is_in_feature_ = false;
};

/// Where a map's features have their ids.
class MapIds {
 public:
  /// `name` is "id" for the member of that name, or a property, before whose name "properties." may stand;
  /// empty: ids are not read.
  explicit MapIds(std::string name) : name_(std::move(name)) {}

  bool any() const noexcept { return !name_.empty(); }

  /// The id of a GeoJSON feature or a TopoJSON geometry, as text; empty if it has none, or if ids are not
  /// read.
  std::string of(MapText& text, json::object& feature);

  /// Likewise for an annotation or shape: its members are searched for the name.
  std::string of_member(MapText& text, json::object& object);

  /// Whether there were features, and none of them had an id.
  bool are_missing() const noexcept { return is_asked_ && !is_found_; }

  /// Refuses a map that has no features, if ids are wanted.
  void refuse(MapText& text, std::string_view found) const;

 private:
  std::string name_;
  bool is_asked_ = false;
  bool is_found_ = false;
};

/// Reads GeoJSON of this outermost type: a FeatureCollection, a Feature or a geometry. A GeometryCollection
/// that stands by itself has a feature for each of its geometries.
void read_geojson(MapText& text, std::string_view type, MapIds& ids, Quarantine& quarantine, MapBoxes& boxes);

/// Reads TopoJSON: the layer of that name, or all, in the file's order, where `layer` is empty. A layer that
/// is a GeometryCollection has a feature for each of its geometries. Segments are those of the arcs that the
/// layers name, each arc once, in the file's order.
void read_topojson(MapText& text, std::string_view layer, MapIds& ids, Quarantine& quarantine,
                   MapBoxes& boxes);

/// Reads the annotations of a file of COCO: a frame an image. `name` is what errors call the file.
AnyFrameReader read_coco(MapText& text, json::object root, MapIds& ids, Quarantine& quarantine,
                         std::string name);

/// Reads the shapes of a file of LabelMe, as features.
void read_labelme(MapText& text, json::object root, MapIds& ids, Quarantine& quarantine, MapBoxes& boxes);

}  // namespace broadside::lab

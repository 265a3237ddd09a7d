// Reads maps: GeoJSON (RFC 7946), as one value or one value per line; and boxes in images, in the JSON of
// COCO and LabelMe. Coordinates are doubles, exactly as in the file.
#include <algorithm>
#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/json/json_reader.hpp"
#include "lab/formats/quarantine.hpp"
#include "lab/formats/registry.hpp"
#include "lab/formats/text.hpp"
#include "lab/formats/unread_formats.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab::readers {
namespace {

using Kind = JsonValue::Kind;

constexpr std::string_view blanks = " \t\r\n\x1e";  // including the record separator of RFC 8142

// The root's lists.
constexpr std::string_view features = "features";
constexpr std::string_view geometries = "geometries";
constexpr std::string_view annotations = "annotations";  // COCO's
constexpr std::string_view shapes = "shapes";            // LabelMe's
constexpr std::array element_lists = {features, geometries, annotations, shapes};

/// A kind of geometry: an array of points or of lines, nested `depth` arrays deep.
struct GeometryKind {
  std::string_view name;
  int depth;        // arrays around a point
  int piece_depth;  // arrays around one connected piece
  bool has_lines;
};
constexpr auto geometry_kinds = std::to_array<GeometryKind>({{"Point", 0, 0, false},
                                                             {"MultiPoint", 1, 0, false},
                                                             {"LineString", 1, 1, true},
                                                             {"MultiLineString", 2, 1, true},
                                                             {"Polygon", 2, 2, true},
                                                             {"MultiPolygon", 3, 2, true}});
constexpr std::string_view geometry_types =
    "Point, MultiPoint, LineString, MultiLineString, Polygon, MultiPolygon or GeometryCollection";

/// Whether each line is a JSON object: the first line ends one, and the next line begins one.
bool is_line_by_line(std::string_view bytes) {
  const std::size_t first = bytes.find_first_not_of(blanks);
  const std::size_t end = bytes.find('\n', std::min(first, bytes.size()));
  if (end == std::string_view::npos) return false;
  const std::size_t next = bytes.find_first_not_of(blanks, end);
  return bytes[bytes.find_last_not_of(blanks, end)] == '}' && next != std::string_view::npos &&
         bytes[next] == '{';
}

/// Collects boxes while a map is read: points belong to lines, lines to pieces, pieces to features.
class MapReader {
 public:
  MapReader(Input& input, const ReadOptions& options)
      : input_(input),
        options_(options),
        quarantine_(options),
        wanted_{.members = {"type", "geometry", "geometries", "coordinates", "image_id", "bbox", "points",
                            "shape_type"},
                .lists = {element_lists.begin(), element_lists.end()},
                .take = [this](const JsonValue& root, std::string_view list,
                               const JsonValue& element) { take(root, list, element); },
                .progress = [this](std::size_t bytes) { input_.passed(begin_ + bytes); }} {
    if (options.ids.empty()) return;
    constexpr std::string_view prefix = "properties.";
    const bool has_prefix = options.ids.starts_with(prefix);
    is_property_ = options.ids != "id";
    id_name_ = options.ids.substr(has_prefix ? prefix.size() : 0);
    wanted_.members.insert(wanted_.members.end(), {"properties", id_name_});
  }

  AnyFrameReader read() {
    const std::string_view bytes = input_.bytes();
    const bool is_lines = is_line_by_line(bytes);
    std::int64_t line = 1;
    std::size_t end = 0;
    do {
      begin_ = std::min(bytes.find_first_not_of(blanks, end), bytes.size());
      line += std::count(bytes.data() + end, bytes.data() + begin_, '\n');
      end = is_lines ? std::min(bytes.find('\n', begin_), bytes.size()) : bytes.size();
      list_ = {};
      in_feature_ = false;
      const std::string name = is_lines ? fmt::format("{}:{}", input_.name(), line) : input_.name();
      read_root(read_json(bytes.substr(begin_, end - begin_), name, wanted_));
    } while (bytes.find_first_not_of(blanks, end) != std::string_view::npos);
    return result();
  }

 private:
  [[noreturn]] void refuse(std::string_view found, std::string_view expected) const {
    throw FileError(fmt::format("{}: {}{}; expected {}", input_.name(),
                                in_feature_ ? fmt::format("feature {}: ", features_ - 1) : "", found,
                                expected));
  }

  AnyFrameReader result() {
    in_feature_ = false;
    if (features_ > 0 && !options_.ids.empty() && !has_ids_)
      refuse(
          fmt::format("no feature has {} {}", is_property_ ? "a property" : "a member", shown(options_.ids)),
          is_property_ ? "a property that --ids can take, or id" : "a property that --ids can take");
    const std::string warning = quarantine_.warning(input_.name());
    if (list_ == annotations) return images(warning);
    auto labels = std::make_shared<BoxLabels>();
    labels->has_ids = !options_.ids.empty();
    labels->ids = std::move(ids_);
    return std::make_unique<HistoryReader<2, double>>(History<2, double>{std::move(boxes_), {}},
                                                      std::move(labels), warning);
  }

  /// One frame for each image, in the order in which the images first occur.
  AnyFrameReader images(std::string warning) {
    if (images_.size() > 1)
      warning.insert(
          0, fmt::format("{}: a frame for each of {} images, from --frame 0, image {}{}", input_.name(),
                         grouped(images_.size()), shown(first_image_), warning.empty() ? "" : "\n"));
    return std::make_unique<SeparateFrames<2>>(std::move(images_), !options_.ids.empty(), true,
                                               std::move(warning));
  }

  // The content of a text.

  /// Takes an element of one of the root's lists, unless the root's type, which usually comes first, shows
  /// that the list does not belong to a map.
  void take(const JsonValue& root, std::string_view list, const JsonValue& element) {
    if (const JsonValue* const type = root.find("type"); type != nullptr && list != list_of(type->text))
      return;
    if (!list_.empty() && list != list_)
      refuse(fmt::format("'{}' beside '{}'", list, list_), "one list of boxes");
    list_ = *std::find(element_lists.begin(), element_lists.end(), list);
    if (list == annotations)
      read_annotation(element);
    else if (list == shapes)
      read_whole([&] { read_shape(element); });
    else if (list == features)
      read_whole([&] { read_feature(element); });
    else
      read_whole([&] { read_geometry(element, 1); });
  }

  static std::string_view list_of(std::string_view type) {
    return type == "FeatureCollection" ? features : type == "GeometryCollection" ? geometries : "";
  }

  /// Reads the rest of the root, after the elements of its lists.
  void read_root(const JsonValue& root) {
    if (root.kind != Kind::object)
      refuse(root.shown(),
             "an object of GeoJSON, COCO or LabelMe; to make a table of a list of boxes: jq -r "
             "'.[]|[.image_id]+.bbox|@csv', with --columns=frame,x,y,w,h if they are COCO's");
    in_feature_ = false;
    const JsonValue* const told = root.find("type");
    if (told == nullptr || told->kind == Kind::null) return read_images(root);
    const std::string& type = text_of(*told, "the type of a map");
    if (type == "Topology")
      throw FileError(fmt::format("{}: {}", input_.name(), unread_format("", ".topojson", input_.name())));
    if (const std::string_view list = list_of(type); !list.empty()) {
      if (!options_.ids.empty() && list == geometries) refuse_ids("geometries");
      elements_of(member_of(root, list), fmt::format("an array of {}", list));
      if (!list_.empty() && list_ != list) refuse(fmt::format("'{}'", list_), fmt::format("'{}'", list));
    } else if (type == "Feature") {
      read_whole([&] { read_feature(root); });
    } else {
      if (!options_.ids.empty()) refuse_ids("a geometry");
      read_whole([&] { read_geometry(root, 0); });
    }
  }

  void refuse_ids(std::string_view found) const {
    refuse(found, fmt::format("features, as --ids {} asks for their ids", options_.ids));
  }

  void read_images(const JsonValue& root) {
    for (const std::string_view list : {annotations, shapes}) {
      if (root.find(list) == nullptr) continue;
      if (!options_.boxes.empty() && options_.boxes != "features")
        refuse("boxes in images", "no --boxes other than features");
      elements_of(*root.find(list), fmt::format("an array of {}", list));
      list_ = list;
      return;
    }
    refuse("an object without 'type'",
           "GeoJSON, COCO's annotations or LabelMe's shapes; for other JSON, make a table with jq");
  }

  /// Reads a feature, or leaves it out if it is invalid.
  template <typename Read>
  void read_whole(const Read& read) {
    const std::size_t before = boxes_.size();
    ++features_;
    in_feature_ = true;
    id_.clear();
    feature_ = absent_box<2, double>();
    if (!quarantine_.holds(read)) {
      boxes_.resize(before);
      ids_.resize(std::min(ids_.size(), before));
      feature_ = piece_ = absent_box<2, double>();
    }
    if (options_.boxes.empty() || options_.boxes == "features") put(feature_);
  }

  // GeoJSON.

  void read_feature(const JsonValue& feature) {
    if (feature.kind != Kind::object) refuse(feature.shown(), "a feature");
    const JsonValue* const properties = feature.find("properties");
    if (!is_property_)
      set_id(feature);
    else if (properties != nullptr)
      set_id(*properties);
    const JsonValue& geometry = member_of(feature, "geometry");
    if (geometry.kind != Kind::null) read_geometry(geometry, 0);
  }

  void read_geometry(const JsonValue& geometry, int nested) {
    if (geometry.kind != Kind::object) refuse(geometry.shown(), "a geometry, or null in a feature");
    const std::string& type = text_of(member_of(geometry, "type"), geometry_types);
    if (type == "GeometryCollection") {
      constexpr int max_collections = 32;
      if (nested == max_collections)
        refuse(fmt::format("collections nested more than {} deep", max_collections), "fewer");
      for (const JsonValue& one : elements_of(member_of(geometry, geometries), "an array of geometries"))
        read_geometry(one, nested + 1);
      return;
    }
    const auto* const kind = std::find_if(geometry_kinds.begin(), geometry_kinds.end(),
                                          [&](const GeometryKind& known) { return known.name == type; });
    if (kind == geometry_kinds.end())
      refuse(fmt::format("a geometry of type {}", shown(type)), geometry_types);
    read_coordinates(member_of(geometry, "coordinates"), *kind, kind->depth);
  }

  void read_coordinates(const JsonValue& value, const GeometryKind& kind, int depth) {
    if (depth == 0) {
      // Some programs write an empty point as an empty array.
      if (value.kind != Kind::array || !value.items.empty() || !value.numbers.empty())
        add(position_of(value), kind.has_lines);
    } else {
      is_in_line_ = false;
      for (const JsonValue& item : elements_of(value, "an array of positions")) {
        if (depth == 1 && kind.has_lines)
          add(position_of(item), true);
        else
          read_coordinates(item, kind, depth - 1);
      }
    }
    if (depth == kind.piece_depth) end_piece();
  }

  // Boxes in images.

  void read_annotation(const JsonValue& annotation) {
    ++features_;
    in_feature_ = true;
    id_.clear();
    if (annotation.kind != Kind::object) refuse(annotation.shown(), "an annotation");
    const JsonValue* const image = annotation.find("image_id");
    const std::string name =
        image == nullptr || image->kind == Kind::null ? "" : label_of(*image, "an image's id");
    const std::size_t frame = image_numbers_.try_emplace(name, image_numbers_.size()).first->second;
    if (frame == 0) first_image_ = name;
    if (frame == images_.size()) images_.emplace_back();
    set_id(annotation);
    images_[frame].ids.push_back(id_);
    images_[frame].boxes.push_back(absent_box<2, double>());
    quarantine_.holds([&] { images_[frame].boxes.back() = box_of(annotation.find("bbox")); });
  }

  /// "bbox": a corner and a size; without one, the box is absent.
  DoubleBox2 box_of(const JsonValue* bbox) const {
    if (bbox == nullptr || bbox->kind == Kind::null) return absent_box<2, double>();
    const std::vector<double>& numbers = numbers_of(*bbox, "the array x, y, width, height");
    if (numbers.empty()) return absent_box<2, double>();
    if (numbers.size() != 4 || !(numbers[2] >= 0) || !(numbers[3] >= 0))
      refuse(fmt::format("a bbox of {} numbers ({})", numbers.size(), fmt::join(numbers, ", ")),
             "x, y and a width and height of 0 or more");
    return {{numbers[0], numbers[1]}, {numbers[0] + numbers[2], numbers[1] + numbers[3]}};
  }

  void read_shape(const JsonValue& shape) {
    if (shape.kind != Kind::object) refuse(shape.shown(), "a shape");
    set_id(shape);
    // Its two points are the centre and a point on the circle.
    if (const JsonValue* const type = shape.find("shape_type"); type != nullptr && type->text == "circle")
      refuse("a circle", "rectangles, polygons, lines or points");
    for (const JsonValue& point : elements_of(member_of(shape, "points"), "an array of points"))
      add(position_of(point), false);
    end_piece();
  }

  // Values.

  const JsonValue& member_of(const JsonValue& object, std::string_view name) const {
    const JsonValue* const member = object.find(name);
    if (member == nullptr) refuse(fmt::format("an object without '{}'", name), "one that has it");
    return *member;
  }

  const std::string& text_of(const JsonValue& value, std::string_view expected) const {
    if (value.kind != Kind::text) refuse(value.shown(), expected);
    return value.text;
  }

  /// The elements of an array that has no numbers.
  const std::vector<JsonValue>& elements_of(const JsonValue& value, std::string_view expected) const {
    if (value.kind != Kind::array) refuse(value.shown(), expected);
    if (!value.numbers.empty()) refuse(fmt::format("the number {}", value.numbers.front()), expected);
    return value.items;
  }

  const std::vector<double>& numbers_of(const JsonValue& value, std::string_view expected) const {
    if (value.kind != Kind::array) refuse(value.shown(), expected);
    if (!value.items.empty()) refuse(value.items.front().shown(), "a number");
    return value.numbers;
  }

  /// The first two numbers of a position; others are an altitude or application data.
  std::array<double, 2> position_of(const JsonValue& value) const {
    const std::vector<double>& numbers = numbers_of(value, "a position: an array of numbers");
    if (numbers.size() < 2)
      refuse(fmt::format("a position of {}", numbers.empty() ? "no numbers" : "1 number"),
             "at least 2 numbers");
    return {numbers[0], numbers[1]};
  }

  /// A text, or a number as it is written.
  std::string label_of(const JsonValue& value, std::string_view expected) const {
    if (value.kind != Kind::text && value.kind != Kind::number) refuse(value.shown(), expected);
    return value.text;
  }

  void set_id(const JsonValue& object) {
    const JsonValue* const id = options_.ids.empty() ? nullptr : object.find(id_name_);
    if (id == nullptr || id->kind == Kind::null) return;
    id_ = label_of(*id, "an id: a text or a number");
    has_ids_ = true;
  }

  // Boxes.

  /// Adds a point to the piece. In a line, a segment joins it to the previous point.
  void add(const std::array<double, 2>& place, bool is_in_line) {
    const DoubleBox2 point{place, place};
    piece_ = merged(point, piece_);
    if (!is_in_line) return;
    if (std::exchange(is_in_line_, true) && options_.boxes == "segments") put(merged(point, last_));
    last_ = point;
  }

  void end_piece() {
    if (options_.boxes == "pieces" && !is_absent(piece_)) put(piece_);
    feature_ = merged(std::exchange(piece_, absent_box<2, double>()), feature_);
  }

  void put(const DoubleBox2& box) {
    boxes_.push_back(box);
    if (!options_.ids.empty()) ids_.push_back(id_);
  }

  Input& input_;
  const ReadOptions& options_;
  Quarantine quarantine_;
  JsonSelection wanted_;
  bool is_property_ = false;  // whether ids are properties
  std::string id_name_;

  std::size_t begin_ = 0;       // of the text
  std::string_view list_;       // the list whose elements were taken
  std::uint64_t features_ = 0;  // begun so far, in all texts
  bool in_feature_ = false;
  bool has_ids_ = false;

  std::vector<DoubleBox2> boxes_;
  std::vector<std::string> ids_;  // of the boxes
  std::string id_;
  DoubleBox2 feature_ = absent_box<2, double>();
  DoubleBox2 piece_ = absent_box<2, double>();
  DoubleBox2 last_{};  // point of the line
  bool is_in_line_ = false;

  std::vector<SeparateFrames<2>::Frame> images_;
  std::unordered_map<std::string, std::size_t> image_numbers_;
  std::string first_image_;
};

// Much JSON is not a map, but no other format has these extensions: an error then says what a map lacks.
const std::vector<std::string> extensions = {".geojson", ".json", ".geojsonl", ".ndjson"};

/// Whether the file has the extension of a map, or its bytes begin an object whose first members identify it
/// as a map or a geometry.
bool is_map(std::string_view bytes, std::string_view extension) {
  if (std::find(extensions.begin(), extensions.end(), extension) != extensions.end()) return true;
  const std::size_t first = bytes.find_first_not_of(" \t\r\n\x1e\xEF\xBB\xBF");
  if (first == std::string_view::npos || bytes[first] != '{') return false;
  const auto says = [&](std::string_view word) {
    return bytes.find(fmt::format("\"{}\"", word)) != std::string_view::npos;
  };
  return std::any_of(geometry_kinds.begin(), geometry_kinds.end(),
                     [&](const GeometryKind& kind) { return says(kind.name); }) ||
         says("FeatureCollection") || says("Feature") || says("GeometryCollection") || says("Topology") ||
         says("licenses") || says(annotations) || says(shapes);
}

}  // namespace

Format map() {
  return {
      .name = "map",
      .summary = "GeoJSON, COCO's and LabelMe's JSON, in doubles",
      .extensions = extensions,
      .parts = {{"features", "a box a feature, and none for one without a geometry"},
                {"pieces", "a box a point, line or polygon; those of a multi-geometry apart"},
                {"segments", "a box a segment of a line or of a polygon's rings"}},
      .can_skip = true,
      .has_ids = true,
      .recognises = is_map,
      .open = [](std::unique_ptr<Input> input,
                 const ReadOptions& options) { return MapReader(*input, options).read(); },
  };
}

}  // namespace broadside::lab::readers

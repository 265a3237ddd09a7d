// Boxes gathered from the points of a map: of features, of their pieces, or of the segments of their lines.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "broadside/box.hpp"

namespace broadside::lab {

/// What of a map the boxes are of.
enum class MapPart : std::uint8_t {
  features,  ///< a box a feature, absent where it has no points
  pieces,    ///< a box a point, line or polygon; those of a multi-geometry apart
  segments,  ///< a box a segment of a line or of a polygon's rings
};

/// Gathers boxes while a map is read: points belong to lines, lines to pieces, pieces to features.
class MapBoxes {
 public:
  /// `has_ids` says that each feature's id is kept beside each of its boxes.
  MapBoxes(MapPart part, bool has_ids) : part_(part), has_ids_(has_ids) {}

  MapPart part() const noexcept { return part_; }

  void begin_feature() {
    feature_begin_ = boxes_.size();
    id_.clear();
  }

  void set_id(std::string id) { id_ = std::move(id); }

  /// The next line begins; lone points need none.
  void begin_line() { is_in_line_ = false; }

  /// A point of the line, which a segment joins to the one before; or, where `is_alone`, a point by itself.
  void add(double x, double y, bool is_alone = false) {
    const DoubleBox2 point{{x, y}, {x, y}};
    extend(piece_, point);
    if (part_ == MapPart::segments && !is_alone) {
      if (std::exchange(is_in_line_, true)) add_segment(last_, point);
      last_ = point;
    }
  }

  /// The bounds of many points of the piece at once. Makes no segments.
  void add_bounds(const DoubleBox2& bounds) { extend(piece_, bounds); }

  /// A segment by itself, as a box.
  void add_segment(const DoubleBox2& box) { put(box); }

  void end_piece() {
    if (part_ == MapPart::pieces && !is_absent(piece_)) put(piece_);
    extend(feature_, std::exchange(piece_, absent_box<2, double>()));
  }

  void end_feature() {
    if (part_ == MapPart::features) put(feature_);
    feature_ = absent_box<2, double>();
  }

  /// Leaves out what there is of the feature begun; its box is absent.
  void drop_feature() {
    boxes_.resize(feature_begin_);
    if (has_ids_) ids_.resize(feature_begin_);
    piece_ = feature_ = absent_box<2, double>();
    end_feature();
  }

  std::vector<DoubleBox2> take() { return std::move(boxes_); }
  std::vector<std::string> take_ids() { return std::move(ids_); }

  /// Makes `box` hold `other` as well.
  static void extend(DoubleBox2& box, const DoubleBox2& other) {
    for (int axis = 0; axis < 2; ++axis) {
      box.min[axis] = box.min[axis] < other.min[axis] ? box.min[axis] : other.min[axis];
      box.max[axis] = box.max[axis] > other.max[axis] ? box.max[axis] : other.max[axis];
    }
  }

 private:
  void add_segment(DoubleBox2 from, const DoubleBox2& to) {
    extend(from, to);
    put(from);
  }

  void put(const DoubleBox2& box) {
    boxes_.push_back(box);
    if (has_ids_) ids_.push_back(id_);
  }

  MapPart part_;
  bool has_ids_;
  std::vector<DoubleBox2> boxes_;
  std::vector<std::string> ids_;
  std::string id_;
  std::size_t feature_begin_ = 0;  // in boxes_
  DoubleBox2 feature_ = absent_box<2, double>();
  DoubleBox2 piece_ = absent_box<2, double>();
  DoubleBox2 last_{};
  bool is_in_line_ = false;
};

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

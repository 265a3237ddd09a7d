// TopoJSON, version 1 of its specification: geometries made of arcs that neighbours share, each arc often
// written as differences of whole numbers that a transform puts in place.
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/map/boxes.hpp"
#include "lab/formats/map/text.hpp"

namespace broadside::lab {
namespace {

using Point = std::array<double, 2>;

class TopoJson {
 public:
  TopoJson(MapText& text, MapIds& ids, Quarantine& quarantine, MapBoxes& boxes)
      : text_(text), ids_(ids), quarantine_(quarantine), boxes_(boxes) {}

  void read(std::string_view layer) {
    if (boxes_.part() == MapPart::segments) ids_.refuse(text_, "segments of TopoJSON, which features share");
    read_transform();
    read_arcs();
    read_layers(layer);
    if (boxes_.part() == MapPart::segments) add_segments();
  }

 private:
  struct Arc {
    DoubleBox2 bounds = absent_box<2, double>();
    std::size_t segments_end = 0;  // where its own end in segments_
    bool is_used = false;
  };

  void read_transform() {
    json::object root = text_.root();
    const auto transform = text_.optional_field(root, "transform");
    if (!transform) return;
    json::object object = text_.object(*transform, "a transform");
    scale_ = read_point(text_.field(object, "scale"));
    translate_ = read_point(text_.field(object, "translate"));
    has_transform_ = true;
  }

  void read_arcs() {
    json::object root = text_.root();
    for (auto result : text_.array(text_.field(root, "arcs"), "an array of arcs")) {
      Arc arc;
      Point sum = {0, 0};
      DoubleBox2 last{};
      bool is_first = true;
      for (auto position : text_.array(text_.element(result), "an arc: an array of positions")) {
        const Point read = read_point(text_.element(position));
        sum = has_transform_ ? Point{sum[0] + read[0], sum[1] + read[1]} : read;
        const Point place = placed(sum);
        const DoubleBox2 point{place, place};
        MapBoxes::extend(arc.bounds, point);
        if (boxes_.part() == MapPart::segments && !is_first) {
          MapBoxes::extend(last, point);
          segments_.push_back(last);
        }
        last = point;
        is_first = false;
      }
      arc.segments_end = segments_.size();
      arcs_.push_back(arc);
    }
  }

  void read_layers(std::string_view wanted) {
    json::object root = text_.root();
    bool is_found = wanted.empty();
    std::string known;
    for (auto result : text_.object(text_.field(root, "objects"), "an object of layers")) {
      json::field field = text_.element(result);
      const std::string_view name = text_.key(field);
      if (!wanted.empty() && name != wanted) {
        known += (known.empty() ? "" : ", ") + std::string(name);
        continue;
      }
      is_found = true;
      read_layer(text_.object(field.value(), "a layer: a geometry"));
    }
    text_.end_features();
    if (!is_found) text_.refuse(fmt::format("no layer '{}'", wanted), "one of: " + known);
  }

  void read_layer(json::object layer) {
    const std::string type = type_of(layer);
    if (type != "GeometryCollection") {
      read_whole([&] {
        boxes_.set_id(ids_.of(text_, layer));
        read_geometry(layer, type, 0);
        boxes_.end_feature();
      });
      return;
    }
    for (auto result : text_.array(text_.field(layer, "geometries"), "an array of geometries")) {
      read_whole([&] {
        json::object geometry = text_.object(text_.element(result), "a geometry");
        boxes_.set_id(ids_.of(text_, geometry));
        read_geometry(geometry, type_of(geometry), 1);
        boxes_.end_feature();
      });
    }
  }

  /// Reads what is a feature, or leaves it out.
  template <typename Read>
  void read_whole(const Read& read) {
    text_.begin_feature();
    boxes_.begin_feature();
    if (!quarantine_.holds(read)) boxes_.drop_feature();
  }

  /// Empty for a geometry that is not there.
  std::string type_of(json::object& geometry) {
    const auto type = text_.optional_field(geometry, "type");
    return type ? std::string(text_.string(*type, geometry_types)) : std::string();
  }

  void read_geometry(json::object geometry, const std::string& type, int nested) {
    if (type.empty()) return;
    if (type == "GeometryCollection") {
      if (nested == most_nested_collections)
        text_.refuse(fmt::format("collections nested more than {} deep", nested), "fewer");
      for (auto result : text_.array(text_.field(geometry, "geometries"), "an array of geometries")) {
        json::object inner = text_.object(text_.element(result), "a geometry");
        read_geometry(inner, type_of(inner), nested + 1);
      }
      return;
    }
    const GeometryKind* const kind = GeometryKind::find(type);
    if (kind == nullptr) text_.refuse(fmt::format("a geometry of type '{}'", type), geometry_types);
    read_nested(text_.field(geometry, kind->has_lines ? "arcs" : "coordinates"), *kind, kind->depth);
  }

  void read_nested(json::value value, const GeometryKind& kind, int depth) {
    if (depth == 0) {
      const Point place = placed(read_point(value));
      boxes_.add(place[0], place[1], true);
    } else if (depth == 1 && kind.has_lines) {
      for (auto result : text_.array(value, "an array of arcs' numbers")) use_arc(text_.element(result));
    } else {
      for (auto result : text_.array(value, "an array")) read_nested(text_.element(result), kind, depth - 1);
    }
    if (depth == kind.piece_depth) boxes_.end_piece();
  }

  void use_arc(json::value value) {
    const std::int64_t number = text_.integer(value, "the number of an arc");
    // ~i is arc i walked backwards.
    const auto i = static_cast<std::uint64_t>(number < 0 ? ~number : number);
    if (i >= arcs_.size())
      text_.refuse(fmt::format("arc {}", number), fmt::format("one of {}", arcs_.size()));
    arcs_[i].is_used = true;
    boxes_.add_bounds(arcs_[i].bounds);
  }

  Point read_point(json::value value) {
    Point point{};
    std::size_t count = 0;
    for (auto result : text_.array(value, "an array of two numbers")) {
      json::value number = text_.element(result);
      if (count < 2) point[count] = text_.number(number);
      ++count;
    }
    if (count < 2)
      text_.refuse(fmt::format("an array of {}", count == 0 ? "no numbers" : "1 number"), "two numbers");
    return point;
  }

  /// Where a point of the file is.
  Point placed(const Point& point) {
    if (!has_transform_) return point;
    Point place{};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      place[axis] = point[axis] * scale_[axis] + translate_[axis];
      if (!std::isfinite(place[axis]))
        text_.refuse("a point that the transform puts beyond the largest double", "one within");
    }
    return place;
  }

  void add_segments() {
    std::size_t begin = 0;
    for (const Arc& arc : arcs_) {
      for (std::size_t i = begin; arc.is_used && i < arc.segments_end; ++i) boxes_.add_segment(segments_[i]);
      begin = arc.segments_end;
    }
  }

  MapText& text_;
  MapIds& ids_;
  Quarantine& quarantine_;
  MapBoxes& boxes_;
  bool has_transform_ = false;
  Point scale_ = {1, 1};
  Point translate_ = {0, 0};
  std::vector<Arc> arcs_;
  std::vector<DoubleBox2> segments_;  // of all arcs, where they are wanted
};

}  // namespace

void read_topojson(MapText& text, std::string_view layer, MapIds& ids, Quarantine& quarantine,
                   MapBoxes& boxes) {
  TopoJson(text, ids, quarantine, boxes).read(layer);
}

}  // namespace broadside::lab

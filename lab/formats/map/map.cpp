// Maps: GeoJSON (whole, or a value a line) and TopoJSON, in doubles.
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/descriptions.hpp"
#include "lab/formats/map/boxes.hpp"
#include "lab/formats/map/text.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab::readers {
namespace {

MapPart part_of(const ReadOptions& options) {
  if (options.boxes == "segments") return MapPart::segments;
  return options.boxes == "pieces" ? MapPart::pieces : MapPart::features;
}

/// Throws FileError where no feature has what --ids names.
void refuse_missing(const MapIds& ids, const ReadOptions& options, const std::string& name) {
  if (ids.are_missing())
    throw FileError(fmt::format("{}: no feature has {} {}; expected a {} that --ids can take", name,
                                options.ids == "id" ? "a member" : "a property", shown(options.ids),
                                options.ids == "id" ? "property" : "property, or id"));
}

AnyFrameReader open_map(std::unique_ptr<Input> input, const ReadOptions& options) {
  MapText text(*input);
  MapIds ids(options.ids);
  Quarantine quarantine(options);
  MapBoxes boxes(part_of(options), ids.any());
  while (text.next()) {
    json::object root = text.root();
    // What the text begins anew overwrites its strings.
    const std::optional<json::value> told = text.optional_field(root, "type");
    const std::string type(told ? text.string(*told, "the type of a map") : "");
    if (type.empty()) {
      if (!options.layer.empty() || part_of(options) != MapPart::features)
        text.refuse("boxes in images, or no map", "no --layer, and no --boxes other than features");
      if (text.optional_field(root, "annotations")) {
        AnyFrameReader images = read_coco(text, text.root(), ids, quarantine, input->name());
        refuse_missing(ids, options, input->name());
        return images;
      }
      if (!text.optional_field(root, "shapes"))
        text.refuse("an object without 'type'",
                    "GeoJSON, TopoJSON, COCO's annotations or LabelMe's shapes; for other JSON, make a table "
                    "with jq");
      read_labelme(text, text.root(), ids, quarantine, boxes);
    } else if (type == "Topology") {
      read_topojson(text, options.layer, ids, quarantine, boxes);
    } else {
      if (!options.layer.empty())
        text.refuse(fmt::format("GeoJSON, which has no layer '{}'", options.layer), "TopoJSON");
      read_geojson(text, type, ids, quarantine, boxes);
    }
  }
  refuse_missing(ids, options, input->name());
  auto labels = std::make_shared<BoxLabels>();
  labels->has_ids = ids.any();
  labels->ids = boxes.take_ids();
  return std::make_unique<HistoryReader<2, double>>(History<2, double>{boxes.take(), {}}, std::move(labels),
                                                    quarantine.warning(input->name()));
}

}  // namespace

Format map() {
  Format format = map_description();
  format.open = open_map;
  return format;
}

}  // namespace broadside::lab::readers

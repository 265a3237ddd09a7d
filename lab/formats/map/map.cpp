// Maps: GeoJSON (whole, or a value a line) and TopoJSON, in doubles.
#include <memory>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "lab/formats/descriptions.hpp"
#include "lab/formats/map/boxes.hpp"
#include "lab/formats/map/text.hpp"

namespace broadside::lab::readers {
namespace {

MapPart part_of(const ReadOptions& options) {
  if (options.boxes == "segments") return MapPart::segments;
  return options.boxes == "pieces" ? MapPart::pieces : MapPart::features;
}

AnyFrameReader open_map(std::unique_ptr<Input> input, const ReadOptions& options) {
  MapText text(*input);
  const MapIds ids(options.ids);
  Quarantine quarantine(options);
  MapBoxes boxes(part_of(options), ids.any());
  while (text.next()) {
    json::object root = text.root();
    // What the text begins anew overwrites its strings.
    const std::string type(text.string(text.field(root, "type"), "the type of a map"));
    if (type == "Topology") {
      read_topojson(text, options.layer, ids, quarantine, boxes);
    } else {
      if (!options.layer.empty())
        text.refuse(fmt::format("GeoJSON, which has no layer '{}'", options.layer), "TopoJSON");
      read_geojson(text, type, ids, quarantine, boxes);
    }
  }
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

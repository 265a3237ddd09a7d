// Real maps: neighbours that share borders, and coasts, whose lines have segments of every length.
#include "lab/formats/descriptions.hpp"
#include "lab/scenes/data_file.hpp"
#include "lab/scenes/descriptions.hpp"

namespace broadside::lab::generated {
namespace {

/// A map, described; `feature_part` is the part of the format whose boxes are one a feature, `feature` what
/// that is.
Scene map_scene(Scene scene, const std::filesystem::path& path, const std::string& layer,
                const std::string& feature_part, const std::string& feature) {
  scene.kind = SceneKind::file;
  scene.fixed_count = true;
  scene.fixed_seed = true;
  scene.missing = missing_data(path, readers::map().missing);
  scene.tunables = {{.name = "boxes",
                     .summary = "a box a " + feature + ", or a box a segment of the lines around them",
                     .standard = "features",
                     .type = Tunable::Type::choice,
                     .choices = {"features", "segments"}}};
  scene.boxes_2d = [=](const Settings& settings, std::size_t, std::uint64_t) {
    const bool is_segments = settings.text("boxes") == "segments";
    const ReadOptions options{.boxes = is_segments ? "segments" : feature_part, .layer = layer};
    return read_file(path, options).in_2d.value().boxes;
  };
  return scene;
}

}  // namespace

Scene counties() {
  return map_scene({.name = "counties",
                    .summary = "the counties of the United States, in degrees",
                    .source = "United States Census Bureau, 2017; npm package us-atlas"},
                   data_file("counties.topojson"), "counties", "features", "county");
}

Scene coastlines() {
  return map_scene({.name = "coastlines",
                    .summary = "the continents and islands of the Earth, in degrees",
                    .source = "Natural Earth, 1:50,000,000; npm package world-atlas"},
                   data_file("land.topojson"), "land", "pieces", "continent or island");
}

}  // namespace broadside::lab::generated

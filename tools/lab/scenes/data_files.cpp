// Scenes of real boxes, from the files that tools/setup/setup downloads.
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "lab/formats/format.hpp"
#include "lab/scenes/registry.hpp"

namespace broadside::lab::generated {
namespace {

/// The path of a data file: in the folder $BROADSIDE_DATA, or where tools/setup/setup puts it.
std::filesystem::path data_file(const std::string& name) {
  const char* const folder = std::getenv("BROADSIDE_DATA");
  return std::filesystem::path(folder != nullptr ? folder : BROADSIDE_DATA_FOLDER) / name;
}

/// Why a scene of this file cannot be made; empty if it can be.
std::string missing_data(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored) ? "" : file.string() + " is missing; run tools/setup/setup";
}

/// A map scene. `part` is the format's kind of element with a box per `feature`. The lines around features,
/// each once if two features share it, are in a separate file.
Scene map_scene(Scene scene, const std::string& map, const std::string& lines, const std::string& part,
                const std::string& feature) {
  const std::filesystem::path map_file = data_file(map);
  const std::filesystem::path lines_file = data_file(lines);
  scene.kind = SceneKind::file;
  scene.fixed_count = true;
  scene.fixed_seed = true;
  scene.missing = missing_data(map_file);
  if (scene.missing.empty()) scene.missing = missing_data(lines_file);
  scene.tunables = {{.name = "boxes",
                     .summary = "a box a " + feature + ", or a box a segment of the lines around them",
                     .default_value = "features",
                     .type = Tunable::Type::choice,
                     .choices = {"features", "segments"}}};
  scene.boxes_2d = [=](const Settings& settings, std::size_t, std::uint64_t) {
    const bool are_segments = settings.text("boxes") == "segments";
    return read_file(are_segments ? lines_file : map_file, {.boxes = are_segments ? "segments" : part})
        .in_2d.value()
        .boxes;
  };
  return scene;
}

}  // namespace

// The triangles of the Stanford bunny: a surface, so there are many boxes in space but few on a line through
// it.
Scene bunny() {
  Scene scene{.name = "bunny",
              .summary = "the triangles of the Stanford bunny; seen along the z axis in 2D",
              .source = "Stanford University Computer Graphics Laboratory; npm package bunny",
              .kind = SceneKind::file,
              .fixed_count = true,
              .fixed_seed = true};
  const std::filesystem::path path = data_file("bunny.obj");
  scene.missing = missing_data(path);
  scene.boxes_2d = [path](const Settings&, std::size_t, std::uint64_t) {
    return read_file(path).in_2d.value().boxes;
  };
  scene.boxes_3d = [path](const Settings&, std::size_t, std::uint64_t) {
    return read_file(path).in_3d.value().boxes;
  };
  return scene;
}

// Maps: neighbours with common borders, and coasts, whose lines have segments of every length.
Scene counties() {
  return map_scene({.name = "counties",
                    .summary = "the counties of the United States, in degrees",
                    .source = "United States Census Bureau, 2017; npm package us-atlas"},
                   "counties.geojson", "county_borders.geojson", "features", "county");
}

Scene coastlines() {
  return map_scene({.name = "coastlines",
                    .summary = "the continents and islands of the Earth, in degrees",
                    .source = "Natural Earth, 1:50,000,000; npm package world-atlas"},
                   "land.geojson", "coastlines.geojson", "pieces", "continent or island");
}

}  // namespace broadside::lab::generated

// Scenes of real boxes, from the files that scripts/setup fetches.
#include <cstdlib>
#include <filesystem>
#include <system_error>

#include "lab/formats/descriptions.hpp"
#include "lab/scenes/descriptions.hpp"

namespace broadside::lab::generated {
namespace {

/// Where scripts/setup puts the file of this name, or the folder $BROADSIDE_DATA has it.
std::filesystem::path data_file(const std::string& name) {
  const char* const folder = std::getenv("BROADSIDE_DATA");
  return std::filesystem::path(folder != nullptr ? folder : BROADSIDE_DATA_FOLDER) / name;
}

/// Why a scene of this file cannot be made: the file is missing, or `reader_missing`; empty if it can be.
std::string missing_data(const std::filesystem::path& file, const std::string& reader_missing) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored) ? reader_missing
                                                : file.string() + " is missing; run scripts/setup";
}

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
                     .default_value = "features",
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

// The triangles of the Stanford bunny: a surface, where boxes are many in space but few on a line through it.
Scene bunny() {
  Scene scene{.name = "bunny",
              .summary = "the triangles of the Stanford bunny; seen along the z axis in 2D",
              .source = "Stanford University Computer Graphics Laboratory; npm package bunny",
              .kind = SceneKind::file,
              .fixed_count = true,
              .fixed_seed = true};
  const std::filesystem::path path = data_file("bunny.obj");
  scene.missing = missing_data(path, readers::mesh().missing);
  scene.boxes_2d = [path](const Settings&, std::size_t, std::uint64_t) {
    return read_file(path).in_2d.value().boxes;
  };
  scene.boxes_3d = [path](const Settings&, std::size_t, std::uint64_t) {
    return read_file(path).in_3d.value().boxes;
  };
  return scene;
}

// Maps: neighbours that share borders, and coasts, whose lines have segments of every length.
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

// The triangles of the Stanford bunny: a surface, where boxes are many in space but few on a line through it.
#include <cstdlib>
#include <filesystem>

#include "lab/readers/descriptions.hpp"
#include "lab/scenes/descriptions.hpp"

namespace broadside::lab::generated {
namespace {

/// Where scripts/setup puts the mesh.
std::filesystem::path mesh_path() {
  const char* const folder = std::getenv("BROADSIDE_DATA");
  return std::filesystem::path(folder != nullptr ? folder : BROADSIDE_DATA_FOLDER) / "bunny.obj";
}

}  // namespace

Scene bunny() {
  Scene scene{.name = "bunny",
              .summary = "the triangles of the Stanford bunny; seen along the z axis in 2D",
              .source = "Stanford University Computer Graphics Laboratory; npm package bunny",
              .kind = SceneKind::file,
              .fixed_count = true,
              .fixed_seed = true};
  const std::filesystem::path path = mesh_path();
  std::error_code ignored;
  scene.missing = std::filesystem::exists(path, ignored) ? readers::mesh().missing
                                                         : path.string() + " is missing; run scripts/setup";
  scene.boxes_2d = [path](const Settings&, std::size_t, std::uint64_t) {
    return read_file(path).in_2d.value().boxes;
  };
  scene.boxes_3d = [path](const Settings&, std::size_t, std::uint64_t) {
    return read_file(path).in_3d.value().boxes;
  };
  return scene;
}

}  // namespace broadside::lab::generated

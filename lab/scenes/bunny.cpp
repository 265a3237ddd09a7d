// The triangles of the Stanford bunny: a surface, where boxes are many in space but few on a line through it.
#include "lab/formats/descriptions.hpp"
#include "lab/scenes/data_file.hpp"
#include "lab/scenes/descriptions.hpp"

namespace broadside::lab::generated {

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

}  // namespace broadside::lab::generated

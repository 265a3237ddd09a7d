// What stands in for the reader of meshes where assimp was missing at configure time.
#include <algorithm>

#include "lab/readers/descriptions.hpp"

namespace broadside::lab::readers {

Format mesh() {
  const std::vector<std::string> extensions = {".obj",  ".ply", ".stl", ".off",
                                               ".gltf", ".glb", ".dae", ".3ds"};
  return {
      .name = "mesh",
      .summary = "the triangles of a mesh; seen along the z axis in 2D",
      .extensions = extensions,
      .is_seen_flat = true,
      .recognises =
          [extensions](std::string_view, std::string_view extension) {
            return std::ranges::find(extensions, extension) != extensions.end();
          },
      .missing = "libassimp-dev was missing at configure time; install it and configure again",
  };
}

}  // namespace broadside::lab::readers

// What stands in for the import of meshes where assimp was missing at configure time.
#include <algorithm>
#include <array>

#include "lab/formats/format.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"

namespace broadside::lab {

IndexedMesh import_mesh(Input& input) { throw FileError(input.name() + ": " + mesh_import_missing()); }

std::string mesh_import_missing() {
  return "libassimp-dev was missing at configure time; install it and configure again";
}

bool is_mesh_extension(std::string_view extension) {
  constexpr std::array<std::string_view, 8> extensions = {".ply",  ".obj", ".stl", ".off",
                                                          ".gltf", ".glb", ".dae", ".3ds"};
  return std::ranges::find(extensions, extension) != extensions.end();
}

}  // namespace broadside::lab

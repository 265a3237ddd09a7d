// Fuzzes the reader of PLY.
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "lab/formats/mesh/indexed_mesh.hpp"
#include "tests/fuzz/mesh_body.hpp"

namespace broadside::lab {
namespace {

std::string written(const IndexedMesh& mesh) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                     "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                     std::to_string(mesh.face_count()) +
                     "\nproperty list uint uint vertex_indices\nend_header\n";
  for (const auto& vertex : mesh.vertices) {
    for (const double coordinate : vertex) text += fmt::format("{} ", coordinate);
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    text += std::to_string(mesh.face(f).size());
    for (const std::uint32_t corner : mesh.face(f)) text += " " + std::to_string(corner);
    text += '\n';
  }
  return text;
}

}  // namespace
}  // namespace broadside::lab

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadside::lab::mesh_fuzzing::check_mesh({reinterpret_cast<const char*>(data), size},
                                           broadside::lab::read_ply, broadside::lab::written);
  return 0;
}

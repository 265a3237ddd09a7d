// Fuzzes the reader of PLY: whatever the bytes, it reads or refuses them, and a mesh that it reads can be
// written and read again.
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "lab/readers/format.hpp"
#include "lab/readers/mesh_elements.hpp"
#include "lab/readers/ply.hpp"

namespace broadside::lab {
namespace {

/// Ends the program, which is how a fuzzer learns of a fault.
void expect(bool holds) {
  if (!holds) std::abort();
}

std::optional<IndexedMesh> read(std::string_view bytes) {
  try {
    Input input("fuzz", bytes);
    return read_ply(input);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

std::string written(const IndexedMesh& mesh) {
  std::string text = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(mesh.vertices.size()) +
                     "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
                     std::to_string(mesh.face_count()) +
                     "\nproperty list uint uint vertex_indices\nend_header\n";
  for (const auto& vertex : mesh.vertices) {
    for (const float coordinate : vertex) text += fmt::format("{} ", coordinate);
  }
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    text += std::to_string(mesh.face(f).size());
    for (const std::uint32_t corner : mesh.face(f)) text += " " + std::to_string(corner);
    text += '\n';
  }
  return text;
}

void check(std::string_view bytes) {
  const auto mesh = read(bytes);
  if (!mesh) return;
  // What is in memory is paid for in bytes.
  expect(3 * mesh->vertices.size() + mesh->corners.size() + mesh->face_count() <= bytes.size());
  const auto again = read(written(*mesh));
  expect(again.has_value() && again->corners == mesh->corners && again->face_ends == mesh->face_ends);
  bool is_finite = true;
  try {
    const auto vertices = MeshElements(*mesh, MeshPart::vertices).boxes(*mesh, "fuzz");
    expect(vertices == MeshElements(*again, MeshPart::vertices).boxes(*again, "fuzz"));
  } catch (const FileError&) {
    is_finite = false;
  }
  if (!is_finite) return;
  IndexedMesh triangles = *mesh;
  triangulate(triangles);
  expect(triangles.face_count() + 2 * mesh->face_count() == mesh->corners.size());
  const auto edges = MeshElements(*mesh, MeshPart::edges).boxes(*mesh, "fuzz");
  const auto faces = MeshElements(triangles, MeshPart::faces).boxes(triangles, "fuzz");
  expect(edges.size() <= mesh->corners.size() && faces.size() == triangles.face_count());
}

}  // namespace
}  // namespace broadside::lab

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadside::lab::check({reinterpret_cast<const char*>(data), size});
  return 0;
}

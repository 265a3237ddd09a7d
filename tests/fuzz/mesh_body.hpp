// What the fuzzers of meshes have in common: whatever the bytes, they are read or refused, and a mesh that
// was read can be written and read again.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <optional>
#include <string>
#include <string_view>

#include "lab/formats/format.hpp"
#include "lab/formats/mesh/elements.hpp"

namespace broadside::lab::mesh_fuzzing {

/// Ends the program, which is how a fuzzer learns of a fault.
inline void expect(bool holds) {
  if (!holds) std::abort();
}

using ReadMesh = IndexedMesh (*)(Input&);
using WriteMesh = std::string (*)(const IndexedMesh&);

inline std::optional<IndexedMesh> read(ReadMesh read_one, std::string_view bytes) {
  try {
    Input input("fuzz", bytes);
    return read_one(input);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

inline void check_mesh(std::string_view bytes, ReadMesh read_one, WriteMesh written) {
  const auto mesh = read(read_one, bytes);
  if (!mesh) return;
  // What is in memory is paid for in bytes.
  expect(3 * mesh->vertices.size() + mesh->corners.size() + mesh->face_count() <= bytes.size());
  const auto again = read(read_one, written(*mesh));
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

}  // namespace broadside::lab::mesh_fuzzing

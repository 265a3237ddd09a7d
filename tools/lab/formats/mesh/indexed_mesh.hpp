// Indexed meshes, and the readers of their formats.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/formats/frames.hpp"
#include "lab/formats/input.hpp"

namespace broadside::lab {

/// Vertices, and faces that name three or more vertices by index.
struct IndexedMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::uint32_t> corners;  ///< the vertices of all faces, face after face
  std::vector<std::size_t> face_ends;  ///< where each face ends in `corners`
  std::size_t other_elements = 0;      ///< the number of lines and points, which are left out
  bool has_own_vertices = false;       ///< whether the vertices are those of the file, in its order
  /// The type of the file's coordinates; floats are also stored exactly.
  Precision precision = Precision::float64;
  /// The library that read the file, if it may have rounded the file's numbers to float; otherwise empty.
  std::string_view importer{};

  std::size_t face_count() const noexcept { return face_ends.size(); }

  std::span<const std::uint32_t> face(std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : face_ends[i - 1];
    return std::span(corners).subspan(begin, face_ends[i] - begin);
  }
};

/// Reads a mesh: PLY by read_ply(), OBJ by read_obj(), other formats by import_mesh(). Throws FileError.
IndexedMesh read_mesh(Input& input);

/// Reads a mesh through assimp, which stores floats: all parts of the file's scene, transformed to their
/// place, one after the other. Lines and points are not faces. Throws FileError, also if a face names a
/// vertex that does not exist.
///
/// For OFF, the vertices are the file's own. For other formats, assimp gives each face (or each part) its own
/// vertices; see weld().
IndexedMesh import_mesh(Input& input);

/// The library that import_mesh() lacks in this build, and how to get it; empty if it works.
std::string mesh_import_missing();

/// Whether import_mesh() reads files with this extension.
bool is_mesh_extension(std::string_view extension);

/// Merges vertices at the same position, unless they are the file's own, and numbers them in the order of
/// their first occurrence. `later` is nullptr or the same mesh at another time, with the same number of
/// vertices and the same faces: vertices are merged if they coincide at both times.
void weld(IndexedMesh& mesh, IndexedMesh* later = nullptr);

/// Splits each polygon into a fan of triangles around its first corner.
void triangulate(IndexedMesh& mesh);

/// The edges of all faces, each once whatever its direction: the lower vertex first, sorted.
std::vector<std::array<std::uint32_t, 2>> edges_of(const IndexedMesh& mesh);

/// "ply", "obj", "stl" (as text), "glb", "gltf" or "off"; empty if a file's first bytes do not show it.
/// Binary STL can begin with any bytes.
std::string_view mesh_content(std::string_view beginning);

/// Reads an OBJ file: its "v" lines as vertices, in double, and its "f" lines as faces; ignores all others.
/// Vertices are numbered from 0. Throws FileError with the line.
IndexedMesh read_obj(Input& input);

/// Reads a PLY file, as text or in binary of either byte order: x, y and z of the element "vertex", exactly,
/// and the list "vertex_indices" (or "vertex_index") of the element "face"; ignores all else. The mesh is of
/// floats if the header declares x, y and z so, and of doubles otherwise. Throws FileError with the line of
/// the header, or the byte.
IndexedMesh read_ply(Input& input);

}  // namespace broadside::lab

// Meshes as vertices and faces by index, and the readers of the formats that hold them.
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

/// Vertices, and faces of three vertices or more that name them by their places.
struct IndexedMesh {
  std::vector<std::array<double, 3>> vertices;
  std::vector<std::uint32_t> corners;  ///< the vertices of the faces, one face after the other
  std::vector<std::size_t> face_ends;  ///< where each face ends in `corners`
  std::size_t other_elements = 0;      ///< lines and points, which are left out
  bool has_own_vertices = false;       ///< whether the vertices are those of the file, in its order
  /// The type of the file's coordinates; floats are held exactly as well.
  Precision precision = Precision::float64;
  /// The library that read the file, where it may have rounded the file's numbers to float; empty otherwise.
  std::string_view importer{};

  std::size_t face_count() const noexcept { return face_ends.size(); }

  std::span<const std::uint32_t> face(std::size_t i) const {
    const std::size_t begin = i == 0 ? 0 : face_ends[i - 1];
    return std::span(corners).subspan(begin, face_ends[i] - begin);
  }
};

/// Reads a mesh: PLY by read_ply(), OBJ by read_obj(), other formats by import_mesh(). Throws FileError.
IndexedMesh read_mesh(Input& input);

/// Reads a mesh through assimp, which keeps floats: all parts of the file's scene, put where they are in it,
/// one after the other. Lines and points are no faces. Throws FileError, also if a face names a vertex that
/// is not there.
///
/// In OFF the vertices are the file's own. Of other formats assimp gives each face (or each part) vertices of
/// its own; see weld().
IndexedMesh import_mesh(Input& input);

/// What is missing in this build for import_mesh() and how to get it; empty where it works.
std::string mesh_import_missing();

/// Whether a file with this extension is a mesh for import_mesh().
bool is_mesh_extension(std::string_view extension);

/// Makes vertices in one and the same place one, unless they are the file's own; each is then numbered where
/// it came first. `later` is nullptr or the same mesh at another time, with as many vertices and the same
/// faces: vertices become one if they are in the same place at both times.
void weld(IndexedMesh& mesh, IndexedMesh* later = nullptr);

/// Makes each polygon a fan of triangles around its first corner.
void triangulate(IndexedMesh& mesh);

/// The sides of all faces, each once whichever way around it is named: the lower vertex first, in order.
std::vector<std::array<std::uint32_t, 2>> edges_of(const IndexedMesh& mesh);

/// "ply", "obj", "stl" (as text), "glb", "gltf" or "off"; empty if the first bytes of a file do not say.
/// STL in binary begins with anything.
std::string_view mesh_content(std::string_view beginning);

/// Reads an OBJ file: its lines "v" as vertices, as doubles, and its lines "f" as faces; all else is passed
/// over. Vertices are numbered from 0. Throws FileError, naming the line.
IndexedMesh read_obj(Input& input);

/// Reads a PLY file, as text or in binary of either byte order: x, y and z of the element "vertex", exactly,
/// and the list "vertex_indices" (or "vertex_index") of the element "face"; all else is passed over. The mesh
/// is of floats if the header says so of x, y and z, and of doubles otherwise. Throws FileError, naming the
/// line of the header, or the byte.
IndexedMesh read_ply(Input& input);

}  // namespace broadside::lab

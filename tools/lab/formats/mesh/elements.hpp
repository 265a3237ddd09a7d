// The vertices, edges or faces of a mesh, and their bounds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/box.hpp"

#include "lab/formats/mesh/indexed_mesh.hpp"

namespace broadside::lab {

/// The kinds of elements of a mesh.
enum class MeshPart : std::uint8_t { vertices, edges, faces };

/// "vertices", "edges" or "faces".
std::string_view name(MeshPart part) noexcept;

/// All elements of one kind, each with the list of its vertices. Vertices and faces are in the mesh's order,
/// edges in that of edges_of().
class MeshElements {
 public:
  MeshElements(const IndexedMesh& mesh, MeshPart part);

  std::size_t size() const noexcept { return ends_.size(); }

  /// The indices of the element's vertices.
  std::span<const std::uint32_t> vertices(std::size_t element) const {
    const std::size_t begin = element == 0 ? 0 : ends_[element - 1];
    return std::span(vertices_).subspan(begin, ends_[element] - begin);
  }

  /// The bounds of each element, with vertex positions from `mesh`. Throws FileError, naming the mesh's file,
  /// if an element has coordinates that are not finite.
  std::vector<DoubleBox3> boxes(const IndexedMesh& mesh, const std::string& file) const;

 private:
  MeshPart part_;
  std::vector<std::uint32_t> vertices_;
  std::vector<std::size_t> ends_;
};

/// Whether two elements, given their vertices, have a vertex in common.
bool share_vertex(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b);

}  // namespace broadside::lab

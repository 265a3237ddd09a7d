// The vertices, edges or faces of a mesh, and their bounds.
#include "lab/formats/mesh/elements.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "lab/formats/format.hpp"

namespace broadside::lab {

std::string_view name(MeshPart part) noexcept {
  constexpr std::array<std::string_view, 3> names = {"vertices", "edges", "faces"};
  return names[static_cast<std::size_t>(part)];
}

MeshElements::MeshElements(const IndexedMesh& mesh, MeshPart part) : part_(part) {
  switch (part) {
    case MeshPart::vertices:
      vertices_.resize(mesh.vertices.size());
      std::iota(vertices_.begin(), vertices_.end(), 0);
      ends_.resize(mesh.vertices.size());
      std::iota(ends_.begin(), ends_.end(), 1);
      break;
    case MeshPart::edges:
      for (const auto& [low, high] : edges_of(mesh)) {
        vertices_.insert(vertices_.end(), {low, high});
        ends_.push_back(vertices_.size());
      }
      break;
    case MeshPart::faces:
      vertices_ = mesh.corners;
      ends_ = mesh.face_ends;
      break;
  }
}

std::vector<DoubleBox3> MeshElements::boxes(const IndexedMesh& mesh, const std::string& file) const {
  std::vector<DoubleBox3> boxes;
  boxes.reserve(size());
  for (std::size_t element = 0; element < size(); ++element) {
    DoubleBox3 box = absent_box<3, double>();
    for (const std::uint32_t vertex : vertices(element)) {
      const std::array<double, 3>& place = mesh.vertices[vertex];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(place[axis])) {
          constexpr std::array<std::string_view, 3> singular = {"vertex", "edge", "face"};
          throw FileError(fmt::format("{}: {} {} has a vertex at ({}); expected finite numbers", file,
                                      singular[static_cast<std::size_t>(part_)], element,
                                      fmt::join(place, ", ")));
        }
        box.min[axis] = std::min(box.min[axis], place[axis]);
        box.max[axis] = std::max(box.max[axis], place[axis]);
      }
    }
    boxes.push_back(box);
  }
  return boxes;
}

bool share_vertex(std::span<const std::uint32_t> a, std::span<const std::uint32_t> b) {
  return std::any_of(a.begin(), a.end(),
                     [&](std::uint32_t v) { return std::find(b.begin(), b.end(), v) != b.end(); });
}

}  // namespace broadside::lab

// Meshes (PLY, OBJ, STL, glTF and what else assimp reads): the bounds of their triangles, edges or vertices.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/readers/descriptions.hpp"
#include "lab/readers/indexed_mesh.hpp"
#include "lab/readers/mesh_content.hpp"
#include "lab/readers/mesh_elements.hpp"

namespace broadside::lab::readers {
namespace {

/// The boxes of a mesh, and what was lost where its coordinates became floats.
class MeshFrames final : public FrameReader<3, float> {
 public:
  MeshFrames(std::vector<Box3> boxes, std::string warning)
      : boxes_(std::move(boxes)), warning_(std::move(warning)) {}

  std::vector<Box3> first() override { return std::move(boxes_); }
  bool next(Step<3>&) override { return false; }
  std::string warning() const override { return warning_; }

 private:
  std::vector<Box3> boxes_;
  std::string warning_;
};

AnyFrameReader open(std::unique_ptr<Input> input, const ReadOptions& options) {
  const std::string part = options.boxes.empty() ? "triangles" : options.boxes;
  const bool are_triangles = part == "triangles";
  IndexedMesh mesh = read_mesh(*input);
  if (are_triangles)
    triangulate(mesh);
  else
    weld(mesh);
  const MeshElements elements(mesh, are_triangles     ? MeshPart::faces
                                    : part == "edges" ? MeshPart::edges
                                                      : MeshPart::vertices);
  if (elements.size() == 0)
    throw FileError(fmt::format("{}: has no {}; expected at least one", input->name(), part));
  std::string warning = rounding_of(mesh, input->name());
  if (warning.empty() && options.precision == Precision::float64)
    warning = fmt::format("{}: meshes are read in float; as doubles, its coordinates are those floats",
                          input->name());
  return std::make_unique<MeshFrames>(elements.boxes(mesh, input->name()), std::move(warning));
}

}  // namespace

Format mesh() {
  // Without assimp, PLY and OBJ are still read.
  const std::string missing = mesh_import_missing();
  return {
      .name = "mesh",
      .summary = missing.empty() ? "triangle meshes; seen along the z axis in 2D"
                                 : "triangle meshes in PLY and OBJ; for others, " + missing,
      .extensions = {".ply", ".obj", ".stl", ".off", ".gltf", ".glb", ".dae", ".3ds"},
      .parts = {{"triangles", "a box a triangle; a polygon is a fan of them"},
                {"edges", "a box a side of a triangle or polygon, each side once"},
                {"vertices", "a box without extent a vertex"}},
      .is_seen_flat = true,
      .recognises =
          [](std::string_view bytes, std::string_view extension) {
            return !mesh_content(bytes).empty() || is_mesh_extension(extension);
          },
      .open = open,
  };
}

}  // namespace broadside::lab::readers

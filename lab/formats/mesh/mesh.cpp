// Meshes (PLY, OBJ, STL, glTF and what else assimp reads): the bounds of their triangles, edges or vertices.
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/descriptions.hpp"
#include "lab/formats/mesh/elements.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"

namespace broadside::lab::readers {
namespace {

/// The boxes of a mesh.
class MeshFrames final : public FrameReader<3, double> {
 public:
  MeshFrames(std::vector<DoubleBox3> boxes, std::string_view importer)
      : boxes_(std::move(boxes)), importer_(importer) {}

  std::vector<DoubleBox3> first() override { return std::move(boxes_); }
  bool next(Step<3, double>&) override { return false; }
  std::string_view importer() const override { return importer_; }

 private:
  std::vector<DoubleBox3> boxes_;
  std::string_view importer_;
};

AnyFrameReader open_mesh(std::unique_ptr<Input> input, const ReadOptions& options) {
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
  return with_precision(std::make_unique<MeshFrames>(elements.boxes(mesh, input->name()), mesh.importer),
                        mesh.precision);
}

}  // namespace

Format mesh() {
  // Without assimp, PLY and OBJ are still read.
  const std::string missing = mesh_import_missing();
  return {
      .name = "mesh",
      .summary = missing.empty() ? "triangle meshes, in the file's precision in PLY and OBJ and in float in "
                                   "others; seen along the z axis in 2D"
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
      .open = open_mesh,
  };
}

}  // namespace broadside::lab::readers

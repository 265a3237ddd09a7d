// Meshes (PLY, OBJ, STL, glTF and assimp's other formats) as boxes: the bounds of their triangles, edges or
// vertices.
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "lab/formats/mesh/elements.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"
#include "lab/formats/registry.hpp"
#include "lab/numbers.hpp"

namespace broadside::lab::readers {
namespace {

/// The boxes of a mesh.
class MeshFrames final : public FrameReader<3, double> {
 public:
  MeshFrames(std::vector<DoubleBox3> boxes, std::string_view importer, std::string warning)
      : boxes_(std::move(boxes)), importer_(importer), warning_(std::move(warning)) {}

  std::vector<DoubleBox3> first() override { return std::move(boxes_); }
  bool next(Step<3, double>&) override { return false; }
  std::string_view importer() const override { return importer_; }
  std::string warning() const override { return warning_; }

 private:
  std::vector<DoubleBox3> boxes_;
  std::string_view importer_;
  std::string warning_;
};

AnyFrameReader open_mesh(std::unique_ptr<Input> input, const ReadOptions& options) {
  IndexedMesh mesh = read_mesh(*input);
  // A mesh of only vertices is a point cloud.
  const bool is_cloud = mesh.face_count() == 0 && mesh.other_elements == 0 && !mesh.vertices.empty();
  const std::string part = !options.boxes.empty() ? options.boxes : is_cloud ? "vertices" : "triangles";
  const bool are_triangles = part == "triangles";
  if (are_triangles)
    triangulate(mesh);
  else
    weld(mesh);
  const MeshElements elements(mesh, are_triangles     ? MeshPart::faces
                                    : part == "edges" ? MeshPart::edges
                                                      : MeshPart::vertices);
  if (elements.size() == 0)
    throw FileError(fmt::format("{}: has no {}, but {} and {}; expected at least one{}", input->name(), part,
                                counted(mesh.vertices.size(), "vertex", "vertices"),
                                counted(mesh.other_elements, "line or point", "lines or points"),
                                mesh.vertices.empty() ? "" : ", or --boxes vertices"));
  std::string warning;
  if (is_cloud && options.boxes.empty())
    warning = fmt::format("{}: has no faces: its {} read as points", input->name(),
                          mesh.vertices.size() == 1 ? "vertex is" : "vertices are");
  return with_precision(
      std::make_unique<MeshFrames>(elements.boxes(mesh, input->name()), mesh.importer, std::move(warning)),
      mesh.precision);
}

}  // namespace

Format mesh() {
  // Without assimp, PLY and OBJ can still be read.
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

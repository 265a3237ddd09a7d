// Triangle meshes (PLY, OBJ, STL and what else assimp reads): the bounds of their triangles.
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "lab/readers/descriptions.hpp"

namespace broadside::lab::readers {
namespace {

/// The bounds of a triangle; empty if a coordinate is not finite.
std::optional<Box3> bounds_of(const aiMesh& mesh, const aiFace& triangle) {
  Box3 box = absent_box<3>();
  for (unsigned corner = 0; corner < 3; ++corner) {
    const aiVector3D& point = mesh.mVertices[triangle.mIndices[corner]];
    for (unsigned axis = 0; axis < 3; ++axis) {
      if (!std::isfinite(point[axis])) return std::nullopt;
      box.min[axis] = std::min(box.min[axis], point[axis]);
      box.max[axis] = std::max(box.max[axis], point[axis]);
    }
  }
  return box;
}

AnyFrameReader open(std::unique_ptr<Input> input, const ReadOptions&) {
  // Parts are put where the file's scene has them; lines and points have no triangles.
  constexpr unsigned steps = aiProcess_Triangulate | aiProcess_PreTransformVertices;
  Assimp::Importer importer;
  const aiScene* scene = nullptr;
  try {
    // A file may name others beside it; what comes through a pipe cannot.
    if (!input->path().empty()) {
      scene = importer.ReadFile(input->path().string(), steps);
    } else {
      const std::string_view bytes = input->bytes();
      scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), steps);
    }
  } catch (const std::exception& error) {
    throw FileError(fmt::format("{}: {}; expected a mesh", input->name(), error.what()));
  }
  if (scene == nullptr)
    throw FileError(fmt::format("{}: {}; expected a mesh", input->name(), importer.GetErrorString()));

  History<3> history;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      if (mesh.mFaces[f].mNumIndices != 3) continue;
      const std::optional<Box3> box = bounds_of(mesh, mesh.mFaces[f]);
      if (!box) {
        throw FileError(fmt::format("{}: triangle {} has a corner that is not finite; expected numbers",
                                    input->name(), history.boxes.size()));
      }
      history.boxes.push_back(*box);
    }
  }
  if (history.boxes.empty())
    throw FileError(fmt::format("{}: has no triangles; expected at least one", input->name()));
  return std::make_unique<HistoryReader<3, float>>(std::move(history));
}

}  // namespace

Format mesh() {
  return {
      .name = "mesh",
      .summary = "the triangles of a mesh; seen along the z axis in 2D",
      .extensions = {".obj", ".ply", ".stl", ".off", ".gltf", ".glb", ".dae", ".3ds"},
      .is_seen_flat = true,
      .recognises =
          [](std::string_view, std::string_view extension) {
            return !extension.empty() && Assimp::Importer().IsExtensionSupported(std::string(extension));
          },
      .open = open,
  };
}

}  // namespace broadside::lab::readers

// Imports meshes through assimp: STL, glTF and its other formats.
//
// assimp's parsers are third-party code. Their exceptions are caught, but they may crash on malformed files.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <exception>
#include <limits>
#include <new>
#include <string_view>
#include <system_error>
#include <utility>

#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "lab/formats/format.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"
#include "lab/formats/text.hpp"

namespace broadside::lab {
namespace {

[[noreturn]] void refuse(const Input& input, std::string_view found, std::string_view expected = "a mesh") {
  throw FileError(fmt::format("{}: {}; expected {}", input.name(), found, expected));
}

/// Refuses a file with assimp's reason.
[[noreturn]] void refuse_import(const Input& input, std::string_view reason) {
  // assimp's name for a file read from memory, if it was not told the format.
  if (reason.empty() || reason.find("$$$") != std::string_view::npos)
    refuse(input, "is a mesh of a kind that its first bytes do not tell, as STL in binary is",
           "a file with the extension of its kind");
  while (reason.ends_with('.') || reason.ends_with(' ') || reason.ends_with('\n')) reason.remove_suffix(1);
  refuse(input, fmt::format("cannot be read: {}", plainly(reason)));
}

/// assimp allocates memory for the counts that an OFF file claims: its first numbers are those of vertices
/// and faces.
void check_off_counts(Input& input) {
  std::string_view rest = input.bytes();
  const std::size_t bytes = rest.size();
  int counts = 0;
  while (counts < 2 && !rest.empty()) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    line = line.substr(0, line.find_first_of("#\r"));
    for (std::string_view word = next_word(line); counts < 2 && !word.empty(); word = next_word(line)) {
      std::uint64_t count = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), count);
      if (end != word.data() + word.size()) continue;  // the word OFF, or a similar one
      if (error != std::errc() || count > bytes)
        refuse(input, fmt::format("claims {} vertices or faces and has {} bytes", word, bytes),
               "no more than there is room for");
      ++counts;
    }
  }
}

/// assimp does not check the vertex indices in a file.
void check_corners(const Input& input, const aiScene& scene) {
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      for (unsigned i = 0; i < face.mNumIndices; ++i) {
        if (face.mIndices[i] < mesh.mNumVertices) continue;
        throw FileError(fmt::format("{}: face {} names the vertex {}; expected one below {}", input.name(), f,
                                    face.mIndices[i], mesh.mNumVertices));
      }
    }
  }
}

/// Merges the meshes of a scene into one, each transformed by its node.
class SceneCollector {
 public:
  SceneCollector(const Input& input, const aiScene& scene) : input_(input), scene_(scene) {}

  IndexedMesh collect() {
    // Not recursive, because the file determines how deeply nodes are nested.
    std::vector<std::pair<const aiNode*, aiMatrix4x4>> nodes = {{scene_.mRootNode, aiMatrix4x4()}};
    while (!nodes.empty()) {
      const auto [node, parent] = nodes.back();
      nodes.pop_back();
      const aiMatrix4x4 place = parent * node->mTransformation;
      for (unsigned m = 0; m < node->mNumMeshes; ++m) add(*scene_.mMeshes[node->mMeshes[m]], place);
      for (unsigned c = node->mNumChildren; c-- > 0;) nodes.emplace_back(node->mChildren[c], place);
    }
    return std::move(mesh_);
  }

 private:
  void add(const aiMesh& mesh, const aiMatrix4x4& place) {
    const std::size_t first = mesh_.vertices.size();
    if (mesh.mNumVertices > std::numeric_limits<std::uint32_t>::max() - first)
      refuse(input_, "has more vertices than 32 bits can count");
    // Multiplying an infinity by the identity would give NaN.
    const bool is_in_place = place == aiMatrix4x4();
    for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
      const aiVector3D point = is_in_place ? mesh.mVertices[v] : place * mesh.mVertices[v];
      mesh_.vertices.push_back({point.x, point.y, point.z});
    }
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices < 3) {
        ++mesh_.other_elements;
        continue;
      }
      for (unsigned i = 0; i < face.mNumIndices; ++i)
        mesh_.corners.push_back(static_cast<std::uint32_t>(first + face.mIndices[i]));
      mesh_.face_ends.push_back(mesh_.corners.size());
    }
  }

  const Input& input_;
  const aiScene& scene_;
  IndexedMesh mesh_;
};

}  // namespace

IndexedMesh import_mesh(Input& input) {
  if (input.beginning().empty()) refuse(input, "is empty");
  Assimp::Importer importer;
  const std::string_view content = mesh_content(input.beginning());
  const std::string extension = input.extension();
  const bool is_named = !extension.empty() && importer.IsExtensionSupported(extension);
  const aiScene* scene = nullptr;
  // A file may reference others beside it; an input from a pipe, or under another name, cannot.
  const bool is_opened_by_name = is_named && !input.path().empty();
  if (content == "off" || (content.empty() && extension == ".off")) check_off_counts(input);
  const std::string_view bytes = is_opened_by_name ? std::string_view() : input.bytes();
  try {
    if (is_opened_by_name) {
      scene = importer.ReadFile(input.path().string(), 0);
    } else {
      // The name of a compressed file may still show the format.
      const std::string kind = content.empty() && is_named ? extension.substr(1) : std::string(content);
      scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), 0, kind.c_str());
    }
    if (scene == nullptr) refuse_import(input, importer.GetErrorString());
    check_corners(input, *scene);
  } catch (const FileError&) {
    throw;
  } catch (const std::bad_alloc&) {
    refuse(input, "needs more memory than there is", "a mesh that holds no less than it claims to");
  } catch (const std::exception& error) {
    refuse_import(input, error.what());
  }
  if (scene->mRootNode == nullptr) refuse_import(input, importer.GetErrorString());
  IndexedMesh mesh = SceneCollector(input, *scene).collect();
  mesh.has_own_vertices = content == "off";
  mesh.precision = Precision::float32;
  mesh.importer = "assimp";
  return mesh;
}

std::string mesh_import_missing() { return {}; }

bool is_mesh_extension(std::string_view extension) {
  return !extension.empty() && Assimp::Importer().IsExtensionSupported(std::string(extension));
}

}  // namespace broadside::lab

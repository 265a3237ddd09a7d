// Stand-ins for files whose library was missing at configure time. CMakeLists.txt defines BROADSIDE_HAS_...
// as 1 or 0 for each library.
#include <algorithm>
#include <array>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lab/formats/byte_source.hpp"
#include "lab/formats/format.hpp"
#include "lab/formats/mesh/indexed_mesh.hpp"
#include "lab/formats/registry.hpp"
#include "lab/formats/zip_archive.hpp"
#include "lab/recordings/recordings.hpp"
#include "lab/report/page.hpp"

namespace broadside::lab {
namespace {

[[maybe_unused]] std::string missing(std::string_view package) {
  return std::string(package) + " was missing at configure time; install it and configure again";
}

[[maybe_unused]] std::vector<Scene> missing_recordings(std::initializer_list<const char*> names,
                                                       const char* engine, std::string_view package) {
  std::vector<Scene> scenes;
  for (const char* const name : names)
    scenes.push_back({.name = name,
                      .summary = "",
                      .source = engine,
                      .kind = SceneKind::recorded,
                      .missing = missing(package)});
  return scenes;
}

}  // namespace

#if !BROADSIDE_HAS_ZLIB
std::unique_ptr<Decompressor> gzip_decompressor(const std::string& name) {
  throw FileError(name + ": is compressed by gzip, and " + missing("zlib1g-dev") +
                  ", or decompress the file first: gunzip");
}
#endif

#if !BROADSIDE_HAS_ZSTD
std::unique_ptr<Decompressor> zstd_decompressor(const std::string& name) {
  throw FileError(name + ": is compressed by zstd, and " + missing("libzstd-dev") +
                  ", or decompress the file first: unzstd");
}
#endif

#if !BROADSIDE_HAS_LIBZIP
ZipArchive::ZipArchive(std::string_view, std::string name) : name_(std::move(name)) { refuse(zip_missing()); }

std::string ZipArchive::read(std::size_t) const { refuse(zip_missing()); }

void ZipArchive::refuse(std::string_view found) const { throw FileError(name_ + ": " + std::string(found)); }

std::string zip_missing() { return missing("libzip-dev"); }
#endif

#if !BROADSIDE_HAS_ASSIMP
IndexedMesh import_mesh(Input& input) { throw FileError(input.name() + ": " + mesh_import_missing()); }

std::string mesh_import_missing() { return missing("libassimp-dev"); }

bool is_mesh_extension(std::string_view extension) {
  constexpr std::array<std::string_view, 8> extensions = {".ply",  ".obj", ".stl", ".off",
                                                          ".gltf", ".glb", ".dae", ".3ds"};
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}
#endif

#if !BROADSIDE_HAS_BOX2D
std::vector<Scene> recordings::box2d() {
  return missing_recordings({"box2d_rain", "box2d_tumbler", "box2d_pyramid"}, "Box2D", "libbox2d-dev");
}
#endif

#if !BROADSIDE_HAS_BULLET
std::vector<Scene> recordings::bullet() {
  return missing_recordings({"bullet_free_fall", "bullet_brownian", "bullet_moving_gravity"}, "Bullet",
                            "libbullet-dev");
}
#endif

#if !BROADSIDE_HAS_PAGE
PageTemplate page_template() { return {}; }
#endif

}  // namespace broadside::lab

// Fuzzes the reader of OBJ.
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "lab/formats/mesh/indexed_mesh.hpp"
#include "tests/fuzz/mesh_body.hpp"

namespace broadside::lab {
namespace {

std::string written(const IndexedMesh& mesh) {
  std::string text;
  for (const auto& vertex : mesh.vertices) text += fmt::format("v {}\n", fmt::join(vertex, " "));
  for (std::size_t f = 0; f < mesh.face_count(); ++f) {
    text += 'f';
    for (const std::uint32_t corner : mesh.face(f)) text += " " + std::to_string(std::uint64_t{corner} + 1);
    text += '\n';
  }
  return text;
}

}  // namespace
}  // namespace broadside::lab

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  broadside::lab::mesh_fuzzing::check_mesh({reinterpret_cast<const char*>(data), size},
                                           broadside::lab::read_obj, broadside::lab::written);
  return 0;
}

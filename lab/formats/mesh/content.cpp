// What kind of mesh some bytes are: by their first words.
#include "lab/formats/mesh/content.hpp"

#include <algorithm>
#include <array>

namespace broadside::lab {
namespace {

/// Whether the first line that is neither empty nor a comment begins as lines of OBJ do.
bool begins_as_obj(std::string_view text) {
  constexpr std::string_view blanks = " \t\r";
  while (!text.empty()) {
    std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
    if (line.empty() || line.starts_with('#')) continue;
    constexpr std::array<std::string_view, 8> words = {"v", "vn", "vt", "f", "o", "g", "mtllib", "usemtl"};
    const std::size_t end = line.find_first_of(blanks);
    return end != std::string_view::npos && std::ranges::find(words, line.substr(0, end)) != words.end();
  }
  return false;
}

}  // namespace

std::string_view mesh_content(std::string_view beginning) {
  if (beginning.starts_with("ply\n") || beginning.starts_with("ply\r")) return "ply";
  if (beginning.starts_with("glTF")) return "glb";
  if (beginning.starts_with("solid ")) return "stl";
  if (beginning.starts_with("OFF\n") || beginning.starts_with("OFF\r")) return "off";
  const std::size_t first = std::min(beginning.find_first_not_of(" \t\r\n"), beginning.size());
  if (beginning.substr(first).starts_with('{') && beginning.find("\"asset\"") != std::string_view::npos)
    return "gltf";
  return begins_as_obj(beginning) ? "obj" : "";
}

}  // namespace broadside::lab

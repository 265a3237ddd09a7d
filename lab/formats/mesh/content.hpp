// What kind of mesh some bytes are, told from how they begin.
#pragma once

#include <string_view>

namespace broadside::lab {

/// "ply", "obj", "stl" (as text), "glb", "gltf" or "off"; empty if the first bytes of a file do not say.
/// STL in binary begins with anything.
std::string_view mesh_content(std::string_view beginning);

}  // namespace broadside::lab

// What the header of a PLY file claims, held against the bytes that are there.
#pragma once

#include <string>
#include <string_view>

namespace broadside::lab {

/// Throws FileError if `bytes` begin as a PLY file and its header claims more elements than they can hold;
/// assimp would make room for as many as are claimed. `name` is what errors call the file. What else is wrong
/// is left for assimp to say.
void check_ply_claims(std::string_view bytes, const std::string& name);

}  // namespace broadside::lab

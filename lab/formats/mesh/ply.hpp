// PLY, the Stanford triangle format, read with the vertices and faces as the file numbers them.
#pragma once

#include "lab/formats/mesh/indexed_mesh.hpp"

namespace broadside::lab {

/// Reads a PLY file, as text or in binary of either byte order: x, y and z of the element "vertex", exactly,
/// and the list "vertex_indices" (or "vertex_index") of the element "face"; all else is passed over. The mesh
/// is of floats if the header says so of x, y and z, and of doubles otherwise. Throws FileError, naming the
/// line of the header, or the byte.
IndexedMesh read_ply(Input& input);

}  // namespace broadside::lab

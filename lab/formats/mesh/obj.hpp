// OBJ, the format of Wavefront, read with the vertices and faces as the file numbers them.
#pragma once

#include "lab/formats/mesh/indexed_mesh.hpp"

namespace broadside::lab {

/// Reads an OBJ file: its lines "v" as vertices, as doubles, and its lines "f" as faces; all else is passed
/// over. Vertices are numbered from 0. Throws FileError, naming the line.
IndexedMesh read_obj(Input& input);

}  // namespace broadside::lab

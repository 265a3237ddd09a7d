// Writes boxes as a table.
#pragma once

#include <ostream>

#include "lab/formats/frames.hpp"

namespace broadside::lab::readers {

/// Begins a table in a stream. A single frame becomes plain columns of bounds; with more frames, the columns
/// frame and box precede them. Numbers are the shortest that read back as a double of the same value, floats
/// too: so the boxes are the same in either precision.
AnyFrameWriter write_csv(std::ostream& stream, int dimension, Precision precision);

}  // namespace broadside::lab::readers

// Writes boxes as a table.
#pragma once

#include <ostream>

#include "lab/formats/frames.hpp"

namespace broadside::lab::readers {

/// Begins a table in a stream. One frame becomes plain columns of bounds; with more, the columns frame and
/// box are before them. Numbers are as short as makes a double of them that has the same value, floats too:
/// so the boxes are the same in whichever precision they are read.
AnyFrameWriter write_csv(std::ostream& stream, int dimension, Precision precision);

}  // namespace broadside::lab::readers

// The lines of C++ that do as advised.
#pragma once

#include <string>
#include <string_view>

#include "lab/formats/frames.hpp"
#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// A piece of source that compiles as it stands: a function that finds all pairs by the algorithm of `spec`,
/// or a world that follows them. An algorithm that is none of the library's is made of its description.
std::string snippet(std::string_view spec, Mode mode, int dimension, Precision precision);

}  // namespace broadside::lab

// C++ source that follows the advice.
#pragma once

#include <string>
#include <string_view>

#include "lab/formats/frames.hpp"
#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// A piece of source that compiles as it stands: a function that finds all pairs by the algorithm of `spec`,
/// or a world that follows them. One of the paper's listings is registered first; an algorithm of the
/// caller's own is made from its description.
std::string snippet(std::string_view spec, Mode mode, int dimension, Precision precision);

}  // namespace broadside::lab

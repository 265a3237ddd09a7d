// C++ source that follows the advice.
#pragma once

#include <string>
#include <string_view>

#include "lab/formats/frames.hpp"
#include "lab/measure/measurement.hpp"

namespace broadside::lab {

/// A piece of source that compiles as it stands: a function that finds all pairs with the algorithm of
/// `spec`, or a world that follows moving boxes. It registers the paper's listings first if it uses one, and
/// makes an algorithm of the caller's own from its description.
std::string snippet(std::string_view spec, Mode mode, int dimension, Precision precision);

}  // namespace broadside::lab

// The inputs that the worst-case hunt takes unless others are asked for.
#pragma once

#include <vector>

#include "lab/worst/input.hpp"

namespace broadside::lab {

/// Every family with its standard values, in both dimensions and precisions and with every call, and inputs
/// that were slow once.
std::vector<HardInput> fixed_inputs();

}  // namespace broadside::lab

// The descriptions of the algorithms in this folder, for the registry.
#pragma once

#include <vector>

#include "broadside/algorithm.hpp"

namespace broadside::algorithm {

Algorithm automatic();  // of auto/
Algorithm brute_force();
Algorithm grid();
Algorithm sweep_and_prune();
Algorithm quadtree();
Algorithm bvh();

/// Those that BROADSIDE_ALGORITHMS lists, in its order: CMake writes this function.
std::vector<Algorithm> linked_algorithms();

}  // namespace broadside::algorithm

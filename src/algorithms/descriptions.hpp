// The descriptions in which the files of this folder end, for the registry.
#pragma once

#include "broadside/algorithm.hpp"

namespace broadside::algorithms {

Algorithm brute_force();
Algorithm grid();
Algorithm sweep_and_prune();
Algorithm quadtree();

}  // namespace broadside::algorithms

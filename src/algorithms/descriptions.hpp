// The descriptions in which the files of this folder end, for the registry.
#pragma once

#include "broadside/algorithm.hpp"

namespace broadside::own {

Algorithm automatic();  // src/auto.cpp, above the others
Algorithm brute_force();
Algorithm grid();
Algorithm sweep_and_prune();
Algorithm quadtree();
Algorithm bvh();
Algorithm hierarchical_grid();

}  // namespace broadside::own

// The descriptions in which the mended listings of this folder end, for the registry.
#pragma once

#include "broadside/algorithm.hpp"

namespace broadside::paper {

Algorithm brute_force();
Algorithm grid();
Algorithm sweep_and_prune();
Algorithm quadtree();

}  // namespace broadside::paper

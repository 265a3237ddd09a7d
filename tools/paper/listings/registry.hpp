// The mended listings as algorithms that the library knows by name.
#pragma once

#include "broadside/algorithm.hpp"

namespace broadside::paper {

Algorithm brute_force();
Algorithm grid();
Algorithm sweep_and_prune();
Algorithm quadtree();

/// Registers the four with the library, as paper_brute_force and so on. Further calls do nothing.
void register_listings();

}  // namespace broadside::paper

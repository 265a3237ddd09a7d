// Registers the corrected listings with the library, by name.
#pragma once

#include "broadside/algorithm.hpp"

namespace broadside::paper {

Algorithm brute_force();
Algorithm grid();
Algorithm sweep_and_prune();
Algorithm quadtree();

/// Registers the four listings as paper_brute_force and so on. Further calls do nothing.
void register_listings();

}  // namespace broadside::paper

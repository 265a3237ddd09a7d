// The experiments' descriptions: each is defined at the end of the file of its name, and listed in
// experiments.cpp.
#pragma once

#include "lab/experiments/experiment.hpp"

namespace broadside::lab {

Experiment brute_force_tests();
Experiment grid_memory();
Experiment grid_rebuilding();
Experiment grid_spanning();
Experiment grid_translation();
Experiment overtaking();
Experiment quadtree_siblings();
Experiment update_fraction();

}  // namespace broadside::lab

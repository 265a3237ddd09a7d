// The experiments' descriptions: each is defined at the end of the file of its name, and listed in
// experiments.cpp.
#pragma once

#include "paper/experiments/experiment.hpp"

namespace broadside::lab {

Experiment brute_force_tests();
Experiment overtaking();
Experiment grid_memory();
Experiment grid_spanning();
Experiment grid_cell_size();
Experiment sweep_axis();
Experiment quadtree_sizes();
Experiment quadtree_capacity();
Experiment update_fraction();
Experiment grid_translation();
Experiment grid_rebuilding();
Experiment sweep_insertion();
Experiment sweep_reinsertion();
Experiment quadtree_siblings();
Experiment winners();
Experiment ablation();

}  // namespace broadside::lab

// Algorithms from the literature, implemented here from their publications, with one function for each.
#pragma once

#include <vector>

#include "broadside/algorithm.hpp"

namespace broadside::lab::literature {

/// All of them, in a fixed order.
std::vector<Algorithm> algorithms();

Algorithm karras_lbvh();
Algorithm pbsm_stripes();
Algorithm segmented_sap();
Algorithm serpa_kd_tree();
Algorithm terdiman_box_pruning();
Algorithm two_layer_grid();

}  // namespace broadside::lab::literature

// The list of the algorithms from the literature.
#include "lab/literature/literature.hpp"

namespace broadside::lab::literature {

std::vector<Algorithm> algorithms() {
  return {terdiman_box_pruning(), segmented_sap(), serpa_kd_tree(),
          karras_lbvh(),          pbsm_stripes(),  two_layer_grid()};
}

}  // namespace broadside::lab::literature

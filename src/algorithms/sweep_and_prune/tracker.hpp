// The tracker of sweep and prune.
#pragma once

#include <memory>

#include "broadside/tracker.hpp"

namespace broadside::algorithm {

/// A tracker that keeps boxes in the order of a sweep along `axis`, or along the best one where that is -1.
template <int D>
std::unique_ptr<PairTracker<D>> make_sweep_and_prune_tracker(int axis);

}  // namespace broadside::algorithm

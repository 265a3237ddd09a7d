// A tracker for few boxes that move, over a dynamic bounding volume hierarchy.
#pragma once

#include <memory>

#include "broadside/tracker.hpp"

namespace broadside::algorithm {

template <int D>
std::unique_ptr<PairTracker<D>> make_bvh_tracker();

}  // namespace broadside::algorithm

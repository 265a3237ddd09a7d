// The tracker of brute force.
#pragma once

#include <memory>

#include "broadside/tracker.hpp"

namespace broadside::algorithm {

/// A tracker that compares each changed box with all others.
template <int D>
std::unique_ptr<PairTracker<D>> make_brute_force_tracker();

}  // namespace broadside::algorithm

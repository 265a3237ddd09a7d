// The bounding volume hierarchy as a tracker, for the description in bvh.cpp.
#pragma once

#include <memory>
#include <vector>

#include "broadside/algorithm.hpp"

namespace broadside::algorithm {

/// The tunable `update`.
std::vector<Tunable> bvh_tracking();

/// `finder` is what finds all pairs anew where most boxes move.
template <int D>
std::unique_ptr<PairTracker<D>> make_bvh_tracker(const Settings& settings,
                                                 std::unique_ptr<PairFinder<D>> finder);

}  // namespace broadside::algorithm

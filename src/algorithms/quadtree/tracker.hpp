// The quadtree as a tracker, for the description in quadtree.cpp.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"

namespace broadside::own {

/// The tunable `update`.
Tunable quadtree_update();

/// `finder` is what finds all pairs anew where most boxes move.

template <int D>
std::unique_ptr<PairTracker<D>> make_quadtree_tracker(const Settings& settings,
                                                      std::unique_ptr<PairFinder<D>> finder);

}  // namespace broadside::own

// Brute force, frame after frame: see brute_force_tracker.cpp.
#pragma once

#include <memory>

#include "broadside/pair_tracker.hpp"
#include "broadside/spec.hpp"

namespace broadside::own {

/// The tunable `update`: how trackers of brute force do it.
Tunable brute_force_update();

/// A tracker of brute force, whose finder is `finder`.
template <int D>
std::unique_ptr<PairTracker<D>> make_brute_force_tracker(const Settings& settings,
                                                         std::unique_ptr<PairFinder<D>> finder);

}  // namespace broadside::own

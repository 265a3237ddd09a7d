// Sweep and prune, frame after frame: see sweep_and_prune_tracker.cpp.
#pragma once

#include <memory>

#include "broadside/pair_tracker.hpp"
#include "broadside/spec.hpp"

namespace broadside::own {

/// The tunable `update`: how trackers of sweep and prune keep the order.
Tunable sweep_and_prune_update();

/// A tracker of sweep and prune, whose finder is `finder`.
template <int D>
std::unique_ptr<PairTracker<D>> make_sweep_and_prune_tracker(const Settings& settings,
                                                             std::unique_ptr<PairFinder<D>> finder);

}  // namespace broadside::own

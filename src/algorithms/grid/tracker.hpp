// The grid, frame after frame: see grid_tracker.cpp.
#pragma once

#include <memory>
#include <vector>

#include "broadside/pair_tracker.hpp"
#include "broadside/spec.hpp"

namespace broadside::own {

/// The tunables that are for the grid's trackers only.
std::vector<Tunable> grid_tracking();

/// A tracker of the grid, whose finder is `finder`.
template <int D>
std::unique_ptr<PairTracker<D>> make_grid_tracker(const Settings& settings,
                                                  std::unique_ptr<PairFinder<D>> finder);

}  // namespace broadside::own

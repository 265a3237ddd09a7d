// The trackers over the listings' own structures: section VI.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

namespace broadside::paper {

/// `settings` must have the tunables of paper_grid.
std::unique_ptr<PairTracker<2>> make_grid_tracker(const Settings& settings);

/// `settings` must have the tunables of paper_quadtree.
std::unique_ptr<PairTracker<2>> make_quadtree_tracker(const Settings& settings);

/// `settings` must have the tunables of paper_sweep_and_prune.
template <int D>
std::unique_ptr<PairTracker<D>> make_sweep_tracker(const Settings& settings);

}  // namespace broadside::paper

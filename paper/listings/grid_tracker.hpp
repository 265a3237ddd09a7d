// The tracker of the paper's grid: section VI-B.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

namespace broadside::paper {

/// `settings` must have the tunables of paper_grid.
std::unique_ptr<PairTracker<2>> make_grid_tracker(const Settings& settings);

}  // namespace broadside::paper

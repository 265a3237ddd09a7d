// The tracker of the paper's quadtree: section VI-D.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

namespace broadside::paper {

/// `settings` must have the tunables of paper_quadtree.
std::unique_ptr<PairTracker<2>> make_quadtree_tracker(const Settings& settings);

}  // namespace broadside::paper

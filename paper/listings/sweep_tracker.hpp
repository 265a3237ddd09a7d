// The tracker of the paper's sweep and prune: section VI-C.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"
#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

namespace broadside::paper {

/// `settings` must have the tunables of paper_sweep_and_prune.
template <int D>
std::unique_ptr<PairTracker<D>> make_sweep_tracker(const Settings& settings);

}  // namespace broadside::paper

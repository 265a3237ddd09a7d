// The tracker of the paper's sweep and prune: section VI-C.
#pragma once

#include <memory>

#include "broadside/broad_phase.hpp"
#include "broadside/spec.hpp"

namespace broadside::paper {

/// `settings` must have the tunables of paper_sweep_and_prune.
template <int D>
std::unique_ptr<PairTracker<D>> make_sweep_tracker(const Settings& settings);

}  // namespace broadside::paper

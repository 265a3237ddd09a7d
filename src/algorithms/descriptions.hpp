// The descriptions in which the files of this folder end, for the registry.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"

#include "interface/candidate_tracker.hpp"

namespace broadside::own {

Algorithm automatic();  // src/auto.cpp, above the others
Algorithm brute_force();
Algorithm grid();
Algorithm sweep_and_prune();
Algorithm quadtree();
Algorithm bvh();

/// The structure in which `grid` follows boxes, for callers that judge its pairs themselves.
template <int D>
std::unique_ptr<core::CandidateTracker<D>> grid_candidates();

}  // namespace broadside::own

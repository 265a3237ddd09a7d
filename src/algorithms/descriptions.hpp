// The descriptions of the algorithms in this folder, for the registry.
#pragma once

#include <memory>
#include <vector>

#include "broadside/algorithm.hpp"

#include "interface/candidate_tracker.hpp"

namespace broadside::algorithm {

Algorithm automatic();  // of auto/
Algorithm brute_force();
Algorithm grid();
Algorithm sweep_and_prune();
Algorithm quadtree();
Algorithm bvh();

/// The structure in which `grid` follows boxes, for callers that judge its pairs themselves.
template <int D>
std::unique_ptr<core::CandidateTracker<D>> grid_candidates();

/// Those that BROADSIDE_ALGORITHMS lists, in its order: CMake writes this function.
std::vector<Algorithm> linked_algorithms();

}  // namespace broadside::algorithm

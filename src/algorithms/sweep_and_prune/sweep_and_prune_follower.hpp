// SweepAndPruneFollower: keeps boxes in order along an axis.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"

namespace broadside::algorithm {

/// The axis to sweep along; -1: the best one for the boxes.
int axis_of(const Settings& settings);

template <int D>
std::unique_ptr<Follower<D>> make_sweep_and_prune_follower(const Settings& settings);

}  // namespace broadside::algorithm

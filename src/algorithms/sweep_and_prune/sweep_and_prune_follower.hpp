// SweepAndPruneFollower: keeps boxes in order along an axis.
#pragma once

#include <memory>

#include "broadside/follower.hpp"

namespace broadside::algorithm {

/// Along this axis, or -1: the best one for the boxes.
template <int D>
std::unique_ptr<Follower<D>> make_sweep_and_prune_follower(int axis);

}  // namespace broadside::algorithm

// BvhFollower: follows boxes in a dynamic bounding volume hierarchy.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"

namespace broadside::algorithm {

template <int D>
std::unique_ptr<Follower<D>> make_bvh_follower(const Settings& settings);

}  // namespace broadside::algorithm

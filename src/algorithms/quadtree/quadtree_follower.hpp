// QuadtreeFollower: follows boxes in a quadtree, in 3D an octree.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"

namespace broadside::algorithm {

template <int D>
std::unique_ptr<Follower<D>> make_quadtree_follower(const Settings& settings);

}  // namespace broadside::algorithm

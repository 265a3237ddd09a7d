// QuadtreeFollower: follows boxes in a quadtree, in 3D an octree.
#pragma once

#include <cstdint>
#include <memory>

#include "broadside/follower.hpp"

namespace broadside::algorithm {

/// Keeps a tree whose leaves hold up to `capacity` boxes.
template <int D>
std::unique_ptr<Follower<D>> make_quadtree_follower(std::uint32_t capacity);

/// The capacity where none is given. Smaller than the searcher's, which sweeps a leaf once for all of its
/// boxes.
inline constexpr std::uint32_t following_capacity = 32;

}  // namespace broadside::algorithm

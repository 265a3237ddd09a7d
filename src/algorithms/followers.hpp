// The followers of the library's algorithms, each in its algorithm's folder.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"

namespace broadside::algorithm {

/// Compares each changed box with all others.
template <int D>
std::unique_ptr<Follower<D>> make_brute_force_follower(const Settings& settings);

/// Follows boxes in levels of cells.
template <int D>
std::unique_ptr<Follower<D>> make_grid_follower(const Settings& settings);

/// Keeps boxes in order along an axis.
template <int D>
std::unique_ptr<Follower<D>> make_sweep_and_prune_follower(const Settings& settings);

/// The axis to sweep along, or -1 to choose the best one for the boxes.
int axis_of(const Settings& settings);

/// Keeps a quadtree, in 3D an octree.
template <int D>
std::unique_ptr<Follower<D>> make_quadtree_follower(const Settings& settings);

/// Follows boxes in a dynamic bounding volume hierarchy.
template <int D>
std::unique_ptr<Follower<D>> make_bvh_follower(const Settings& settings);

}  // namespace broadside::algorithm

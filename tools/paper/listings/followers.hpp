// The followers over the listings' own structures: section VI.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"
#include "broadside/follower.hpp"

namespace broadside::paper {

/// `settings` must have the tunables of paper_grid.
std::unique_ptr<Follower<2>> make_grid_follower(const Settings& settings);

/// `settings` must have the tunables of paper_quadtree.
std::unique_ptr<Follower<2>> make_quadtree_follower(const Settings& settings);

/// `settings` must have the tunables of paper_sweep_and_prune.
template <int D>
std::unique_ptr<Follower<D>> make_sweep_follower(const Settings& settings);

}  // namespace broadside::paper

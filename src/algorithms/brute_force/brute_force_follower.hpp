// BruteForceFollower: compares each changed box with all others.
#pragma once

#include <memory>

#include "broadside/algorithm.hpp"

namespace broadside::algorithm {

template <int D>
std::unique_ptr<Follower<D>> make_brute_force_follower(const Settings& settings);

}  // namespace broadside::algorithm

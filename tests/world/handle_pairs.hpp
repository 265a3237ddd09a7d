// A world's pairs, copied for comparison.
#pragma once

#include <span>
#include <vector>

#include "broadside/world.hpp"

namespace broadside {

using HandlePairs = std::vector<HandlePair>;

inline HandlePairs listed(std::span<const HandlePair> pairs) { return {pairs.begin(), pairs.end()}; }

}  // namespace broadside

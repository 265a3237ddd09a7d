// Boxes, pairs and ids as unit tests write them.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside {

inline constexpr float infinity = std::numeric_limits<float>::infinity();
inline constexpr float nan = std::numeric_limits<float>::quiet_NaN();

using Ids = std::vector<BoxId>;
using Pairs = std::vector<Pair>;

/// The unit square from `x` to `x + 1`: it overlaps the one at `x + 1`, which it touches.
inline Box2 at(float x) { return {{x, 0}, {x + 1, 1}}; }

inline Pair pair(std::uint32_t first, std::uint32_t second) { return {BoxId{first}, BoxId{second}}; }

}  // namespace broadside

// Boxes, pairs and ids for unit tests.
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

/// A unit square from `x` to `x + 1`; it touches, and so overlaps, the one at `x + 1`.
inline Box2 at(float x) { return {{x, 0}, {x + 1, 1}}; }

inline Pair pair(std::uint32_t first, std::uint32_t second) { return {BoxId{first}, BoxId{second}}; }

}  // namespace broadside

// Random pairs of a few boxes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>

#include "broadside/pair.hpp"

namespace broadside::world {

inline std::uint32_t below(std::mt19937& random, std::uint32_t end) {
  return static_cast<std::uint32_t>(random() % end);
}

inline Pair random_pair(std::mt19937& random, std::uint32_t boxes) {
  const std::uint32_t one = below(random, boxes);
  const std::uint32_t other = (one + 1 + below(random, boxes - 1)) % boxes;
  return {BoxId{std::min(one, other)}, BoxId{std::max(one, other)}};
}

}  // namespace broadside::world

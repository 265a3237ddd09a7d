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
  const std::uint32_t a = below(random, boxes);
  const std::uint32_t b = (a + 1 + below(random, boxes - 1)) % boxes;
  return {BoxId{std::min(a, b)}, BoxId{std::max(a, b)}};
}

}  // namespace broadside::world

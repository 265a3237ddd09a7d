// Where a sweep and prune is tried: worlds without bounds, and towers on one ground.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/box.hpp"

namespace broadside::lab {

/// A world, and the one without what makes it boundless.
struct SweepWorld {
  std::string name;
  std::string bounded;
  std::vector<Box2> (*make)(std::size_t count);
};

inline const std::string infinite_world = "4 infinite boxes";

/// Each after the bounded one that it is compared with.
const std::vector<SweepWorld>& sweep_worlds();

/// Towers that stand on one ground: along the last axis all begin at the same place.
template <int D>
std::vector<Box<D>> towers(const Settings& settings, std::size_t count, std::uint64_t seed);

}  // namespace broadside::lab

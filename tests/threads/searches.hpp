// Searches by several threads, for their laws.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadside/broad_phase.hpp"
#include "broadside/sinks.hpp"

#include "law_case.hpp"
#include "tests/support/found.hpp"
#include "tests/support/rng.hpp"

namespace broadside::laws {

template <int D>
std::vector<Box<D>> scattered_boxes(std::size_t count, float world, std::uint32_t seed = 1) {
  Rng rng(seed);
  std::vector<Box<D>> boxes(count);
  for (Box<D>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      box.min[axis] = rng.between(0, world);
      box.max[axis] = box.min[axis] + rng.between(0, 3);
    }
  }
  return boxes;
}

/// Workers that share even a few boxes.
inline Workers workers(std::size_t threads, Executor* executor = nullptr) {
  return {.threads = threads, .executor = executor, .boxes_per_thread = 1};
}

}  // namespace broadside::laws

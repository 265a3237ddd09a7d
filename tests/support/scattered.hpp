// Uniformly scattered boxes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "broadside/box.hpp"

#include "tests/support/rng.hpp"

namespace broadside {

/// Boxes with sides of up to 3 and minima between 0 and `world` on each axis.
template <int D>
std::vector<Box<D>> scattered_boxes(std::size_t count, float world = 10, std::uint64_t seed = 1) {
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

}  // namespace broadside

// RapidCheck generators of boxes, and their printing. Small whole numbers come first, so that a failing input
// shrinks to one that can be drawn by hand.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <ostream>
#include <vector>

#include <rapidcheck.h>

#include "broadside/box.hpp"

namespace broadside {

/// RapidCheck finds this function by argument-dependent lookup.
template <int D>
void showValue(const Box<D>& box, std::ostream& out) {
  if (is_absent(box)) {
    out << "absent";
    return;
  }
  out.precision(std::numeric_limits<float>::max_digits10);
  for (int axis = 0; axis < D; ++axis)
    out << (axis == 0 ? "{" : " x {") << box.min[axis] << ", " << box.max[axis] << "}";
}

namespace laws {

/// Boxes on a small lattice, which often touch, coincide and degenerate. One in ten is absent.
template <int D>
rc::Gen<Box<D>> lattice_box() {
  const auto present = rc::gen::map(rc::gen::container<std::array<int, 2 * D>>(rc::gen::inRange(0, 8)),
                                    [](const std::array<int, 2 * D>& numbers) {
                                      Box<D> box;
                                      for (int axis = 0; axis < D; ++axis) {
                                        box.min[axis] = static_cast<float>(numbers[axis]);
                                        box.max[axis] =
                                            static_cast<float>(numbers[axis] + numbers[D + axis] / 2);
                                      }
                                      return box;
                                    });
  return rc::gen::weightedOneOf<Box<D>>({{9, present}, {1, rc::gen::just(absent_box<D>())}});
}

/// Boxes with arbitrary float coordinates except NaN: all magnitudes, denormal, special and infinite values.
template <int D>
rc::Gen<Box<D>> any_box() {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  constexpr float largest = std::numeric_limits<float>::max();
  const auto bits = rc::gen::map(rc::gen::arbitrary<std::uint32_t>(), [](std::uint32_t raw) {
    const auto value = std::bit_cast<float>(raw);
    return std::isnan(value) ? 0.0f : value;
  });
  const auto special = rc::gen::element(0.0f, -0.0f, 1.0f, largest, -largest, infinity, -infinity);
  const auto coordinate = rc::gen::weightedOneOf<float>(
      {{2, bits}, {2, rc::gen::map(rc::gen::inRange(-4, 4), [](int i) { return float(i); })}, {1, special}});
  const auto present = rc::gen::map(rc::gen::container<std::array<float, 2 * D>>(coordinate),
                                    [](const std::array<float, 2 * D>& numbers) {
                                      Box<D> box;
                                      for (int axis = 0; axis < D; ++axis) {
                                        box.min[axis] = std::min(numbers[axis], numbers[D + axis]);
                                        box.max[axis] = std::max(numbers[axis], numbers[D + axis]);
                                      }
                                      return box;
                                    });
  return rc::gen::weightedOneOf<Box<D>>({{9, present}, {1, rc::gen::just(absent_box<D>())}});
}

}  // namespace laws
}  // namespace broadside

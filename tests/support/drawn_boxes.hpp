// Boxes and filters as tests draw them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"

#include "tests/support/boxes.hpp"
#include "tests/support/rng.hpp"

namespace broadside {

/// How random boxes are generated: on a lattice, so that they touch and coincide.
struct BoxKind {
  int places = 60;  ///< minima are whole numbers below this one
  int max_extent = 10;
  std::size_t infinite_one_in = 40;  ///< fraction of infinite sides, one in this many; 0: none
};

template <int D, typename Real = float>
Box<D, Real> random_box(Choices& choices, const BoxKind& kind = {}) {
  const auto is_infinite = [&] { return kind.infinite_one_in != 0 && choices.one_in(kind.infinite_one_in); };
  Box<D, Real> box;
  for (int axis = 0; axis < D; ++axis) {
    box.min[axis] = static_cast<Real>(choices.whole(0, kind.places - 1));
    box.max[axis] = box.min[axis] + static_cast<Real>(choices.whole(0, kind.max_extent));
    if (is_infinite()) box.min[axis] = -infinity;
    if (is_infinite()) box.max[axis] = infinity;
  }
  return box;
}

template <int D>
std::vector<Box<D>> random_boxes(Choices& choices, std::size_t count, const BoxKind& kind = {}) {
  std::vector<Box<D>> boxes(count);
  for (Box<D>& box : boxes) box = random_box<D>(choices, kind);
  return boxes;
}

/// Any float but NaN: small whole numbers and their quarters, of all magnitudes, denormal, infinite.
inline float any_float(Choices& choices) {
  constexpr float max_float = std::numeric_limits<float>::max();
  constexpr float min_denormal = std::numeric_limits<float>::denorm_min();
  constexpr std::array<float, 14> special = {
      infinity, -infinity, max_float, -max_float, -0.0F,  min_denormal, -min_denormal,
      16777216, 1e6F,      -1e6F,     1.000001F,  1e-30F, -1e30F,       std::numeric_limits<float>::min()};
  const std::size_t kind = choices.below(8);
  if (kind < 3) return static_cast<float>(choices.whole(-4, 4));
  if (kind < 5) return static_cast<float>(choices.whole(-20, 20)) / 4;
  if (kind < 7) return choices.one_of<float>(special);
  const auto value = std::bit_cast<float>(static_cast<std::uint32_t>(choices.below(std::size_t{1} << 32)));
  return std::isnan(value) ? 0.0F : value;
}

/// A present box of any floats.
template <int D, typename Real = float>
Box<D, Real> box_of_any_floats(Choices& choices) {
  Box<D, Real> box;
  for (int axis = 0; axis < D; ++axis) {
    const float a = any_float(choices);
    const float b = choices.one_in(3) ? a : any_float(choices);
    box.min[axis] = std::min(a, b);
    box.max[axis] = std::max(a, b);
  }
  return box;
}

/// Doubles that round to the box's floats, so that touching boxes may be apart in double precision.
template <int D>
Box<D, double> near_double(Choices& choices, const Box<D>& box) {
  // Offsets by at most half the distance to the next float, and by more than a double's precision.
  const auto near = [&choices](float value) {
    return std::isinf(value) ? value
                             : value + choices.whole(-1, 1) * 0x1p-40 * std::max(1.0F, std::abs(value));
  };
  Box<D, double> doubles;
  for (int axis = 0; axis < D; ++axis) {
    doubles.min[axis] = near(box.min[axis]);
    doubles.max[axis] = std::max(doubles.min[axis], near(box.max[axis]));
  }
  return doubles;
}

/// Two different ones of the first `boxes` boxes, in order.
inline Pair random_pair(Choices& choices, std::size_t boxes) {
  const std::size_t one = choices.below(boxes);
  const std::size_t other = (one + 1 + choices.below(boxes - 1)) % boxes;
  return {BoxId(std::min(one, other)), BoxId(std::max(one, other))};
}

/// Few filters, so that many accept each other and many do not.
inline Filter any_filter(Choices& choices) {
  if (choices.one_in(3)) return {};
  constexpr std::array<std::uint32_t, 5> masks = {0xffffffffU, 1, 3, 0x80000001U, 0};
  constexpr std::array<std::uint32_t, 3> categories = {1, 2, 0x80000000U};
  Filter filter;
  filter.category = choices.one_of<std::uint32_t>(categories);
  filter.mask = masks[choices.one_in(16) ? 4 : choices.below(4)];
  if (choices.one_in(3)) filter.group = choices.whole(-2, 2);
  filter.is_static = choices.one_in(4);
  return filter;
}

}  // namespace broadside

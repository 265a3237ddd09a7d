// clustering(): how unevenly boxes are spread, from a small sample.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "broadside/box.hpp"

#include "algorithms/auto/auto_thresholds.hpp"
#include "core/sample.hpp"

namespace broadside::algorithm {

/// The number of pairs of sampled boxes that are near on all axes, over the number that independent axes
/// would give: 1 if boxes are spread evenly. Two boxes are near if their minima differ by at most `reach`.
/// `shift`: by core::sample_shift().
/// Cost: O(1): all pairs of the sample, without branches.
template <int D>
double clustering(std::span<const Box<D>> boxes, const std::array<float, D>& reach, std::uint32_t shift = 0) {
  constexpr std::size_t sampled = AutoThresholds<D>::sampled_boxes;
  const std::size_t count = std::min(boxes.size(), sampled);
  std::array<std::array<float, sampled>, D> minima;
  for (std::size_t i = 0; i < count; ++i) {
    const Box<D>& box = boxes[core::sampled_place(i + shift, boxes.size())];
    for (int axis = 0; axis < D; ++axis) minima[axis][i] = box.min[axis];
  }
  std::array<std::uint32_t, D> on_axis{};
  std::uint32_t on_all = 0;
  for (std::size_t i = 1; i < count; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      std::uint32_t all = 1;
      for (int axis = 0; axis < D; ++axis) {
        const float difference = minima[axis][i] - minima[axis][j];
        const std::uint32_t is_near = static_cast<std::uint32_t>(difference <= reach[axis]) &
                                      static_cast<std::uint32_t>(-difference <= reach[axis]);
        on_axis[axis] += is_near;
        all &= is_near;
      }
      on_all += all;
    }
  }
  const double pairs = static_cast<double>(count * (count - 1)) / 2;
  double expected = pairs;
  for (int axis = 0; axis < D; ++axis) expected *= on_axis[axis] / pairs;
  // Up to four pairs may be near by chance.
  return on_all / std::max(expected, 4.0);
}

}  // namespace broadside::algorithm

// The outline of a grid: its cells, and what they are in words.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "broadside/box.hpp"
#include "broadside/debug/outline.hpp"

#include "algorithms/outline_text.hpp"
#include "core/cell_axis.hpp"

namespace broadside::algorithm {

/// Such as "12 x 9 cells of 2.1 x 2.5 over x and z, each swept along y".
template <int D>
std::string caption_of(const std::array<int, D>& axes, const std::array<core::CellAxis, D - 1>& cells) {
  const std::string swept = " swept along " + axis_name(axes[0]);
  const auto size = [&cells](int axis) { return three_digits(1 / cells[axis].per_unit); };
  if (std::all_of(cells.begin(), cells.end(), [](const core::CellAxis& axis) { return axis.count() == 1; }))
    return "1 cell," + swept;
  if constexpr (D == 2)
    return counted(cells[0].count(), "cell") + " of " + size(0) + " over " + axis_name(axes[1]) + ", each" +
           swept;
  else
    return std::to_string(cells[0].count()) + " x " + counted(cells[1].count(), "cell") + " of " + size(0) +
           " x " + size(1) + " over " + axis_name(axes[1]) + " and " + axis_name(axes[2]) + ", each" + swept;
}

/// An outline of cells over all axes but axes[0].
template <int D>
Outline<D> outline_of(const std::array<int, D>& axes, const std::array<core::CellAxis, D - 1>& cells) {
  Outline<D> outline;
  outline.kind = "cells";
  outline.swept_axis = axes[0];
  outline.caption = caption_of<D>(axes, cells);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Box<D> whole;
  whole.min.fill(-infinity);
  whole.max.fill(infinity);
  outline.levels = {{whole}};
  // Cuts what there is along one axis after the other, the rows first.
  for (int axis = D - 2; axis >= 0; --axis) {
    const auto cut = std::exchange(outline.levels[0], {});
    for (Box<D> part : cut) {
      const std::uint32_t count = cells[axis].count();
      for (std::uint32_t cell = 0; cell < count; ++cell) {
        part.max[axes[axis + 1]] = cell + 1 < count ? core::border_before(cells[axis], cell + 1) : infinity;
        outline.levels[0].push_back(part);
        part.min[axes[axis + 1]] = part.max[axes[axis + 1]];
      }
    }
  }
  return outline;
}

}  // namespace broadside::algorithm

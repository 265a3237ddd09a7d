// Chooses a grid's axes and cells.
#include "algorithms/grid/grid_layout.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace broadside::algorithm {
namespace {

/// Up to this many, a cell's number is exact as a float.
constexpr double max_cells = 1 << GridLayout<2>::cell_bits;

/// With fewer boxes per cell, looking at cells costs more than they save.
constexpr double min_boxes_per_cell = 16;

/// The maximum number of cells that a box may be in, on average, if the caller sets the size of cells.
constexpr double max_references_per_box = 64;

/// The cost, in tests of two boxes, of inserting a box into one more cell, beyond the tests there.
constexpr double grid_reference_cost = 20;

/// Threads share out the slabs. There are enough of them, but each has several rows, since a box that reaches
/// another slab is inserted there again.
constexpr std::size_t max_slabs = 16;
constexpr std::size_t min_rows_per_slab = 4;

/// The chance that two boxes of the sample begin within `distance` of each other.
double chance_within(const core::AxisSample& sample, double distance) {
  const std::vector<float>& minima = sample.minima;
  const auto count = static_cast<double>(minima.size());
  if (minima.size() < 2) return 1;
  std::size_t near = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < minima.size(); ++i) {
    while (static_cast<double>(minima[i]) - minima[first] > distance) ++first;
    near += i - first;
  }
  return std::max(1.0, static_cast<double>(near)) / (count * (count - 1) / 2);
}

double range_of(const core::AxisSample& sample) { return static_cast<double>(sample.high) - sample.low; }

}  // namespace

template <int D>
void GridLayout<D>::choose(const core::Sample<D>& sample, std::size_t count, std::optional<double> cell) {
  axes_ = sample.axes_by_overlap();
  const auto boxes = static_cast<double>(count);
  const double max_for_boxes =
      std::clamp(cell ? max_cells_per_box * boxes : boxes / min_boxes_per_cell, 1.0, max_cells);
  const auto cells_of_size = [&](const auto& size_on) {
    std::array<double, gridded> cells;
    for (int axis = 0; axis < gridded; ++axis) {
      const core::AxisSample& on_axis = sample[axes_[axis + 1]];
      const double range = range_of(on_axis);
      const double size = size_on(on_axis);
      cells[axis] = range > 0 && size < range ? std::floor(std::min(range / size, max_for_boxes)) : 1;
    }
    // Halves the axis with the most cells while there are too many in all.
    for (;;) {
      double product = 1;
      for (const double cells_on_axis : cells) product *= cells_on_axis;
      double& longest = *std::max_element(cells.begin(), cells.end());
      if (product <= max_for_boxes || longest <= 1) break;
      longest = std::max(1.0, std::floor(longest / 2));
    }
    return cells;
  };
  if (cell) {
    std::array<double, gridded> cells = cells_of_size([&](const core::AxisSample&) { return *cell; });
    // Boxes in very many cells would be compared in each of them.
    const auto references = [&](int axis) {
      const core::AxisSample& on_axis = sample[axes_[axis + 1]];
      return cells[axis] > 1 ? 1 + on_axis.mean_extent / range_of(on_axis) * cells[axis] : 1;
    };
    for (;;) {
      double product = 1;
      int densest_axis = 0;
      for (int axis = 0; axis < gridded; ++axis) {
        product *= references(axis);
        if (references(axis) > references(densest_axis)) densest_axis = axis;
      }
      if (product <= max_references_per_box) break;
      cells[densest_axis] = std::max(1.0, std::floor(cells[densest_axis] / 2));
    }
    set(sample, cells);
    return;
  }

  // On each axis a box is in one cell, and in another with probability extent / size. In each it is tested
  // with the boxes of the cell that begin before it ends.
  const double swept = boxes * sample[axes_[0]].overlap / 2;
  const auto cost = [&](const std::array<double, gridded>& cells) {
    double references = 1;
    double sharing = 1;
    for (int axis = 0; axis < gridded; ++axis) {
      const core::AxisSample& on_axis = sample[axes_[axis + 1]];
      if (cells[axis] <= 1) continue;
      const double size = range_of(on_axis) / cells[axis];
      const double more = 1 + on_axis.mean_extent / size;
      references *= more;
      sharing *= std::min(1.0, more * chance_within(on_axis, size) / 2);
    }
    return references * (grid_reference_cost + swept * sharing);
  };
  std::array<double, gridded> best{};
  best.fill(1);
  double min_cost = cost(best);
  for (double extents = 1; extents < 1e6; extents *= 1.4) {
    const auto cells = cells_of_size(
        [&](const core::AxisSample& on_axis) { return extents * std::max(on_axis.mean_extent, 1e-30); });
    if (std::all_of(cells.begin(), cells.end(), [](double cells_on_axis) { return cells_on_axis <= 1; }))
      break;
    if (const double found = cost(cells); found < min_cost) {
      min_cost = found;
      best = cells;
    }
  }
  set(sample, best);
}

template <int D>
void GridLayout<D>::set(const core::Sample<D>& sample, const std::array<double, gridded>& cells) {
  cell_count_ = 1;
  for (int axis = 0; axis < gridded; ++axis) {
    const core::AxisSample& on_axis = sample[axes_[axis + 1]];
    cells_[axis] = static_cast<std::uint32_t>(cells[axis]);
    cell_count_ *= cells_[axis];
    // Neither zero nor infinite: the product with an infinite or a zero distance would be NaN.
    const double range = range_of(on_axis);
    const double per_unit = range > 0 ? cells_[axis] / range : 1;
    cell_axes_[axis] = {.low = on_axis.low,
                        .per_unit = static_cast<float>(std::clamp<double>(
                            per_unit, std::numeric_limits<float>::min(), std::numeric_limits<float>::max())),
                        .last = static_cast<float>(cells_[axis] - 1)};
    set_borders(axis);
  }
  set_slabs();
}

template <int D>
void GridLayout<D>::set_borders(int axis) {
  std::vector<float>& borders = borders_[axis];
  borders.resize(cells_[axis]);
  for (std::uint32_t cell = 1; cell < cells_[axis]; ++cell)
    borders[cell - 1] = core::border_before(cell_axes_[axis], cell);
  borders.back() = std::numeric_limits<float>::quiet_NaN();
}

template <int D>
void GridLayout<D>::set_slabs() {
  const std::size_t slabs = std::clamp<std::size_t>(rows() / min_rows_per_slab, 1, max_slabs);
  slab_begin_.resize(slabs + 1);
  slab_of_.resize(rows());
  slab_border_.resize(rows());
  for (std::size_t slab = 0; slab <= slabs; ++slab)
    slab_begin_[slab] = static_cast<std::uint32_t>(slab * rows() / slabs);
  for (std::size_t slab = 0; slab < slabs; ++slab) {
    for (std::size_t row = slab_begin_[slab]; row < slab_begin_[slab + 1]; ++row) {
      slab_of_[row] = static_cast<std::uint8_t>(slab);
      slab_border_[row] = row_border(slab_begin_[slab + 1] - 1);
    }
  }
}

template class GridLayout<2>;
template class GridLayout<3>;

}  // namespace broadside::algorithm

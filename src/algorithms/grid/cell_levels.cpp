// Chooses the number of levels and the size of their cells.
#include "algorithms/grid/cell_levels.hpp"

#include "algorithms/grid/grid_layout.hpp"

namespace broadside::algorithm {
namespace {

/// Boxes per cell: with fewer there are more cells to look into, with more there are more boxes to compare.
constexpr double boxes_per_cell = 10;

/// If a typical box's cell has more boxes than this, smaller cells pay.
constexpr double max_load_factor = 40;

constexpr std::size_t max_sampled = 1024;

/// The least whole number whose D-th power is at least `count`.
template <int D>
std::size_t whole_root(std::size_t count) {
  std::size_t root = 1;
  while ((D == 2 ? root * root : root * root * root) < count) ++root;
  return root;
}

}  // namespace

template <int D>
void CellLevels<D>::choose(std::span<const Box<D>> like) {
  sampled_.clear();
  core::for_present_sample(like, max_sampled, [this](const Box<D>& box) { sampled_.push_back(box); });
  sample_.take(sampled_, max_sampled);
  const auto spread = static_cast<float>(whole_root<D>(like.size()));
  for (int axis = 0; axis < D; ++axis) {
    const float range = std::min(sample_[axis].high - sample_[axis].low, std::numeric_limits<float>::max());
    typical_[axis] = std::max(sample_[axis].extent, range / spread / 2);
    inverse_typical_[axis] = typical_[axis] > 0
                                 ? std::min(1 / typical_[axis], std::numeric_limits<float>::max())
                                 : std::numeric_limits<float>::max();
  }
  // The last level, which is one cell, is for boxes about as long as the whole scene.
  float border = first_border;
  count_ = 1;
  const auto is_short = [&](int axis) {
    return border * typical_[axis] < (sample_[axis].high - sample_[axis].low) / 4;
  };
  while (count_ < kernels::max_cell_levels - 1) {
    bool any = false;
    for (int axis = 0; axis < D; ++axis) any |= is_short(axis);
    if (!any) break;
    border *= level_ratio;
    ++count_;
  }
  ++count_;
  measure(like);
}

/// Counts the boxes on each level, and measures the longest ones.
template <int D>
void CellLevels<D>::measure(std::span<const Box<D>> like) {
  for (Level& level : levels_) level.extent = {};
  expected_.fill(0);
  factor_.fill(0);
  for (const Box<D>& box : like) {
    if (!is_present(box)) continue;
    const std::size_t level = level_of(box);
    ++expected_[level];
    for (int axis = 0; axis < D; ++axis) {
      const float extent = box.max[axis] - box.min[axis];
      if (extent > levels_[level].extent[axis]) levels_[level].extent[axis] = extent;
    }
  }
  // A rounded difference may be less than the true one, but the next float is not.
  for (Level& level : levels_) {
    for (float& extent : level.extent)
      extent = std::nextafter(extent, std::numeric_limits<float>::infinity());
  }
}

template <int D>
std::uint32_t CellLevels<D>::lay_out() {
  std::uint32_t cells = 0;
  for (std::size_t level = 0; level < count_; ++level) {
    lay_out_level(level);
    levels_[level].first_cell = cells;
    std::uint32_t count = 1;
    for (int axis = 0; axis < D; ++axis) count *= levels_[level].axes[axis].count();
    cells += count;
  }
  return cells;
}

/// Sets the cells of a level: as many as suit its boxes, but none shorter than the longest box. The cells get
/// smaller from call to call if shrink_crowded_cells() asked for it.
template <int D>
void CellLevels<D>::lay_out_level(std::size_t index) {
  Level& level = levels_[index];
  const bool is_last = index + 1 == count_;
  std::array<double, D> range;
  std::array<double, D> length;
  for (int axis = 0; axis < D; ++axis) {
    range[axis] = static_cast<double>(sample_[axis].high) - sample_[axis].low;
    length[axis] = std::max<double>(level.extent[axis], typical_[axis]);
  }
  const auto cells = [&](double factor) {
    std::array<double, D> counts;
    for (int axis = 0; axis < D; ++axis) {
      const bool is_one = is_last || !(length[axis] > 0) || !(range[axis] > 0);
      counts[axis] = is_one ? 1 : std::max(1.0, std::floor(range[axis] / (length[axis] * factor)));
    }
    return counts;
  };
  const auto product = [](const std::array<double, D>& counts) {
    double all = 1;
    for (const double count : counts) all *= count;
    return all;
  };
  if (cell_ && !is_last) {
    double asked = *cell_;
    for (std::size_t i = 0; i < index; ++i) asked *= level_ratio;
    for (double& side : length) side = asked;
  }
  const double max_level_cells =
      std::max(1.0, expected_[index] * (cell_ ? max_cells_per_box : 1 / boxes_per_cell));
  if (factor_[index] == 0 || cell_) {
    double factor = 1;
    while (product(cells(factor)) > max_level_cells) factor *= 1.125;
    factor_[index] = factor;
  }
  const std::array<double, D> counts = cells(factor_[index]);
  std::uint32_t stride = 1;
  for (int axis = 0; axis < D; ++axis) {
    const double side = counts[axis] > 1 ? range[axis] / counts[axis] : 0;
    level.axes[axis] = {
        .low = sample_[axis].low,
        .per_unit =
            side > 0 ? static_cast<float>(std::min<double>(1 / side, std::numeric_limits<float>::max())) : 0,
        .last = static_cast<float>(counts[axis] - 1)};
    level.stride[axis] = stride;
    stride *= static_cast<std::uint32_t>(counts[axis]);
    if (index == 0) smallest_[axis] = static_cast<float>(side);
  }
}

template <int D>
bool CellLevels<D>::shrink_crowded_cells(std::span<const std::uint32_t> counts) {
  bool any = false;
  for (std::size_t index = 0; index + 1 < count_ && !cell_; ++index) {
    const std::size_t end = index + 1 < count_ ? levels_[index + 1].first_cell : counts.size();
    double boxes = 0;
    double met = 0;
    for (std::size_t cell = levels_[index].first_cell; cell < end; ++cell) {
      const double count = counts[cell];
      boxes += count;
      met += count * count;
    }
    const auto cells = static_cast<double>(end - levels_[index].first_cell);
    if (met <= max_load_factor * boxes || factor_[index] <= 1 || cells > boxes / 2) continue;
    factor_[index] = std::max(1.0, factor_[index] / (D == 2 ? 2 : 1.6));
    any = true;
  }
  return any;
}

template class CellLevels<2>;
template class CellLevels<3>;

}  // namespace broadside::algorithm

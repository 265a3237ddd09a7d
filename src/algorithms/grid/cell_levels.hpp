// CellLevels: the levels of a hierarchical grid. The cells of a level have one size, for boxes of about one
// size (C. Ericson, Real-Time Collision Detection, 7.2).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "broadside/box.hpp"

#include "core/sample.hpp"
#include "kernels/find_changes.hpp"

namespace broadside::algorithm {

/// The last level is one cell: it is for boxes about as long as the whole scene.
template <int D>
class CellLevels {
 public:
  /// Cells of the first level are `cell` wide, those of each further level four times as wide. By default,
  /// the boxes decide.
  explicit CellLevels(std::optional<double> cell) : cell_(cell) {}

  using Level = kernels::CellLevel<D>;

  /// Chooses levels that suit `like`. O(n).
  void choose(std::span<const Box<D>> like);

  /// Lays out the cells of the chosen levels, smaller ones if shrink_crowded_cells() asked for them. Returns
  /// the number of cells on all levels.
  std::uint32_t lay_out();

  /// Makes the cells of a level smaller, from the next lay_out() on, if a typical box shares its cell with
  /// too many others. `counts` are the boxes per cell. Returns whether any level changed. O(cells).
  bool shrink_crowded_cells(std::span<const std::uint32_t> counts);

  /// Sets the number of boxes on each level to 0.
  void clear() {
    for (Level& level : levels_) level.boxes = 0;
  }

  /// The level that a box belongs to.
  std::size_t level_of(const Box<D>& box) const {
    float size = 0;
    for (int axis = 0; axis < D; ++axis)
      size = std::max(size, (box.max[axis] - box.min[axis]) * inverse_typical_[axis]);
    std::size_t level = 0;
    for (float border = first_border; size > border && level + 1 < count_; border *= level_ratio) ++level;
    return level;
  }

  /// Whether widen() would change the level.
  bool is_widened(std::size_t index, const Box<D>& box) const {
    bool is_widened = false;
    for (int axis = 0; axis < D; ++axis)
      is_widened |= box.max[axis] - box.min[axis] >= levels_[index].extent[axis];
    return is_widened && index + 1 < count_;
  }

  /// Notes that the level has a box of this size. The last level needs no note: it is always searched whole.
  void widen(std::size_t index, const Box<D>& box) {
    if (!is_widened(index, box)) return;
    Level& level = levels_[index];
    for (int axis = 0; axis < D; ++axis) {
      const float extent = box.max[axis] - box.min[axis];
      if (extent >= level.extent[axis])
        level.extent[axis] = std::nextafter(extent, std::numeric_limits<float>::infinity());
    }
  }

  Level& operator[](std::size_t level) { return levels_[level]; }
  const Level& operator[](std::size_t level) const { return levels_[level]; }
  std::size_t count() const { return count_; }
  std::span<const Level> all() const { return {levels_.data(), count_}; }

  /// The length of the smallest cells.
  const std::array<float, D>& smallest_cell() const { return smallest_; }

  std::size_t bytes() const noexcept { return sampled_.capacity() * sizeof(Box<D>); }

 private:
  /// Boxes of the first level are up to `first_border` times as long as a typical box, and boxes of each
  /// further level up to `level_ratio` times as long as those of the level before.
  static constexpr float first_border = 2;
  static constexpr float level_ratio = 4;

  void measure(std::span<const Box<D>> like);
  void lay_out_level(std::size_t level);

  std::optional<double> cell_;
  core::Sample<D> sample_;
  std::vector<Box<D>> sampled_;
  std::array<float, D> typical_{};  // lengths of boxes, or more where boxes are sparse
  std::array<float, D> inverse_typical_{};
  std::array<float, D> smallest_{};
  std::array<Level, kernels::max_cell_levels> levels_{};
  std::array<double, kernels::max_cell_levels> factor_{};  // a cell's length in units of the longest box
  std::array<std::uint32_t, kernels::max_cell_levels> expected_{};  // how many boxes the cells are for
  std::size_t count_ = 1;
};

}  // namespace broadside::algorithm

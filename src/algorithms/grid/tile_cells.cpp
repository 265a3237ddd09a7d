// Chooses a tile's cells by what a search is estimated to cost.
#include "algorithms/grid/tile_cells.hpp"

#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>

namespace broadside::algorithm {
namespace {

constexpr float max_float = std::numeric_limits<float>::max();

/// The number of boxes that are looked at.
constexpr std::size_t max_looked_at = 1024;

/// The cost of a box in a row, in comparisons of a box with a vector of others.
constexpr float reference_cost = 3;

/// How many boxes are compared with one at a time.
constexpr float at_once = 16;

constexpr float max_rows = 256;
constexpr float min_boxes_per_row = 32;

/// Neither 0 nor infinite if `high` > `low`, as a float may be.
double range_of(float low, float high) { return static_cast<double>(high) - low; }

core::CellAxis cell_axis(float low, float high, float cells) {
  const double range = range_of(low, high);
  // Neither zero nor infinite: the product with an infinite or a zero distance would be NaN.
  const double per_unit =
      std::clamp<double>(range > 0 ? cells / range : 1, std::numeric_limits<float>::min(), max_float);
  return {.low = low, .per_unit = static_cast<float>(per_unit), .last = cells - 1};
}

}  // namespace

template <int D>
TileStats<D> TileStats<D>::of(std::span<const Box<D>> boxes) {
  const std::size_t count = std::min(boxes.size(), max_looked_at);
  const auto look = [&]<bool OnlyFinite>(std::bool_constant<OnlyFinite>) {
    TileStats stats;
    stats.low.fill(max_float);
    stats.high.fill(-max_float);
    stats.side.fill(0);
    for (std::size_t i = 0; i < count; ++i) {
      const Box<D>& box = boxes[core::sampled_place(i, count, boxes.size())];
      for (int axis = 0; axis < D; ++axis) {
        const float min = box.min[axis];
        const float length = box.max[axis] - min;
        if constexpr (OnlyFinite) {
          stats.low[axis] = min < stats.low[axis] && min >= -max_float ? min : stats.low[axis];
          stats.high[axis] = min > stats.high[axis] && min <= max_float ? min : stats.high[axis];
          stats.side[axis] += length <= max_float ? length : 0;
        } else {
          stats.low[axis] = std::min(stats.low[axis], min);
          stats.high[axis] = std::max(stats.high[axis], min);
          stats.side[axis] += length;
        }
      }
    }
    return stats;
  };
  // Without branches; again if something was infinite, which does not count.
  TileStats stats = look(std::false_type());
  for (int axis = 0; axis < D; ++axis) {
    if (stats.low[axis] >= -max_float && stats.high[axis] <= max_float && stats.side[axis] <= max_float)
      continue;
    stats = look(std::true_type());
    break;
  }
  for (float& side : stats.side) side = std::min(side / static_cast<float>(count), max_float);
  return stats;
}

template <int D>
TileStats<D> TileStats<D>::of(const core::Sample<D>& sample) {
  TileStats stats;
  for (int axis = 0; axis < D; ++axis) {
    stats.low[axis] = sample[axis].low;
    stats.high[axis] = sample[axis].high;
    stats.side[axis] = static_cast<float>(std::min<double>(sample[axis].mean_extent, max_float));
  }
  return stats;
}

template <int D>
bool TileStats<D>::is_narrower_than(const TileStats& other) const {
  for (int axis = 0; axis < D; ++axis) {
    if (2 * range_of(low[axis], high[axis]) <= range_of(other.low[axis], other.high[axis])) return true;
  }
  return false;
}

template <int D>
TileCells<D> TileCells<D>::choose(const TileStats<D>& stats, std::size_t boxes) {
  const auto count = static_cast<float>(boxes);
  // The share of an axis that a box takes, which is about the chance that another begins within it.
  std::array<float, D> share;
  TileCells cells;
  for (int axis = 0; axis < D; ++axis) {
    const double range = range_of(stats.low[axis], stats.high[axis]);
    share[axis] = range > 0 ? static_cast<float>(std::min(1.0, stats.side[axis] / range)) : 1;
    cells.axes[axis] = axis;
  }
  std::sort(cells.axes.begin(), cells.axes.end(),
            [&](int a, int b) { return std::pair(share[a], a) < std::pair(share[b], b); });

  const float swept = count * share[cells.axes[0]];
  const auto cost_of = [](float references, float tests) {
    return references * (reference_cost + std::max(1.0F, tests / at_once + 0.5F));
  };
  std::array<float, across> best;
  best.fill(1);
  float best_cost = cost_of(1, swept);
  const float row_limit = std::min(max_rows, count / min_boxes_per_row);
  // `width`: of a row, in boxes.
  for (float width = 2; swept > at_once && width < 256; width *= 1.25F) {
    std::array<float, across> rows;
    float all_rows = 1;
    float references = 1;
    float tests = swept;
    for (int axis = 0; axis < across; ++axis) {
      const float of_row = width * share[cells.axes[axis + 1]];
      rows[axis] = of_row * 2 <= 1 ? static_cast<float>(static_cast<int>(std::min(1 / of_row, max_rows))) : 1;
      all_rows *= rows[axis];
      if (rows[axis] == 1) continue;
      const float in_row = 1 + share[cells.axes[axis + 1]] * rows[axis];
      references *= in_row;
      tests *= in_row / rows[axis];
    }
    if (all_rows > row_limit) continue;
    const float cost = cost_of(references, tests);
    if (cost < best_cost) {
      best = rows;
      best_cost = cost;
    }
    if (all_rows == 1) break;
  }
  float all_rows = 1;
  for (int axis = 0; axis < across; ++axis) {
    cells.row_axes[axis] =
        cell_axis(stats.low[cells.axes[axis + 1]], stats.high[cells.axes[axis + 1]], best[axis]);
    all_rows *= best[axis];
  }
  float buckets = min_buckets;
  while (buckets * all_rows < count) buckets *= 2;
  cells.buckets = cell_axis(stats.low[cells.axes[0]], stats.high[cells.axes[0]], buckets);
  return cells;
}

template struct TileStats<2>;
template struct TileStats<3>;
template struct TileCells<2>;
template struct TileCells<3>;

}  // namespace broadside::algorithm

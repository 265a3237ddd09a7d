// Parameters derived from the boxes: typical extents and cell sizes.
#include "lab/peers/typical_extent.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

namespace broadside::lab::peers {
namespace {

template <int D>
double longest_side(const Box<D>& box) {
  double longest = 0;
  for (int axis = 0; axis < D; ++axis) longest = std::max(longest, double{box.max[axis]} - box.min[axis]);
  return longest;
}

/// The maximum absolute coordinate and the longest side of the world, without infinite coordinates.
template <int D>
std::array<double, 2> reach(std::span<const Box<D>> boxes) {
  double greatest = 0;
  double side = 0;
  for (int axis = 0; axis < D; ++axis) {
    const auto [min, max] = range_on(axis, boxes);
    greatest = std::max({greatest, std::abs(min), std::abs(max)});
    side = std::max(side, max - min);
  }
  return {greatest, side};
}

/// An upper bound on the total number of cells that the boxes touch: ignores their offsets within cells.
template <int D>
double cells_touched(std::span<const Box<D>> boxes, double cell) {
  double sum = 0;
  for (const Box<D>& box : boxes) {
    double cells = is_present(box) ? 1 : 0;
    for (int axis = 0; axis < D; ++axis)
      cells *= 2 + std::floor((double{box.max[axis]} - box.min[axis]) / cell);
    sum += cells;
  }
  return sum;
}

}  // namespace

template <int D>
std::array<double, 2> range_on(int axis, std::span<const Box<D>> boxes) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Box<D>& box : boxes) {
    if (!is_present(box)) continue;
    for (const double at : {box.min[axis], box.max[axis]}) {
      if (std::isinf(at)) continue;
      low = std::min(low, at);
      high = std::max(high, at);
    }
  }
  return low <= high ? std::array{low, high} : std::array{0.0, 0.0};
}

template <int D>
std::array<int, D> axes_by_extent(std::span<const Box<D>> boxes) {
  std::array<double, D> extents{};
  for (int axis = 0; axis < D; ++axis) {
    const auto [low, high] = range_on(axis, boxes);
    extents[axis] = high - low;
  }
  std::array<int, D> axes{};
  std::iota(axes.begin(), axes.end(), 0);
  std::ranges::stable_sort(axes, std::greater(), [&](int axis) { return extents[axis]; });
  return axes;
}

template <int D>
double typical_extent(std::span<const Box<D>> boxes) {
  constexpr std::size_t max_samples = 1000;
  std::vector<double> sides;
  const std::size_t step = boxes.size() / max_samples + 1;
  for (std::size_t i = 0; i < boxes.size(); i += step) {
    const double side = is_present(boxes[i]) ? longest_side(boxes[i]) : 0;
    if (is_present(boxes[i]) && std::isfinite(side)) sides.push_back(side);
  }
  if (sides.empty()) return 1;
  const auto middle = sides.begin() + static_cast<std::ptrdiff_t>(sides.size() / 2);
  std::nth_element(sides.begin(), middle, sides.end());
  if (*middle > 0) return *middle;
  const double side = reach(boxes)[1];
  return side > 0 ? side / std::pow(static_cast<double>(boxes.size()), 1.0 / D) : 1;
}

template <int D>
double cell_size(std::span<const Box<D>> boxes, double extents) {
  constexpr double max_cells = 0x1p20;
  constexpr double max_references = 8 << D;
  double cell = std::max(extents * typical_extent(boxes), reach(boxes)[0] / (max_cells / 4));
  while (cells_touched(boxes, cell) > max_references * static_cast<double>(boxes.size())) cell *= 2;
  return cell;
}

template std::array<double, 2> range_on<2>(int, std::span<const Box2>);
template std::array<double, 2> range_on<3>(int, std::span<const Box3>);
template std::array<int, 2> axes_by_extent<2>(std::span<const Box2>);
template std::array<int, 3> axes_by_extent<3>(std::span<const Box3>);
template double typical_extent<2>(std::span<const Box2>);
template double typical_extent<3>(std::span<const Box3>);
template double cell_size<2>(std::span<const Box2>, double);
template double cell_size<3>(std::span<const Box3>, double);

}  // namespace broadside::lab::peers

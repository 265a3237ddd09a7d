// The world of the paper's grid and quadtree.
#include "paper/listings/world.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace broadside::paper {
namespace {

/// Begin and length of the world on one axis.
std::pair<double, double> extent(std::span<const Box2> boxes, int axis, std::optional<double> begin,
                                 std::optional<double> length) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  double min_x = infinity;
  double max_x = -infinity;
  for (const Box2& box : boxes) {
    for (const float x : {box.min[axis], box.max[axis]}) {
      if (!std::isfinite(x)) continue;
      min_x = std::min<double>(min_x, x);
      max_x = std::max<double>(max_x, x);
    }
  }
  if (min_x > max_x) min_x = max_x = begin.value_or(0);
  const double from = begin.value_or(min_x);
  const double wide = length.value_or(max_x - from);
  return {from, wide > 0 ? wide : 1};
}

}  // namespace

std::vector<Tunable> world_tunables() {
  constexpr double max_float = std::numeric_limits<float>::max();
  return {
      {.name = "left",
       .summary = "least x of the world",
       .default_value = "auto",
       .min = -max_float,
       .max = max_float},
      {.name = "top",
       .summary = "least y of the world",
       .default_value = "auto",
       .min = -max_float,
       .max = max_float},
      {.name = "width", .summary = "extent of the world in x", .default_value = "auto", .max = max_float},
      {.name = "height", .summary = "extent of the world in y", .default_value = "auto", .max = max_float},
  };
}

WorldSettings::WorldSettings(const Settings& settings)
    : left_(settings.optional_number("left")),
      top_(settings.optional_number("top")),
      width_(settings.optional_number("width")),
      height_(settings.optional_number("height")) {}

World WorldSettings::around(std::span<const Box2> boxes) const {
  const auto [left, width] = extent(boxes, 0, left_, width_);
  const auto [top, height] = extent(boxes, 1, top_, height_);
  return {left, top, width, height};
}

}  // namespace broadside::paper

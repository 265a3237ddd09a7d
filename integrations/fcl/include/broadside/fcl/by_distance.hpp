// Pairs of boxes in ascending order of distance, computed lazily.
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/index.hpp"
#include "broadside/pair.hpp"

namespace broadside::detail {

/// The distance of two boxes as fcl::AABB<S>::distance() computes it, including rounding.
template <typename S>
S distance_of(const Box<3, S>& a, const Box<3, S>& b) {
  S sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    S gap = 0;
    if (a.min[axis] > b.max[axis])
      gap = b.max[axis] - a.min[axis];
    else if (b.min[axis] > a.max[axis])
      gap = a.max[axis] - b.min[axis];
    sum += gap * gap;
  }
  return std::sqrt(sum);
}

/// The box enlarged by a margin and rounded outward. It overlaps every box whose distance_of() from `box` is
/// at most `margin`.
template <typename S>
Box<3, S> enlarged(Box<3, S> box, S margin) {
  constexpr S infinity = std::numeric_limits<S>::infinity();
  margin *= 1 + 8 * std::numeric_limits<S>::epsilon();  // more than the rounding error of distance_of()
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::isfinite(box.min[axis])) box.min[axis] = std::nextafter(box.min[axis] - margin, -infinity);
    if (std::isfinite(box.max[axis])) box.max[axis] = std::nextafter(box.max[axis] + margin, infinity);
  }
  return box;
}

/// The next search radius around `box` after `reached`: the distance of a nearby box beyond it, or as the
/// centres of some nearby boxes suggest; infinite if no box is farther. `boxes` are those of the index.
template <typename S>
S distance_beyond(const Box<3, S>& box, S reached, const BoxIndex<3, S>& index,
                  std::span<const Box<3, S>> boxes, std::optional<BoxId> except) {
  constexpr std::size_t first_count = 8;
  Point<3, S> centre;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const S middle = box.min[axis] / 2 + box.max[axis] / 2;
    centre[axis] = std::isfinite(middle) ? middle : 0;
  }
  S min_distance = std::numeric_limits<S>::infinity();
  std::vector<Neighbour> found;
  for (std::size_t count = first_count;; count *= first_count) {
    index.nearest(centre, count, found, {.except = except});
    for (const Neighbour& neighbour : found) {
      const S distance = distance_of(box, boxes[broadside::index(neighbour.box)]);
      if (distance > reached) min_distance = std::min(min_distance, distance);
    }
    if (found.size() < count || std::isfinite(min_distance)) return min_distance;
    const S farthest = std::sqrt(found.back().distance_squared);
    if (farthest > reached) return farthest;
  }
}

/// Two boxes and their distance.
template <typename S>
struct DistantPair {
  S distance;
  std::size_t first;
  std::size_t second;

  friend auto operator<=>(const DistantPair&, const DistantPair&) = default;
};

/// Calls `visit(pair, min_distance)` for pairs in ascending order of distance, until it returns true or the
/// next pair is not closer than `min_distance`, which it may lower: best-first branch and bound.
///
/// Pairs come from `gather(radius, pairs)`, which appends all pairs with a distance of at most `radius` and
/// perhaps others, for growing radii. Each ring is at least twice as wide as the one before, so pairs
/// gathered again cost no more than new ones. `beyond(reached)` suggests the radius of the next ring, by the
/// existing boxes; it is infinite if nothing is left.
template <typename S, typename Gather, typename Beyond, typename Visit>
void visit_by_distance(const Gather& gather, const Beyond& beyond, const Visit& visit) {
  S min_distance = std::numeric_limits<S>::max();
  S reached = -1;
  // Squares of smaller distances vanish, so such pairs come first together.
  S radius = std::sqrt(std::numeric_limits<S>::min());
  std::vector<DistantPair<S>> pairs;
  for (;;) {
    pairs.clear();
    gather(radius, pairs);
    std::erase_if(pairs, [&](const DistantPair<S>& pair) {
      return !(pair.distance > reached && pair.distance <= radius && pair.distance < min_distance);
    });
    std::ranges::sort(pairs);
    for (const DistantPair<S>& pair : pairs) {
      if (!(pair.distance < min_distance) || visit(pair, min_distance)) return;
    }
    if (radius >= min_distance) return;
    reached = radius;
    radius *= 2;
    if (radius < min_distance) radius = std::max(radius, beyond(reached));
    radius = std::min(radius, min_distance);
  }
}

}  // namespace broadside::detail

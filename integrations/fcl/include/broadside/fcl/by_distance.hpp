// Pairs of boxes in the order of their distances, as far as somebody wants them.
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

/// The distance of two boxes as fcl::AABB<S>::distance() computes it, rounding included.
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

/// The box with a margin, rounded outward. Every box whose distance_of() from `box` is at most `margin`
/// overlaps it.
template <typename S>
Box<3, S> enlarged(Box<3, S> box, S margin) {
  constexpr S infinity = std::numeric_limits<S>::infinity();
  margin *= 1 + 8 * std::numeric_limits<S>::epsilon();  // more than distance_of() loses by rounding
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (std::isfinite(box.min[axis])) box.min[axis] = std::nextafter(box.min[axis] - margin, -infinity);
    if (std::isfinite(box.max[axis])) box.max[axis] = std::nextafter(box.max[axis] + margin, infinity);
  }
  return box;
}

/// How far from `box` to look next, after `reached`: as far as a near box that is farther than that, or as
/// the centres of some near boxes suggest; infinite if none is farther. `boxes` are those of the index.
template <typename S>
S distance_beyond(const Box<3, S>& box, S reached, const BoxIndex<3, S>& index,
                  std::span<const Box<3, S>> boxes, std::optional<BoxId> except) {
  constexpr std::size_t first_count = 8;
  Point<3, S> centre;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const S middle = box.min[axis] / 2 + box.max[axis] / 2;
    centre[axis] = std::isfinite(middle) ? middle : 0;
  }
  S least = std::numeric_limits<S>::infinity();
  std::vector<Neighbour<S>> found;
  for (std::size_t count = first_count;; count *= first_count) {
    index.nearest(centre, count, found, {.except = except});
    for (const Neighbour<S>& neighbour : found) {
      const S distance = distance_of(box, boxes[broadside::index(neighbour.box)]);
      if (distance > reached) least = std::min(least, distance);
    }
    if (found.size() < count || std::isfinite(least)) return least;
    const S farthest = std::sqrt(found.back().distance_squared);
    if (farthest > reached) return farthest;
  }
}

/// Two boxes, and how far they are from each other.
template <typename S>
struct DistantPair {
  S distance;
  std::size_t first;
  std::size_t second;

  friend auto operator<=>(const DistantPair&, const DistantPair&) = default;
};

/// Calls `visit(pair, least)` for pairs in ascending order of their distances, until it returns true or the
/// next pair is not closer than `least`, which it may lower: branch and bound, best first.
///
/// Pairs come from `gather(radius, pairs)`, which appends those whose distance is at most `radius` and
/// perhaps others, for growing radii: each ring at least twice as wide as the last one, so that what is
/// gathered again costs no more than what is new. `beyond(reached)` suggests how far the next ring should
/// reach, by the boxes there are; it is infinite where nothing is left.
template <typename S, typename Gather, typename Beyond, typename Visit>
void visit_by_distance(const Gather& gather, const Beyond& beyond, const Visit& visit) {
  S least = std::numeric_limits<S>::max();
  S reached = -1;
  // Squares of distances below this one vanish, so such pairs come first together.
  S radius = std::sqrt(std::numeric_limits<S>::min());
  std::vector<DistantPair<S>> pairs;
  for (;;) {
    pairs.clear();
    gather(radius, pairs);
    std::erase_if(pairs, [&](const DistantPair<S>& pair) {
      return !(pair.distance > reached && pair.distance <= radius && pair.distance < least);
    });
    std::ranges::sort(pairs);
    for (const DistantPair<S>& pair : pairs) {
      if (!(pair.distance < least) || visit(pair, least)) return;
    }
    if (radius >= least) return;
    reached = radius;
    radius *= 2;
    if (radius < least) radius = std::max(radius, beyond(reached));
    radius = std::min(radius, least);
  }
}

}  // namespace broadside::detail

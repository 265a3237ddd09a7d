// The tracker of the quadtree.
#pragma once

#include <cstdint>
#include <memory>

#include "broadside/tracker.hpp"

namespace broadside::algorithm {

/// A tracker that keeps a tree whose leaves hold up to `capacity` boxes.
template <int D>
std::unique_ptr<PairTracker<D>> make_quadtree_tracker(std::uint32_t capacity);

/// The capacity where none is given. Smaller than the finder's, which sweeps a leaf once for all of its
/// boxes.
inline constexpr std::uint32_t tracking_capacity = 32;

}  // namespace broadside::algorithm

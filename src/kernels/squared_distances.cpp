// Squared distances of given pairs of boxes or points. No vectors: a pair has few coordinates, from two
// places.
#include "kernels/squared_distances.hpp"

#include <algorithm>

#include <hwy/cache_control.h>

namespace broadside::kernels {
namespace {

/// How many pairs ahead shapes are prefetched. Searches write neighbours one after the other, but their
/// shapes may be anywhere in the array.
constexpr std::size_t distances_ahead = 64;

/// Larger shapes may well lie in two cache lines, which are both prefetched.
constexpr std::size_t max_prefetched_once = 24;

template <typename Shape>
void prefetch(const Shape& shape) {
  hwy::Prefetch(&shape);
  if constexpr (sizeof(Shape) > max_prefetched_once)
    hwy::Prefetch(reinterpret_cast<const char*>(&shape + 1) - 1);
}

}  // namespace

template <typename Shape>
void set_squared_distances(const Shape* left, const Shape* right, std::span<const Pair> pairs,
                           double* squares) {
  const auto prefetch_pair = [&](std::size_t i) {
    prefetch(left[index(pairs[i].first)]);
    prefetch(right[index(pairs[i].second)]);
  };
  for (std::size_t i = 0; i < std::min(distances_ahead, pairs.size()); ++i) prefetch_pair(i);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i + distances_ahead < pairs.size()) prefetch_pair(i + distances_ahead);
    squares[i] = squared_distance(left[index(pairs[i].first)], right[index(pairs[i].second)]);
  }
}

#define BROADSIDE_SQUARED_DISTANCES(D, Real)                                                               \
  template void set_squared_distances(const Box<D, Real>*, const Box<D, Real>*, std::span<const Pair>,     \
                                      double*);                                                            \
  template void set_squared_distances(const Point<D, Real>*, const Point<D, Real>*, std::span<const Pair>, \
                                      double*);
BROADSIDE_SQUARED_DISTANCES(2, float)
BROADSIDE_SQUARED_DISTANCES(3, float)
BROADSIDE_SQUARED_DISTANCES(2, double)
BROADSIDE_SQUARED_DISTANCES(3, double)
#undef BROADSIDE_SQUARED_DISTANCES

}  // namespace broadside::kernels

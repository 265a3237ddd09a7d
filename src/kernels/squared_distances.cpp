// Squared distances of given pairs of boxes. No vectors: a pair has few coordinates, from two places.
#include "kernels/squared_distances.hpp"

#include <algorithm>

#include <hwy/cache_control.h>

namespace broadside::kernels {
namespace {

/// How many pairs ahead boxes are prefetched. Searches write neighbours one after the other, but their boxes
/// may be anywhere in the array.
constexpr std::size_t distances_ahead = 64;

/// A box may lie in two cache lines.
template <typename Box>
void prefetch(const Box& box) {
  hwy::Prefetch(&box);
  hwy::Prefetch(reinterpret_cast<const char*>(&box + 1) - 1);
}

}  // namespace

template <int D, typename Real>
void set_squared_distances(const Box<D, Real>* left, const Box<D, Real>* right, std::span<const Pair> pairs,
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

template void set_squared_distances(const Box2*, const Box2*, std::span<const Pair>, double*);
template void set_squared_distances(const Box3*, const Box3*, std::span<const Pair>, double*);
template void set_squared_distances(const DoubleBox2*, const DoubleBox2*, std::span<const Pair>, double*);
template void set_squared_distances(const DoubleBox3*, const DoubleBox3*, std::span<const Pair>, double*);

}  // namespace broadside::kernels

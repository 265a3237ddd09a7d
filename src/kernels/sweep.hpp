// The kernels: they sweep a sorted run against itself or another run, or compare all boxes of a run.
#pragma once

#include <cstdint>

#include "broadside/pair.hpp"

#include "kernels/run.hpp"

namespace broadside::kernels {

/// Reports the pairs of overlapping boxes within a run that is sorted by min[0], except pairs that
/// `dedup_mask` rules out and, if the run has doubles, pairs that are apart in double. Returns the number of
/// pairs of boxes compared.
template <int D>
std::uint64_t sweep(const Run<D>& run, PairSink& pairs);

/// Likewise reports the pairs of a box of `a` and one of `b`, both sorted by min[0], with the same doubles.
template <int D>
std::uint64_t sweep(const Run<D>& a, const Run<D>& b, PairSink& pairs);

/// Reports the pairs of overlapping boxes within a run in any order, by comparing all of them. Ignores
/// `dedup_mask`.
template <int D>
std::uint64_t compare_all(const Run<D>& run, PairSink& pairs);

/// Likewise reports the pairs of a box of `a` and one of `b`.
template <int D>
std::uint64_t compare_all(const Run<D>& a, const Run<D>& b, PairSink& pairs);

}  // namespace broadside::kernels

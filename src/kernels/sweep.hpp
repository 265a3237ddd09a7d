// The kernels: a sorted run swept against itself or against another, and one box against a run.
#pragma once

#include <cstdint>

#include "broadside/pair.hpp"

#include "kernels/run.hpp"

namespace broadside::kernels {

/// Reports the pairs of overlapping boxes within a run that is sorted by min[0], except those that
/// `dedup_mask` rules out and, where the run has doubles, those that are apart in double. Returns the number
/// of pairs of boxes compared.
template <int D>
std::uint64_t sweep(const Run<D>& run, PairSink& pairs);

/// Likewise the pairs of one box of `a` and one of `b`, both sorted by min[0], with the same doubles.
template <int D>
std::uint64_t sweep(const Run<D>& a, const Run<D>& b, PairSink& pairs);

/// Reports the pairs of overlapping boxes within a run in any order, by comparing all of them; `dedup_mask`
/// is not looked at.
template <int D>
std::uint64_t compare_all(const Run<D>& run, PairSink& pairs);

/// Likewise the pairs of one box of `a` and one of `b`.
template <int D>
std::uint64_t compare_all(const Run<D>& a, const Run<D>& b, PairSink& pairs);

}  // namespace broadside::kernels

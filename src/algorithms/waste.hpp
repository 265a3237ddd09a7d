// Whether a sweep is worth its tests.
#pragma once

#include <cstdint>

#include "kernels/run.hpp"

namespace broadside::algorithm {

/// The tests that a search may make for each of its boxes and for each pair. Up to these it costs no more
/// than twice what evenly spread boxes do, so a search that gives up has lost little.
inline constexpr std::uint64_t tests_per_box = 256;
inline constexpr std::uint64_t tests_per_pair = 32;

/// Whether a sweep of the run would make more than `limit` tests, few of which find a pair: counts the tests,
/// to within a bucket of each box, and tries a sample of them where they are many. Cost: O(n log n) at most,
/// O(n / 16) where tests are few.
template <int D>
bool is_wasteful(const kernels::Run<D>& run, std::uint64_t limit);

}  // namespace broadside::algorithm

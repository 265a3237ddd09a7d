// Decides whether a sweep is worth its tests.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/sample.hpp"
#include "kernels/run.hpp"

namespace broadside::algorithm {

/// The tests that a search may make per box and per pair before it gives up. Up to these limits it takes at
/// most twice as long as with evenly spread boxes, so a search that gives up has lost little.
inline constexpr std::uint64_t max_tests_per_box = 256;
inline constexpr std::uint64_t max_tests_per_pair = 32;

/// The end of the boxes that begin no later than `last`, by a galloping search from `from`. Boxes may be in
/// any order within a bucket, so the result is exact to within a bucket.
inline std::size_t end_of_reach(const float* minima, std::size_t size, std::size_t from, float last) {
  std::size_t step = 16;
  while (from + step < size && minima[from + step] <= last) {
    from += step;
    step *= 2;
  }
  const float* const end = minima + std::min(from + step, size);
  return static_cast<std::size_t>(std::upper_bound(minima + std::min(from, size), end, last) - minima);
}

/// An upper bound of a sweep's tests, from the greatest maximum of each `together` boxes. Stops above
/// `limit`.
template <int D>
std::uint64_t bound_of_tests(const kernels::Run<D>& run, std::uint64_t limit, std::size_t together) {
  std::uint64_t tests = 0;
  for (std::size_t i = 0; i < run.size && tests <= limit; i += together) {
    const std::size_t end = std::min(i + together, run.size);
    const float last = *std::max_element(run.max[0] + i, run.max[0] + end);
    tests += (end_of_reach(run.min[0], run.size, i, last) - i) * (end - i);
  }
  return tests;
}

/// Whether few of a sweep's tests would find a pair, in a sample of them: of 32 boxes, each with up to
/// `max_tests_of_one` others. `end_of(place)` is the end of the boxes with which the one at that place is
/// compared.
template <int D, typename EndOf>
bool finds_few(const kernels::Run<D>& run, std::size_t max_tests_of_one, const EndOf& end_of) {
  constexpr std::size_t looked_at = 32;
  std::uint64_t tests = 0;
  std::uint64_t hits = 0;
  // A box that overlaps all others, such as a floor, says nothing about them. It begins first, so the first
  // place is not sampled, and the box with the most hits does not count.
  std::uint64_t tests_of_greatest = 0;
  std::uint64_t max_hits = 0;
  for (std::size_t i = 1; i <= looked_at; ++i) {
    const std::size_t at = core::sampled_place(i, run.size);
    std::uint64_t own_tests = 0;
    std::uint64_t own_hits = 0;
    const std::size_t end = std::max<std::size_t>(end_of(at), at);
    const std::size_t stride = (end - at) / max_tests_of_one + 1;
    for (std::size_t other = at + 1; other < end; other += stride) {
      // Without a branch, which would be unpredictable.
      bool overlaps = (run.dedup_mask[at] & run.dedup_mask[other]) == 0;
      for (int axis = 0; axis < D; ++axis) {
        overlaps &= run.min[axis][other] <= run.max[axis][at];
        overlaps &= run.min[axis][at] <= run.max[axis][other];
      }
      own_tests += stride;
      own_hits += overlaps ? stride : 0;
    }
    tests += own_tests;
    hits += own_hits;
    if (own_hits <= max_hits) continue;
    max_hits = own_hits;
    tests_of_greatest = own_tests;
  }
  return tests - tests_of_greatest > max_tests_per_pair * (hits - max_hits);
}

/// Whether a sweep of the run would make more than `limit` tests and few of them would find a pair. Counts
/// the tests, to within a bucket per box, and tries a sample of them if they are many. Cost: O(n log n) at
/// most, O(n / 16) where tests are few.
template <int D>
bool is_wasteful(const kernels::Run<D>& run, std::uint64_t limit) {
  if (std::uint64_t{run.size} * run.size / 2 <= limit) return false;
  if (bound_of_tests(run, limit, 16) <= limit || bound_of_tests(run, limit, 1) <= limit) return false;
  constexpr std::size_t max_tests_of_one = 4096;
  return finds_few(run, max_tests_of_one, [&run](std::size_t place) {
    return end_of_reach(run.min[0], run.size, place, run.max[0][place]);
  });
}

}  // namespace broadside::algorithm

// Prefix sums of counts, the middle of a counting sort: count, prefix_sum(), scatter.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

namespace broadside::core {

/// Replaces counts by the places from which to scatter (an exclusive prefix sum); returns the total. `counts`
/// has `buckets` counts for each range of items; there are several ranges if several threads count. In a
/// bucket, the items of one range come before those of the next.
template <typename Count>
Count prefix_sum(std::span<Count> counts, std::size_t buckets) {
  Count sum = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    for (std::size_t at = bucket; at < counts.size(); at += buckets) sum += std::exchange(counts[at], sum);
  }
  return sum;
}

}  // namespace broadside::core

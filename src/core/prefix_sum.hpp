// Prefix sums of counts, the middle of a counting sort: count, prefix_sum(), scatter.
#pragma once

#include <cstddef>
#include <span>
#include <utility>

namespace broadside::core {

/// Makes counts the places from which to scatter. `counts` are those of `buckets` buckets, range after range
/// where several threads count at once, each for a range of the items: in a bucket, the items of one range
/// stand before those of the next. Returns the sum.
template <typename Count>
Count prefix_sum(std::span<Count> counts, std::size_t buckets) {
  Count sum = 0;
  for (std::size_t bucket = 0; bucket < buckets; ++bucket) {
    for (std::size_t at = bucket; at < counts.size(); at += buckets) sum += std::exchange(counts[at], sum);
  }
  return sum;
}

}  // namespace broadside::core

// RadixSort: sorts the places of boxes by a float.
#include "core/radix_sort.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "core/prefix_sum.hpp"

namespace broadside::core {
namespace {

constexpr int digits = 3;
constexpr int digit_bits = 11;
constexpr std::size_t digit_values = std::size_t{1} << digit_bits;

/// Fewer places are sorted by comparison, which is then faster.
constexpr std::size_t min_radix_sorted = 128;

constexpr std::size_t digit(std::uint32_t key, int at) {
  return key >> (at * digit_bits) & (digit_values - 1);
}

}  // namespace

std::span<KeyedPlace> RadixSort::places(std::size_t count) {
  renew(places_, count);
  renew(other_, count);
  return places_;
}

std::span<const KeyedPlace> RadixSort::sort() {
  if (places_.size() < min_radix_sorted) {
    std::sort(places_.begin(), places_.end(), [](const KeyedPlace& a, const KeyedPlace& b) {
      return std::pair(a.key, a.place) < std::pair(b.key, b.place);
    });
    return places_;
  }
  // All histograms in one pass; a digit that all keys share needs no pass of its own.
  std::array<std::array<std::uint32_t, digit_values>, digits> counts{};
  for (const KeyedPlace& place : places_) {
    for (int at = 0; at < digits; ++at) ++counts[at][digit(place.key, at)];
  }
  for (int at = 0; at < digits; ++at) {
    if (counts[at][digit(places_.front().key, at)] == places_.size()) continue;
    prefix_sum(std::span<std::uint32_t>(counts[at]), digit_values);
    for (const KeyedPlace& place : places_) other_[counts[at][digit(place.key, at)]++] = place;
    places_.swap(other_);
  }
  return places_;
}

std::span<const KeyedPlace> RadixSort::sort(Parallel& parallel) {
  if (parallel.workers() == 1) return sort();
  for (int at = 0; at < digits; ++at) sort_by_ranges(parallel, at);
  return places_;
}

void RadixSort::sort_by_ranges(Parallel& parallel, int at) {
  const std::size_t ranges = parallel.range_count();
  counts_.resize(ranges * digit_values);
  parallel.for_numbered_ranges(places_.size(), [&](std::size_t number, Range range, std::size_t) {
    std::array<std::uint32_t, digit_values> counts{};  // shares no cache line with another worker
    for (std::size_t i = range.begin; i < range.end; ++i) ++counts[digit(places_[i].key, at)];
    std::copy(counts.begin(), counts.end(),
              counts_.begin() + static_cast<std::ptrdiff_t>(number * digit_values));
  });
  std::uint32_t total = 0;
  for (std::size_t bucket = 0; bucket < digit_values; ++bucket) {
    const std::uint32_t before = total;
    for (std::size_t number = 0; number < ranges; ++number)
      total += std::exchange(counts_[number * digit_values + bucket], total);
    if (total - before == places_.size()) return;  // a digit that all keys share
  }
  parallel.for_numbered_ranges(places_.size(), [&](std::size_t number, Range range, std::size_t) {
    std::uint32_t* const next = &counts_[number * digit_values];
    for (std::size_t i = range.begin; i < range.end; ++i)
      other_[next[digit(places_[i].key, at)]++] = places_[i];
  });
  places_.swap(other_);
}

}  // namespace broadside::core

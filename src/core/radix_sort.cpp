// Boxes' places sorted by a float, by a radix sort: O(n) whatever the values.
#include "core/radix_sort.hpp"

#include <array>

namespace broadside::core {
namespace {

constexpr int digits = 3;
constexpr int digit_bits = 11;
constexpr std::size_t buckets = std::size_t{1} << digit_bits;

constexpr std::size_t digit(std::uint32_t key, int at) { return key >> (at * digit_bits) & (buckets - 1); }

}  // namespace

std::span<KeyedPlace> RadixSort::places(std::size_t count) {
  places_.resize(count);
  other_.resize(count);
  return places_;
}

std::span<const KeyedPlace> RadixSort::sort() {
  // All histograms in one pass; a digit that all keys share needs no pass of its own.
  std::array<std::array<std::uint32_t, buckets>, digits> counts{};
  for (const KeyedPlace& place : places_) {
    for (int at = 0; at < digits; ++at) ++counts[at][digit(place.key, at)];
  }
  for (int at = 0; at < digits && !places_.empty(); ++at) {
    if (counts[at][digit(places_.front().key, at)] == places_.size()) continue;
    std::uint32_t begin = 0;
    for (std::uint32_t& count : counts[at]) {
      const std::uint32_t end = begin + count;
      count = begin;
      begin = end;
    }
    for (const KeyedPlace& place : places_) other_[counts[at][digit(place.key, at)]++] = place;
    places_.swap(other_);
  }
  return places_;
}

}  // namespace broadside::core

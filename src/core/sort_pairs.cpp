// Pairs sorted by their ids: by comparison where they are few, else by a radix sort from the lowest bits on.
#include "core/sort_pairs.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>

namespace broadside::core {
namespace {

constexpr int digit_bits = 11;
constexpr std::size_t buckets = std::size_t{1} << digit_bits;

/// Up to here comparing costs less than counting.
constexpr std::size_t few = 512;

/// Sorts `pairs` by a digit of one of their ids. Pairs of the same digit stay in order.
template <typename DigitOf>
void sort_by(std::vector<Pair>& pairs, std::vector<Pair>& scratch, DigitOf digit) {
  std::array<std::uint32_t, buckets> places{};
  for (const Pair pair : pairs) ++places[digit(pair)];
  std::exclusive_scan(places.begin(), places.end(), places.begin(), std::uint32_t{0});
  for (const Pair pair : pairs) scratch[places[digit(pair)]++] = pair;
  pairs.swap(scratch);
}

/// Sorts `pairs` by one of their ids.
template <typename IdOf>
void sort_by_id(std::vector<Pair>& pairs, std::vector<Pair>& scratch, std::uint32_t greatest, IdOf id) {
  for (int shift = 0; shift < 32 && greatest >> shift != 0; shift += digit_bits)
    sort_by(pairs, scratch, [=](Pair pair) { return index(id(pair)) >> shift & (buckets - 1); });
}

}  // namespace

void sort_unique(std::vector<Pair>& pairs, std::vector<Pair>& scratch) {
  // What is 2^32 or more does not fit the counts, and is never seen.
  if (pairs.size() <= few || pairs.size() > 0xffffffffU) {
    std::sort(pairs.begin(), pairs.end());
  } else {
    scratch.resize(pairs.size());
    std::uint32_t first = 0;
    std::uint32_t second = 0;
    for (const Pair pair : pairs) {
      first = std::max(first, index(pair.first));
      second = std::max(second, index(pair.second));
    }
    sort_by_id(pairs, scratch, second, [](Pair pair) { return pair.second; });
    sort_by_id(pairs, scratch, first, [](Pair pair) { return pair.first; });
  }
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}

}  // namespace broadside::core

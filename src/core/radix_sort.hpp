// RadixSort: sorts the places of boxes by a float in O(n), whatever the values.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/bit_cast.hpp"
#include "core/grow.hpp"
#include "core/large_array.hpp"
#include "core/parallel.hpp"

namespace broadside::core {

/// An integer key in the order of floats, for any value but NaN; -0.0 and 0.0 have the same key.
inline std::uint32_t sort_key(float value) noexcept {
  const auto bits = core::bit_cast<std::uint32_t>(value + 0.0F);
  return bits ^ (bits >> 31 != 0 ? 0xffffffffU : 0x80000000U);
}

/// A place in an array and its sort key.
struct KeyedPlace {
  std::uint32_t key;
  std::uint32_t place;
};

/// Sorts by key, then by place: a few by comparison, more by a counting pass for each 11-bit digit in which
/// the keys differ.
class RadixSort {
 public:
  /// Room for `count` places, to be filled in ascending order and sorted. Valid until the next call.
  std::span<KeyedPlace> places(std::size_t count);

  /// Sorts the places. The result is valid until the next call of places().
  std::span<const KeyedPlace> sort();

  /// The same with several workers.
  std::span<const KeyedPlace> sort(Parallel& parallel);

  /// The bytes held.
  std::size_t bytes() const noexcept { return bytes_of(places_, other_, counts_); }

 private:
  void sort_by_ranges(Parallel& parallel, int digit);

  LargeArray<KeyedPlace> places_;
  LargeArray<KeyedPlace> other_;
  std::vector<std::uint32_t> counts_;  // by range and bucket
};

}  // namespace broadside::core

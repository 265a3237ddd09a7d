// The radix sort of the algorithms from the literature: sorts indices by integer keys.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace broadside::lab::literature {

/// Maps a float other than NaN to a signed integer with the same order; -0.0 and 0.0 map to the same one.
/// Infinities map to values between -`beyond_floats` and `beyond_floats`.
inline std::int32_t ordered(float value) noexcept {
  const auto bits = std::bit_cast<std::int32_t>(value + 0.0F);
  return bits ^ ((bits >> 31) & 0x7fffffff);
}

/// Greater than ordered() of any float, including infinity: a sentinel that ends every scan.
inline constexpr std::int32_t beyond_floats = 0x7fffffff;

/// ordered() as an unsigned key.
inline std::uint32_t sort_key(float value) noexcept {
  return static_cast<std::uint32_t>(ordered(value)) ^ 0x80000000U;
}

/// A stable sort of indices by unsigned keys: one counting pass for each 11 bits in which the keys differ.
template <typename Key>
class RadixSort {
 public:
  struct KeyedPlace {
    Key key;
    std::uint32_t place;
  };

  /// Returns `count` entries to fill in before sort(). Valid until the next call.
  std::span<KeyedPlace> entries(std::size_t count) {
    entries_.resize(count);
    return entries_;
  }

  /// Sorts the entries. The result is valid until the next call of entries().
  std::span<const KeyedPlace> sort() {
    for (auto& counts : counts_) counts.fill(0);
    for (const KeyedPlace& entry : entries_) {
      for (std::size_t pass = 0; pass < passes; ++pass) ++counts_[pass][digit(entry.key, pass)];
    }
    other_.resize(entries_.size());
    for (std::size_t pass = 0; pass < passes; ++pass) {
      auto& counts = counts_[pass];
      if (entries_.empty() || counts[digit(entries_[0].key, pass)] == entries_.size()) continue;
      std::uint32_t begin = 0;
      for (std::uint32_t& count : counts) {
        const std::uint32_t next = begin + count;
        count = begin;
        begin = next;
      }
      for (const KeyedPlace& entry : entries_) other_[counts[digit(entry.key, pass)]++] = entry;
      entries_.swap(other_);
    }
    return entries_;
  }

 private:
  static constexpr int digit_bits = 11;
  static constexpr std::size_t passes = (sizeof(Key) * 8 + digit_bits - 1) / digit_bits;

  static std::size_t digit(Key key, std::size_t pass) noexcept {
    return static_cast<std::size_t>(key >> (pass * digit_bits)) & ((std::size_t{1} << digit_bits) - 1);
  }

  std::vector<KeyedPlace> entries_;
  std::vector<KeyedPlace> other_;
  std::array<std::array<std::uint32_t, std::size_t{1} << digit_bits>, passes> counts_;
};

}  // namespace broadside::lab::literature

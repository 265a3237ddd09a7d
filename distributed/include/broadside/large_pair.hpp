// Pairs of boxes with 64-bit ids, for sets of more than 2^32 boxes.
#pragma once

#include <algorithm>
#include <compare>
#include <cstdint>
#include <vector>

#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"

namespace broadside {

/// Ids of two boxes, like Pair but with 64 bits.
struct LargePair {
  std::uint64_t first;
  std::uint64_t second;

  friend constexpr auto operator<=>(const LargePair&, const LargePair&) = default;
};

/// Sorts by first, then by second id. `scratch` is unused; it matches the signature for Pair.
inline void sort_pairs(std::vector<LargePair>& pairs, std::vector<LargePair>& /* scratch */) {
  std::sort(pairs.begin(), pairs.end());
}

/// A pair's contribution to the hash of a set. Equals hash(Pair) if both ids fit into 32 bits.
constexpr std::uint64_t hash(const LargePair& pair) noexcept {
  const auto low = [](std::uint64_t id) { return BoxId(static_cast<std::uint32_t>(id)); };
  const std::uint64_t bits = hash(Pair{low(pair.first), low(pair.second)});
  const std::uint64_t high = (pair.first >> 32) << 32 | pair.second >> 32;
  if (high == 0) return bits;
  return hash(Pair{low(bits ^ high), low((bits ^ high) >> 32)});
}

}  // namespace broadside

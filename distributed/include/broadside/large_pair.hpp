// A pair of boxes with 64-bit ids, for sets of more than 2^32 boxes.
#pragma once

#include <compare>
#include <cstdint>

namespace broadside {

/// Ids of two boxes, as Pair has them in 32 bits.
struct LargePair {
  std::uint64_t first;
  std::uint64_t second;

  friend constexpr auto operator<=>(const LargePair&, const LargePair&) = default;
};

}  // namespace broadside

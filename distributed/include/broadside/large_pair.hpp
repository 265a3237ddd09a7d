// A pair of boxes whose numbers need 64 bits: of more boxes than one search takes.
#pragma once

#include <compare>
#include <cstdint>

#include "broadside/pair.hpp"
#include "broadside/sinks.hpp"

namespace broadside {

/// Two boxes by their numbers; what numbers them says whether first < second.
struct LargePair {
  std::uint64_t first;
  std::uint64_t second;

  friend constexpr auto operator<=>(const LargePair&, const LargePair&) = default;
};

/// One pair's contribution to the hash of a set, as hash(Pair): the same as that where 32 bits hold both
/// numbers.
constexpr std::uint64_t hash(const LargePair& pair) noexcept {
  const auto low = [](std::uint64_t number) { return BoxId(static_cast<std::uint32_t>(number)); };
  const std::uint64_t bits = hash(Pair{low(pair.first), low(pair.second)});
  const std::uint64_t high = (pair.first >> 32) << 32 | pair.second >> 32;
  if (high == 0) return bits;
  return hash(Pair{low(bits ^ high), low((bits ^ high) >> 32)});
}

}  // namespace broadside

// Handles as JavaScript has them: whole numbers, which are keys of its maps and elements of a Float64Array.
#pragma once

#include <cstdint>
#include <string>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

namespace broadside::wasm {

/// A handle is its slot and, above it, its generation counted from `min_generation`: 53 bits, as a double
/// has.
inline constexpr int slot_bits = 24;
inline constexpr std::uint32_t max_slots = 1U << slot_bits;
inline constexpr int generation_bits = 53 - slot_bits;

/// A slot whose generations are used up, at 2^32, is not used again: so those of a handle are the last ones.
inline constexpr std::uint32_t min_generation = 0U - (1U << generation_bits);

inline double number_of(const Handle& handle) noexcept {
  return static_cast<double>(std::uint64_t{handle.generation - min_generation} << slot_bits | handle.slot);
}

/// Whether a number is a handle of some world.
inline bool is_handle(double number) noexcept {
  return number >= 0 && number < 0x1p53 && static_cast<double>(static_cast<std::uint64_t>(number)) == number;
}

/// Throws InvalidHandle if the number is no handle of any world.
inline Handle handle_of(double number) {
  if (!is_handle(number))
    throw InvalidHandle("a handle that no world gave; expected a number that add() returned");
  const auto bits = static_cast<std::uint64_t>(number);
  return {static_cast<std::uint32_t>(bits) & (max_slots - 1),
          static_cast<std::uint32_t>(bits >> slot_bits) + min_generation};
}

/// Where the generations of the next world's handles begin: far from those of others, so that it refuses
/// them, with half of all generations above.
inline std::uint32_t next_first_generation() noexcept {
  static std::uint32_t worlds = 0;
  // The golden ratio's multiples are far apart, however many there are.
  return min_generation + (++worlds * 0x9e3779b9U >> (32 - generation_bits + 1));
}

}  // namespace broadside::wasm

// Handles in JavaScript: whole numbers, which can be keys of a Map and elements of a Float64Array.
#pragma once

#include <cstdint>
#include <string>

#include "broadside/error.hpp"
#include "broadside/world.hpp"

namespace broadside::wasm {

/// A handle has its slot in the low bits and its generation, counted from `min_generation`, above it: 53 bits
/// in all, as many as a double holds.
inline constexpr int slot_bits = 24;
inline constexpr std::uint32_t max_slots = 1U << slot_bits;
inline constexpr int generation_bits = 53 - slot_bits;

/// A slot is not reused once its generation reaches 2^32, so handles have the last generations below it.
inline constexpr std::uint32_t min_generation = 0U - (1U << generation_bits);

inline double number_of(const Handle& handle) noexcept {
  return static_cast<double>(std::uint64_t{handle.generation - min_generation} << slot_bits | handle.slot);
}

/// Whether a number may be a handle of some world.
inline bool is_handle(double number) noexcept {
  return number >= 0 && number < 0x1p53 && static_cast<double>(static_cast<std::uint64_t>(number)) == number;
}

/// Throws InvalidHandle if the number cannot be a handle of any world.
inline Handle handle_of(double number) {
  if (!is_handle(number))
    throw InvalidHandle("not a handle of any world; expected a number that add() returned");
  const auto bits = static_cast<std::uint64_t>(number);
  return {static_cast<std::uint32_t>(bits) & (max_slots - 1),
          static_cast<std::uint32_t>(bits >> slot_bits) + min_generation};
}

/// The first generation of the next world's handles: far from other worlds', so that each refuses the handles
/// of the others, and with half of all generations above it.
inline std::uint32_t next_first_generation() noexcept {
  static std::uint32_t worlds = 0;
  // Multiples of the golden ratio, modulo 1, are far apart, however many there are.
  return min_generation + (++worlds * 0x9e3779b9U >> (32 - generation_bits + 1));
}

}  // namespace broadside::wasm

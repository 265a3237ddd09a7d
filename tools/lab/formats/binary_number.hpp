// Numbers in binary files, of any size and byte order.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "src/core/bit_cast.hpp"

namespace broadside::lab {

/// The encoding of a number: 'f' for floats of 2, 4 or 8 bytes, 'i' and 'u' for integers of 1, 2, 4 or 8
/// bytes.
struct NumberType {
  char kind = 'f';
  std::size_t bytes = 4;
  bool is_big_endian = false;
};

/// The bits of the number at a place, in the low bits of a word.
inline std::uint64_t bits_at(const char* place, const NumberType& type) noexcept {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < type.bytes; ++i)
    bits = bits << 8 | static_cast<unsigned char>(place[type.is_big_endian ? i : type.bytes - 1 - i]);
  return bits;
}

/// The value of the bits of a signed integer.
inline std::int64_t integer_of(std::uint64_t bits, const NumberType& type) noexcept {
  const std::size_t unused = 64 - 8 * type.bytes;
  return static_cast<std::int64_t>(bits << unused) >> unused;
}

/// A half-precision float (IEEE 754's binary16).
inline double half_of(std::uint64_t bits) noexcept {
  const auto exponent = static_cast<int>(bits >> 10 & 31);
  const auto digits = static_cast<int>(bits & 1023);
  const double sign = (bits & 0x8000) != 0 ? -1 : 1;
  if (exponent == 31)
    return digits != 0 ? std::numeric_limits<double>::quiet_NaN()
                       : sign * std::numeric_limits<double>::infinity();
  return sign * (exponent == 0 ? std::ldexp(digits, -24) : std::ldexp(1024 + digits, exponent - 25));
}

/// The value of the bits as the nearest double; exact for all types but 8-byte integers.
inline double value_of(std::uint64_t bits, const NumberType& type) noexcept {
  if (type.kind == 'u') return static_cast<double>(bits);
  if (type.kind == 'i') return static_cast<double>(integer_of(bits, type));
  if (type.bytes == 8) return core::bit_cast<double>(bits);
  return type.bytes == 4 ? static_cast<double>(core::bit_cast<float>(static_cast<std::uint32_t>(bits)))
                         : half_of(bits);
}

}  // namespace broadside::lab

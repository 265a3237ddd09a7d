// The module that decompresses the others, for the package's entries: LZMA as `xz --format=raw
// --lzma1=lc=3,lp=0,pb=0` writes it. Igor Pavlov's specification, in his LZMA SDK, describes the format. In
// JavaScript it would take ten times as long, since a page runs it once and therefore unoptimized.
#include <array>
#include <cstddef>
#include <cstdint>

#include "module/export.hpp"

extern "C" unsigned char __heap_base;  // the linker's: memory from here on is free

namespace {

constexpr std::size_t length_odds = 2 + 8 + 8 + 256;

/// Where the odds of each kind of bit begin. A flag has odds for each of twelve states.
enum : std::size_t {
  is_match = 0,
  is_repeat = 12,
  is_older = 24,
  is_third = 36,
  is_fourth = 48,
  is_longer = 60,
  lengths = 72,
  repeated_lengths = lengths + length_odds,
  slots = repeated_lengths + length_odds,
  low_bits = slots + 4 * std::size_t{64},
  alignment = low_bits + 128,
  literals = alignment + 16,
  all_odds = literals + 8 * std::size_t{0x300}
};

std::array<std::uint16_t, all_odds> odds;  // that a bit is 0, in parts of 2048
const std::uint8_t* packed;
std::uint32_t range;
std::uint32_t code;

void narrow(std::uint32_t to) noexcept {
  for (range = to; range < 1U << 24; range <<= 8) code = code << 8 | *packed++;
}

[[gnu::noinline]] std::uint32_t bit(std::size_t at) noexcept {
  std::uint16_t& odd = odds[at];
  const std::uint32_t bound = (range >> 11) * odd;
  if (code < bound) {
    odd += (2048 - odd) >> 5;
    narrow(bound);
    return 0;
  }
  odd -= odd >> 5;
  code -= bound;
  narrow(range - bound);
  return 1;
}

std::uint32_t number(std::size_t at, int bits) noexcept {
  std::uint32_t value = 1;
  for (int i = 0; i < bits; ++i) value = 2 * value + bit(at + value);
  return value - (1U << bits);
}

/// A number whose lowest bit comes first.
std::uint32_t reversed_number(std::size_t at, int bits) noexcept {
  std::uint32_t value = 0;
  for (std::uint32_t i = 0, node = 1; i < static_cast<std::uint32_t>(bits); ++i) {
    const std::uint32_t digit = bit(at + node);
    node = 2 * node + digit;
    value |= digit << i;
  }
  return value;
}

/// A number with bits that are 0 or 1 equally often.
std::uint32_t even_number(int bits) noexcept {
  std::uint32_t value = 0;
  for (int i = 0; i < bits; ++i) {
    const std::uint32_t half = range >> 1;
    const bool digit = code >= half;
    if (digit) code -= half;
    value = 2 * value + (digit ? 1 : 0);
    narrow(half);
  }
  return value;
}

std::uint32_t length(std::size_t at) noexcept {
  if (bit(at) == 0) return 2 + number(at + 2, 3);
  if (bit(at + 1) == 0) return 10 + number(at + 10, 3);
  return 18 + number(at + 18, 8);
}

/// How far back a match is, minus one. The slot encodes the highest two bits and how many bits follow.
std::uint32_t distance(std::uint32_t slot) noexcept {
  if (slot < 4) return slot;
  const int bits = static_cast<int>(slot >> 1) - 1;
  const std::uint32_t least = (2 + (slot & 1)) << bits;
  if (slot < 14) return least + reversed_number(low_bits + least - slot, bits);
  const std::uint32_t high = even_number(bits - 4) << 4;
  return least + high + reversed_number(alignment, 4);
}

}  // namespace

/// Where JavaScript writes the compressed bytes.
BROADSIDE_EXPORT(room) unsigned char* room() { return &__heap_base; }

/// Decompresses the bytes in room() to the memory after them. `size` must be the number of bytes before
/// compression.
BROADSIDE_EXPORT(unpack) void unpack(std::size_t packed_size, std::size_t size) {
  packed = &__heap_base;
  std::uint8_t* const out = &__heap_base + packed_size;
  odds.fill(1024);
  range = 0xffffffff;
  code = 0;
  for (int i = 0; i < 5; ++i) code = code << 8 | *packed++;

  std::uint32_t state = 0;  // of the last literals and matches; below 7 the last was a literal
  std::array<std::uint32_t, 4> recent = {};  // the last distances, each minus one
  for (std::size_t to = 0; to < size;) {
    const bool after_literal = state < 7;
    if (bit(is_match + state) == 0) {
      const std::size_t at = literals + std::size_t{0x300} * (to == 0 ? 0U : out[to - 1] >> 5U);
      std::uint32_t symbol = 1;
      // After a match, the byte that would have continued it selects the odds, until a bit differs from it.
      bool is_expected = !after_literal;
      std::uint32_t expected = is_expected ? out[to - 1 - recent[0]] : 0;
      while (symbol < 256) {
        const std::uint32_t next = expected >> 7 & 1;
        const std::uint32_t found = bit(at + (is_expected ? 256 * (1 + next) : 0) + symbol);
        symbol = 2 * symbol + found;
        expected <<= 1;
        is_expected = is_expected && next == found;
      }
      out[to++] = static_cast<std::uint8_t>(symbol);
      state = state < 4 ? 0 : state - (state < 10 ? 3 : 6);
      continue;
    }
    std::uint32_t count = 1;
    std::uint32_t kind = 7;
    std::uint32_t latest = recent[0];
    std::size_t dropped = 0;  // the place in `recent` of the latest distance
    if (bit(is_repeat + state) == 0) {
      count = length(lengths);
      latest = distance(number(slots + 64 * std::size_t{count < 6 ? count - 2 : 3}, 6));
      dropped = 3;
    } else {
      kind = 8;
      if (bit(is_older + state) != 0) {
        dropped = bit(is_third + state) == 0 ? 1 : 2 + bit(is_fourth + state);
        latest = recent[dropped];
      } else if (bit(is_longer + state) == 0) {
        kind = 9;
      }
      if (kind == 8) count = length(repeated_lengths);
    }
    for (; dropped > 0; --dropped) recent[dropped] = recent[dropped - 1];
    recent[0] = latest;
    state = after_literal ? kind : kind == 7 ? 10 : 11;
    for (; count > 0; --count, ++to) out[to] = out[to - 1 - latest];
  }
}

// Bytes shaped like a trace, made to have the right checksums: for faults that lie behind them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "broadside/recorder.hpp"

namespace broadside::lab {

/// The number that stands in four bytes of a trace.
inline std::uint32_t trace_word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// Writes a number over four bytes of a trace, as far as they are there.
inline void put_trace_word(std::string& bytes, std::size_t at, std::uint32_t value) {
  for (std::size_t i = 0; i < 4 && at + i < bytes.size(); ++i)
    bytes[at + i] = static_cast<char>(value >> 8 * i & 0xff);
}

/// `bytes` with every checksum right that the counts in them lead to.
inline std::string sealed_trace(std::string bytes) {
  trace::Checksum checksum;
  std::size_t at = 0;
  // Seals what lies between here and `count` bytes on; whether the file goes on behind.
  const auto seal = [&](std::uint64_t count) {
    if (count > bytes.size() - at || bytes.size() - at - count < trace::checksum_bytes) return false;
    checksum.add(reinterpret_cast<const unsigned char*>(bytes.data()) + at, static_cast<std::size_t>(count));
    at += static_cast<std::size_t>(count);
    put_trace_word(bytes, at, checksum.value());
    at += trace::checksum_bytes;
    return true;
  };
  constexpr std::size_t summed_bytes = trace::header_bytes - trace::checksum_bytes;
  const bool has_pairs = bytes.size() > summed_bytes && trace_word(bytes, 8) == trace::pairs_version;
  if (!seal(summed_bytes + (has_pairs ? trace::margin_bytes : 0))) return bytes;
  const std::uint64_t bytes_per_box =
      4 + std::uint64_t{2} * static_cast<unsigned char>(bytes[12]) * static_cast<unsigned char>(bytes[13]);
  for (;;) {
    const std::size_t frame = at;
    if (!seal(summed_bytes + (has_pairs ? trace::pair_count_bytes : 0))) return bytes;
    const std::uint64_t removed = trace_word(bytes, frame + 8);
    const std::uint64_t set = trace_word(bytes, frame + 12);
    std::uint64_t size = 4 * removed + bytes_per_box * set;
    if (has_pairs) {
      size += std::uint64_t{trace::filter_bytes} * trace_word(bytes, frame + 16);
      for (const std::size_t list : {20, 24, 28, 32})
        size += std::uint64_t{trace::pair_bytes} * trace_word(bytes, frame + list);
    }
    if (!seal(size)) return bytes;
  }
}

}  // namespace broadside::lab

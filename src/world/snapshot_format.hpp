// Constants of World's snapshot format, for its writer and its reader: see docs/snapshot-format.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace broadside::world::snapshot {

inline constexpr std::array<unsigned char, 8> magic = {0x89, 'B', 'W', 'S', '\r', '\n', 0x1a, '\n'};
/// The version written, and the first that is read. Version 2 had a margin and neither a relative one nor
/// predicted frames; version 1, moreover, 32 bits for a filter's category and its mask.
inline constexpr std::uint32_t version = 3;
inline constexpr std::uint32_t first_version = 1;
inline constexpr std::uint16_t byte_order = 0x0102;
inline constexpr std::size_t checksum_bytes = 4;

// Flags of the world.
inline constexpr std::uint32_t keeps_pairs = 1;
inline constexpr std::uint32_t has_own_tracker = 2;
inline constexpr std::uint32_t has_predicate = 4;
inline constexpr std::uint32_t refines = 8;
inline constexpr std::uint32_t has_filters = 16;
inline constexpr std::uint32_t has_user_data = 32;
inline constexpr std::uint32_t was_updated = 64;
inline constexpr std::uint32_t was_settled = 128;
inline constexpr std::uint32_t refilters = 256;
inline constexpr std::uint32_t tells_enlarged = 512;
inline constexpr std::uint32_t all_flags = 1023;

// Flags of the tracker's last frame.
inline constexpr int last_has_filters = 1;
inline constexpr int last_has_ignored = 2;

}  // namespace broadside::world::snapshot

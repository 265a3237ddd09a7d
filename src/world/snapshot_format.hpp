// World's snapshot format, for its writer and its reader: see docs/snapshot-format.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/error.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

#include "world/byte_stream.hpp"

namespace broadside::world::snapshot {

inline constexpr std::array<unsigned char, 8> magic = {0x89, 'B', 'W', 'S', '\r', '\n', 0x1a, '\n'};
/// The version written, and the first that can be read. Version 2 had a margin, but no relative margin or
/// predicted frames. Version 1 also had only 32 bits for a filter's category and for its mask.
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
inline constexpr std::uint32_t leaves_out_touching = 1024;
inline constexpr std::uint32_t all_flags = 2047;

// Flags of the tracker's last frame.
inline constexpr int last_has_filters = 1;
inline constexpr int last_has_ignored = 2;

}  // namespace broadside::world::snapshot

namespace broadside::world {

/// Throws InvalidSnapshot, which says `what` is wrong, unless it holds.
inline void expect(bool holds, const char* what) {
  if (!holds) throw InvalidSnapshot(std::string("a snapshot contradicts itself: ") + what);
}

/// Throws InvalidSnapshot, which names a pair and says what is wrong with it.
[[noreturn]] inline void refuse(Pair pair, const std::string& what) {
  throw InvalidSnapshot("a snapshot contradicts itself: the pair (" + std::to_string(index(pair.first)) +
                        ", " + std::to_string(index(pair.second)) + ") " + what);
}

/// How a T is written, how it is read, and how many bytes it takes.
template <typename T>
struct Serializer {
  static constexpr std::size_t bytes = sizeof(T);
  static void put(ByteWriter& out, T value) { out.put(value); }
  static T get(ByteReader& in) { return in.get<T>(); }
};

template <>
struct Serializer<Pair> {
  static constexpr std::size_t bytes = 8;
  static void put(ByteWriter& out, Pair pair) {
    out.put(pair.first);
    out.put(pair.second);
  }
  static Pair get(ByteReader& in) {
    const auto first = in.get<BoxId>();
    return {first, in.get<BoxId>()};
  }
};

template <>
struct Serializer<Filter> {
  static constexpr std::size_t bytes = 13;  // at least: in version 1
  static void put(ByteWriter& out, const Filter& filter) {
    out.put(filter.category);
    out.put(filter.mask);
    out.put(filter.group);
    out.put(static_cast<std::uint8_t>(filter.is_static));
  }
  static Filter get(ByteReader& in) {
    Filter filter;
    if (in.version() == 1) {
      filter.category = in.get<std::uint32_t>();
      const auto mask = in.get<std::uint32_t>();
      // A mask of all 32 categories becomes one of all 64.
      filter.mask = mask == 0xffffffffU ? ~std::uint64_t{0} : mask;
    } else {
      filter.category = in.get<std::uint64_t>();
      filter.mask = in.get<std::uint64_t>();
    }
    filter.group = in.get<std::int32_t>();
    const auto is_static = in.get<std::uint8_t>();
    if (is_static > 1)
      throw InvalidSnapshot("a filter in a snapshot has is_static " + std::to_string(is_static) +
                            "; expected 0 or 1");
    filter.is_static = is_static == 1;
    return filter;
  }
};

template <int D, typename Real>
struct Serializer<Box<D, Real>> {
  static constexpr std::size_t bytes = 2 * D * sizeof(Real);
  static void put(ByteWriter& out, const Box<D, Real>& box) {
    for (const Real coordinate : box.min) out.put(coordinate);
    for (const Real coordinate : box.max) out.put(coordinate);
  }
  static Box<D, Real> get(ByteReader& in) {
    Box<D, Real> box;
    for (Real& coordinate : box.min) coordinate = in.get<Real>();
    for (Real& coordinate : box.max) coordinate = in.get<Real>();
    if (!is_present(box) && !is_absent(box))
      throw InvalidSnapshot("a snapshot has a box with min > max or a NaN; expected boxes and absent ones");
    return box;
  }
};

/// Elements one after the other; the reader knows their number.
template <typename T>
void put_all(ByteWriter& out, std::span<const T> parts) {
  for (const T& part : parts) Serializer<T>::put(out, part);
}
template <typename T>
std::vector<T> get_all(ByteReader& in, std::size_t count, const char* things) {
  in.need(Serializer<T>::bytes, count, things);
  std::vector<T> parts;
  parts.reserve(count);
  for (std::size_t i = 0; i < count; ++i) parts.push_back(Serializer<T>::get(in));
  return parts;
}

/// A length-prefixed list.
template <typename T>
void put_list(ByteWriter& out, std::span<const T> parts) {
  out.put(std::uint64_t{parts.size()});
  put_all<T>(out, parts);
}
template <typename T>
std::vector<T> get_list(ByteReader& in, const char* things) {
  return get_all<T>(in, in.count(Serializer<T>::bytes, things), things);
}

}  // namespace broadside::world

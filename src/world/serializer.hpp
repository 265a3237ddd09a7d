// Serializer: how boxes, filters, pairs and lists of them are written into snapshots, and read. See
// docs/snapshot-format.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "broadside/box.hpp"
#include "broadside/filter.hpp"
#include "broadside/pair.hpp"

#include "world/byte_stream.hpp"

namespace broadside::world {

/// How a T is written, how it is read, and how many bytes it takes.
template <typename T>
struct Serializer {
  static constexpr std::size_t bytes = sizeof(T);
  static void put(ByteWriter& out, T value) { out.put(value); }
  static T get(ByteReader& in) { return in.get<T>(); }
};

template <>
struct Serializer<BoxId> {
  static constexpr std::size_t bytes = 4;
  static void put(ByteWriter& out, BoxId id) { out.put(index(id)); }
  static BoxId get(ByteReader& in) { return BoxId{in.get<std::uint32_t>()}; }
};

template <>
struct Serializer<Pair> {
  static constexpr std::size_t bytes = 8;
  static void put(ByteWriter& out, Pair pair) {
    out.put(index(pair.first));
    out.put(index(pair.second));
  }
  static Pair get(ByteReader& in) {
    const BoxId first = Serializer<BoxId>::get(in);
    return {first, Serializer<BoxId>::get(in)};
  }
};

template <>
struct Serializer<Filter> {
  static constexpr std::size_t bytes = 13;  // at least: of version 1
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

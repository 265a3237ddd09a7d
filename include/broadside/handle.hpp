// Handles: names of a world's boxes that detect when they are used after the box is gone.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>

#include "broadside/cpp_version.hpp"

namespace broadside {

/// Names one box of a world for as long as it lives. A slot is used again, under another generation; one
/// whose generations are used up is not, so that no handle ever names a second box.
struct Handle {
  std::uint32_t slot = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t generation = 0;

  friend constexpr auto operator<=>(const Handle&, const Handle&) = default;
};

/// Two boxes of a world; first.slot < second.slot. Where two worlds are joined, a box of each.
struct HandlePair {
  Handle first;
  Handle second;

  friend constexpr auto operator<=>(const HandlePair&, const HandlePair&) = default;
};

/// The user data of a pair's boxes.
struct UserDataPair {
  std::uint64_t first;
  std::uint64_t second;

  friend constexpr bool operator==(const UserDataPair&, const UserDataPair&) = default;
};

/// What one update brought, sorted by slots. Valid until the next update of the world it came from.
struct Events {
  std::span<const HandlePair> begun;
  std::span<const HandlePair> ended;

  /// The user data of these pairs' boxes, one for each; empty in a world whose boxes never had any.
  std::span<const UserDataPair> begun_data{};
  std::span<const UserDataPair> ended_data{};
};

namespace detail {
/// Every bit of the handle changes about half the bits of the result: the finaliser of SplitMix64 (Steele,
/// Lea and Flood 2014). Without it the low bits would be the slot's alone, whatever the generation. `seed`
/// sets what is hashed before the handle.
constexpr std::uint64_t hash(const Handle& handle, std::uint64_t seed = 0) noexcept {
  std::uint64_t bits = seed ^ (std::uint64_t{handle.generation} << 32 | handle.slot);
  bits = (bits ^ bits >> 30) * 0xbf58476d1ce4e5b9;
  bits = (bits ^ bits >> 27) * 0x94d049bb133111eb;
  return bits ^ bits >> 31;
}
}  // namespace detail

}  // namespace broadside

/// Handles and pairs of them as keys of std::unordered_map and std::unordered_set.
template <>
struct std::hash<broadside::Handle> {
  std::size_t operator()(const broadside::Handle& handle) const noexcept {
    return static_cast<std::size_t>(broadside::detail::hash(handle));
  }
};

template <>
struct std::hash<broadside::HandlePair> {
  std::size_t operator()(const broadside::HandlePair& pair) const noexcept {
    using broadside::detail::hash;
    return static_cast<std::size_t>(hash(pair.second, hash(pair.first)));
  }
};

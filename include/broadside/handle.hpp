// Handles: names of a world's boxes that detect when they are used after the box is gone.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>
#include <span>

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

/// What one update brought, sorted by slots. Valid until the next update of the world it came from.
struct Events {
  std::span<const HandlePair> begun;
  std::span<const HandlePair> ended;
};

}  // namespace broadside

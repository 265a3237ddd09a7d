// Boxes as Bullet has them, flat ones where they have two dimensions; and ids in what Bullet hands back.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <string>

#include <LinearMath/btVector3.h>

#include "broadside/box.hpp"
#include "broadside/pair.hpp"

namespace broadside::lab::peers {

template <std::size_t D>
btVector3 bullet_point(const std::array<float, D>& corner) {
  if constexpr (D == 2)
    return {corner[0], corner[1], 0};
  else
    return {corner[0], corner[1], corner[2]};
}

inline void* bullet_data(BoxId id) { return std::bit_cast<void*>(std::uintptr_t{index(id)}); }

inline BoxId id_in(const void* data) { return BoxId(std::bit_cast<std::uintptr_t>(data)); }

/// Such as "Bullet 3.24".
std::string bullet_version();

}  // namespace broadside::lab::peers

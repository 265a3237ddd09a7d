// bit_cast(): std::bit_cast(), which libc++ has from version 14 on.
#pragma once

namespace broadside::core {

template <typename To, typename From>
constexpr To bit_cast(const From& from) noexcept {
  return __builtin_bit_cast(To, from);
}

}  // namespace broadside::core

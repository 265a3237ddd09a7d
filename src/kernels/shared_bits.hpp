// Bits of a word that several threads set and clear at once, each bits of its own.
#pragma once

#include <atomic>
#include <cstdint>

namespace broadside::kernels {

/// Nothing is ordered by it: what joins the threads orders what they wrote.
inline void set_shared(std::uint16_t& word, std::uint16_t bits) noexcept {
#ifdef __cpp_lib_atomic_ref
  std::atomic_ref(word).fetch_or(bits, std::memory_order_relaxed);
#else  // libc++ before 19
  __atomic_fetch_or(&word, bits, __ATOMIC_RELAXED);
#endif
}

inline void clear_shared(std::uint16_t& word, std::uint16_t bits) noexcept {
#ifdef __cpp_lib_atomic_ref
  std::atomic_ref(word).fetch_and(static_cast<std::uint16_t>(~bits), std::memory_order_relaxed);
#else
  __atomic_fetch_and(&word, static_cast<std::uint16_t>(~bits), __ATOMIC_RELAXED);
#endif
}

}  // namespace broadside::kernels

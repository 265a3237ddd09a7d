// Masks as bits, for files that Highway compiles for each instruction set.
//
// Highway 1.0 stores a mask of WebAssembly's to memory and reads it back as numbers, which took a third of a
// sweep's time. There is an instruction.
//
// Included once an instruction set, hence no #pragma once.
#if defined(BROADSIDE_KERNELS_MASK) == defined(HWY_TARGET_TOGGLE)
#ifdef BROADSIDE_KERNELS_MASK
#undef BROADSIDE_KERNELS_MASK
#else
#define BROADSIDE_KERNELS_MASK
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Bit i is lane i, of at most sixteen.
template <typename Tag>
HWY_INLINE std::uint32_t bits_of(Tag tag, hn::Mask<Tag> mask) {
#if HWY_TARGET == HWY_WASM
  static_assert(hn::MaxLanes(tag) == 4);
  return wasm_i32x4_bitmask(mask.raw);
#else
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(tag, mask, bytes.data());
  return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8;
#endif
}

/// How many lanes are true.
template <typename Tag>
HWY_INLINE std::size_t count_true(Tag tag, hn::Mask<Tag> mask) {
#if HWY_TARGET == HWY_WASM
  return hwy::PopCount(bits_of(tag, mask));
#else
  return hn::CountTrue(tag, mask);
#endif
}

template <typename Tag>
HWY_INLINE bool all_false(Tag tag, hn::Mask<Tag> mask) {
#if HWY_TARGET == HWY_WASM
  return bits_of(tag, mask) == 0;
#else
  return hn::AllFalse(tag, mask);
#endif
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Masks as bits, and numbers compressed to the front of a vector, for files that Highway compiles for each
// instruction set.
//
// On WebAssembly, Highway 1.0 stores a mask to memory and reads it back as numbers, which took a third of a
// sweep's time; here one instruction does it. Highway also looks up the order of compressed numbers in a
// table that g++ copies to the stack at each call: a kilobyte with AVX2, which took three quarters of a
// sweep's time.
//
// Included once per SIMD target, hence no #pragma once.
#if defined(BROADSIDE_KERNELS_COMPRESS) == defined(HWY_TARGET_TOGGLE)
#ifdef BROADSIDE_KERNELS_COMPRESS
#undef BROADSIDE_KERNELS_COMPRESS
#else
#define BROADSIDE_KERNELS_COMPRESS
#endif

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

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
  // As many bytes as were stored, since a load of more waits for both stores.
  if constexpr (hn::MaxLanes(Tag()) <= 8) {
    return bytes[0];
  } else if constexpr (std::endian::native == std::endian::little) {
    std::uint16_t bits;
    std::memcpy(&bits, bytes.data(), sizeof(bits));
    return bits;
  } else {
    return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8;
  }
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

/// For each set of lanes, as bits: the places of the bytes of its lanes, in order, then zeros. A lane has
/// `Size` bytes.
template <std::size_t Lanes, std::size_t Size>
struct LanesInSet {
  constexpr LanesInSet() {
    for (std::size_t set = 0; set < places.size(); ++set) {
      std::size_t at = 0;
      for (std::size_t lane = 0; lane < Lanes; ++lane) {
        if ((set >> lane & 1) == 0) continue;
        for (std::size_t byte = 0; byte < Size; ++byte)
          places[set][at++] = static_cast<std::uint8_t>(lane * Size + byte);
      }
    }
  }

  alignas(16) std::array<std::array<std::uint8_t, Lanes * Size>, std::size_t{1} << Lanes> places{};
};

inline constexpr LanesInSet<8, 1> lanes_of_8;
inline constexpr LanesInSet<4, 4> bytes_of_4;

/// The numbers in the lanes of `mask`, in order, at the front. The numbers after them are unspecified.
template <typename Tag>
HWY_INLINE hn::Vec<Tag> compress(Tag tag, hn::Vec<Tag> numbers, hn::Mask<Tag> mask) {
  static_assert(sizeof(hn::TFromD<Tag>) == 4);
#if HWY_TARGET == HWY_AVX3
  constexpr std::size_t vector_size = 0;  // an instruction does it
#else
  constexpr std::size_t vector_size = hn::MaxLanes(Tag());
#endif
  if constexpr (vector_size == 8) {
    const hn::Rebind<std::uint8_t, Tag> bytes;
    const auto order = hn::PromoteTo(tag, hn::Load(bytes, lanes_of_8.places[bits_of(tag, mask)].data()));
    return hn::TableLookupLanes(numbers, hn::IndicesFromVec(tag, order));
  } else if constexpr (vector_size == 4) {
    const hn::Repartition<std::uint8_t, Tag> bytes;
    const auto order = hn::Load(bytes, bytes_of_4.places[bits_of(tag, mask)].data());
    return hn::BitCast(tag, hn::TableLookupBytes(hn::BitCast(bytes, numbers), order));
  } else {
    return hn::Compress(numbers, mask);
  }
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

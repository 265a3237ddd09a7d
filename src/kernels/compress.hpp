// Compressing numbers to the front of a vector, for files that Highway compiles for each instruction set.
//
// Highway 1.0 looks the order up in a table as well, but in one that g++ copies to the stack at each call: a
// kilobyte with AVX2, which took three quarters of a sweep's time.
//
// Included once an instruction set, hence no #pragma once.
#if defined(BROADSIDE_KERNELS_COMPRESS) == defined(HWY_TARGET_TOGGLE)
#ifdef BROADSIDE_KERNELS_COMPRESS
#undef BROADSIDE_KERNELS_COMPRESS
#else
#define BROADSIDE_KERNELS_COMPRESS
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "kernels/mask.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {

/// For each set of `Lanes` lanes, as bits, which lanes are in it, in order; beyond them the first lane. Each
/// lane is `Size` bytes: the places of its bytes.
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

/// The numbers whose lanes are in `mask`, in order, at the front; what follows them is unspecified.
template <typename Tag>
HWY_INLINE hwy::HWY_NAMESPACE::Vec<Tag> compress(Tag tag, hwy::HWY_NAMESPACE::Vec<Tag> numbers,
                                                 hwy::HWY_NAMESPACE::Mask<Tag> mask) {
  namespace hn = hwy::HWY_NAMESPACE;
  static_assert(sizeof(hn::TFromD<Tag>) == 4);
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
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

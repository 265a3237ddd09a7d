// load_coordinates(): the coordinates of boxes as a vector, for files that Highway compiles for each
// instruction set.
//
// Included once per SIMD target, hence no #pragma once.
#if defined(BROADSIDE_KERNELS_BOX_COORDINATES) == defined(HWY_TARGET_TOGGLE)
#ifdef BROADSIDE_KERNELS_BOX_COORDINATES
#undef BROADSIDE_KERNELS_BOX_COORDINATES
#else
#define BROADSIDE_KERNELS_BOX_COORDINATES
#endif

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "broadside/box.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

/// A vector of the coordinates of consecutive boxes as they are in memory, from number `first` on. Reads
/// bytes, which C++ allows for any object.
template <typename Tag, int D, typename Real>
HWY_INLINE hn::Vec<Tag> load_coordinates(Tag tag, const Box<D, Real>* boxes, std::size_t first) {
  const hn::Repartition<std::uint8_t, Tag> bytes;
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(boxes);
  return hn::BitCast(tag, hn::LoadU(bytes, begin + first * sizeof(Real)));
}

#endif

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

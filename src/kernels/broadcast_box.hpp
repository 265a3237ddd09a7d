// BroadcastBox: one box against a SIMD vector of others, for files that Highway compiles for each instruction
// set.
//
// Included once per SIMD target, hence no #pragma once.
#if defined(BROADSIDE_KERNELS_BROADCAST_BOX) == defined(HWY_TARGET_TOGGLE)
#ifdef BROADSIDE_KERNELS_BROADCAST_BOX
#undef BROADSIDE_KERNELS_BROADCAST_BOX
#else
#define BROADSIDE_KERNELS_BROADCAST_BOX
#endif

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

#include "broadside/box.hpp"

#include "kernels/block.hpp"
#include "kernels/compress.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, block_size>;
using Numbers = hn::Rebind<std::uint32_t, Floats>;
using FloatVector = hn::Vec<Floats>;
using NumberVector = hn::Vec<Numbers>;
using FloatMask = hn::Mask<Floats>;
using NumberMask = hn::Mask<Numbers>;

/// How many elements a vector has: a block is one vector or several.
inline constexpr std::size_t lanes = hn::MaxLanes(Floats());

/// A block's coordinates are aligned; those of other boxes need not be.
HWY_INLINE FloatVector load(const std::array<float, block_size>& values, std::size_t at) {
  return hn::Load(Floats(), values.data() + at);
}
HWY_INLINE FloatVector load(const float* values, std::size_t at) { return hn::LoadU(Floats(), values + at); }

/// Bit i is lane i.
HWY_INLINE std::uint32_t bits_of(FloatMask mask) { return bits_of(Floats(), mask); }

/// Which of these lanes have a <= b.
HWY_INLINE FloatMask also_at_most(FloatMask lanes_asked, FloatVector a, FloatVector b) {
#if HWY_TARGET <= HWY_AVX3  // AVX-512
  // One instruction: with AVX-512, ands of masks compete with comparisons for the same units.
  if constexpr (lanes == 16)
    return FloatMask{_mm512_mask_cmp_ps_mask(lanes_asked.raw, a.raw, b.raw, _CMP_LE_OQ)};
#endif
  return hn::And(lanes_asked, hn::Le(a, b));
}

/// A box in every lane.
template <int D>
struct BroadcastBox {
  HWY_INLINE explicit BroadcastBox(const Box<D>& box) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis] = hn::Set(Floats(), box.min[axis]);
      max[axis] = hn::Set(Floats(), box.max[axis]);
    }
  }

  /// The box at a place of `boxes`: a block, a run, or anything else with arrays of `min` and `max` by axis.
  template <typename Boxes>
  HWY_INLINE BroadcastBox(const Boxes& boxes, std::size_t place) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis] = hn::Set(Floats(), boxes.min[axis][place]);
      max[axis] = hn::Set(Floats(), boxes.max[axis][place]);
    }
  }

  /// Which boxes this one overlaps, of the vector of boxes from `at` on. A NaN overlaps nothing.
  template <typename Boxes>
  HWY_INLINE FloatMask overlaps(const Boxes& boxes, std::size_t at) const {
    FloatMask below = hn::Le(load(boxes.min[0], at), max[0]);
    FloatMask above = hn::Le(min[0], load(boxes.max[0], at));
    for (int axis = 1; axis < D; ++axis) {
      below = also_at_most(below, load(boxes.min[axis], at), max[axis]);
      above = also_at_most(above, min[axis], load(boxes.max[axis], at));
    }
    return hn::And(below, above);
  }

  /// The same for a whole block: bit i is box i.
  HWY_INLINE std::uint32_t overlaps(const Block<D>& block) const {
    std::uint32_t bits = 0;
    for (std::size_t at = 0; at < block_size; at += lanes) bits |= bits_of(overlaps(block, at)) << at;
    return bits;
  }

  FloatVector min[D];
  FloatVector max[D];
};

/// Consecutive boxes, one per lane.
template <int D>
struct LoadedBoxes {
  // Not defaulted: it must be compiled for the instruction set of the vectors' constructors.
  HWY_INLINE LoadedBoxes() {}  // NOLINT(modernize-use-equals-default)

  /// `boxes` as in BroadcastBox.
  template <typename Boxes>
  HWY_INLINE LoadedBoxes(const Boxes& boxes, std::size_t at) {
    for (int axis = 0; axis < D; ++axis) {
      min[axis] = load(boxes.min[axis], at);
      max[axis] = load(boxes.max[axis], at);
    }
  }

  FloatVector min[D];
  FloatVector max[D];
};

/// In which lanes overlapping boxes only touch. `a` is a BroadcastBox or LoadedBoxes.
template <int D, template <int> typename A>
HWY_INLINE FloatMask touch(const A<D>& a, const LoadedBoxes<D>& b) {
  FloatMask touching = hn::Or(hn::Eq(a.min[0], b.max[0]), hn::Eq(b.min[0], a.max[0]));
  for (int axis = 1; axis < D; ++axis) {
    touching = hn::Or(touching, hn::Eq(a.min[axis], b.max[axis]));
    touching = hn::Or(touching, hn::Eq(b.min[axis], a.max[axis]));
  }
  return touching;
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

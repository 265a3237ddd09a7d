// A BVH node, several children at a time, for the files that Highway compiles for each instruction set.
//
// Included once per SIMD target, hence no #pragma once.
#if defined(BROADSIDE_KERNELS_BVH_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef BROADSIDE_KERNELS_BVH_LANES
#undef BROADSIDE_KERNELS_BVH_LANES
#else
#define BROADSIDE_KERNELS_BVH_LANES
#endif

#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "kernels/broadcast_box.hpp"
#include "kernels/bvh.hpp"
#include "kernels/compress.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {

inline constexpr float infinity = std::numeric_limits<float>::infinity();

HWY_INLINE FloatVector all(float value) { return hn::Set(Floats(), value); }

template <int D>
HWY_INLINE void prefetch(const Block<D>& node) {
  for (std::size_t line = 0; line < sizeof(node); line += 64)
    hwy::Prefetch(reinterpret_cast<const char*>(&node) + line);
}

/// Appends the children from `at` on that are in `mask` to `to`, and returns how many.
template <int D>
HWY_INLINE std::size_t append(const Block<D>& node, std::size_t at, FloatMask mask, std::uint32_t* to) {
  const auto hits = hn::RebindMask(Numbers(), mask);
  hn::StoreU(compress(Numbers(), hn::Load(Numbers(), node.id.data() + at), hits), Numbers(), to);
  return count_true(Floats(), mask);
}

/// As append(); also appends a number of each of these children, such as where a cast enters it, to
/// `values_to`.
template <int D>
HWY_INLINE std::size_t append_entries(const Block<D>& node, std::size_t at, FloatMask mask,
                                      FloatVector values, std::uint32_t* to, float* values_to) {
  const auto hits = hn::RebindMask(Numbers(), mask);
  const auto bits = hn::BitCast(Numbers(), values);
  hn::StoreU(hn::BitCast(Floats(), compress(Numbers(), bits, hits)), Floats(), values_to);
  return append(node, at, mask, to);
}

/// A depth-first traversal. `may_hold(node, at)` is the mask of the children from `at` on to descend to.
/// Calls `leaf` with each leaf that it reaches, until one call returns false; returns false then.
template <int D, typename MayHold, typename Leaf>
HWY_INLINE bool traverse(const BvhView<D>& tree, const MayHold& may_hold, const Leaf& leaf) {
  std::uint32_t waiting[(longest_path + 1) * fan_out];
  std::size_t count = 1;
  waiting[0] = tree.root;
  while (count > 0) {
    const std::uint32_t number = waiting[--count];
    const Block<D>& node = tree.nodes[number & ~leaf_bit];
    if ((number & leaf_bit) != 0) {
      if (!leaf(node)) return false;
      continue;
    }
    for (std::size_t at = 0; at < fan_out; at += lanes)
      count += append(node, at, may_hold(node, at), waiting + count);
  }
  return true;
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

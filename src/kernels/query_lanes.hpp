// A node of a tree of boxes, several children at a time, for the files that search it and that Highway
// compiles for each instruction set.
//
// Included once an instruction set, hence no #pragma once.
#if defined(BROADSIDE_KERNELS_QUERY_LANES) == defined(HWY_TARGET_TOGGLE)
#ifdef BROADSIDE_KERNELS_QUERY_LANES
#undef BROADSIDE_KERNELS_QUERY_LANES
#else
#define BROADSIDE_KERNELS_QUERY_LANES
#endif

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <hwy/highway.h>

#include "kernels/compress.hpp"
#include "kernels/query_tree.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, node_width>;
using Numbers = hn::Rebind<std::uint32_t, Floats>;
using FloatVector = hn::Vec<Floats>;
using FloatMask = hn::Mask<Floats>;

/// The elements of a vector, sixteen of which are one or several.
inline constexpr std::size_t lanes = hn::MaxLanes(Floats());

inline constexpr float infinity = std::numeric_limits<float>::infinity();

HWY_INLINE FloatVector all(float value) { return hn::Set(Floats(), value); }
HWY_INLINE FloatVector load(const std::array<float, node_width>& values, std::size_t at) {
  return hn::Load(Floats(), values.data() + at);
}

/// Appends the children from `at` on that are in `mask` to `to`; how many.
template <int D>
HWY_INLINE std::size_t append(const QueryNode<D>& node, std::size_t at, FloatMask mask, std::uint32_t* to) {
  const auto hits = hn::RebindMask(Numbers(), mask);
  hn::StoreU(compress(Numbers(), hn::Load(Numbers(), node.child.data() + at), hits), Numbers(), to);
  return hn::CountTrue(Floats(), mask);
}

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

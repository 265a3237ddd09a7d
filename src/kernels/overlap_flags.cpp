// Tests given pairs of boxes for overlap, written once for every instruction set.
//
// Each pair is tested by itself, in a vector of four floats. Gathering the coordinates of many pairs would
// take longer than the tests.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/overlap_flags.cpp"
#include "kernels/overlap_flags.hpp"

#include <cstddef>

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// How many pairs ahead boxes are prefetched. Finders write neighbours one after the other, but their boxes
/// may be anywhere in the array.
constexpr std::size_t ahead = 16;

/// Branchless, since a branch could not be predicted.
template <int D, typename Real>
HWY_INLINE bool both_overlap(const Box<D, Real>& a, const Box<D, Real>& b) {
  unsigned all = 1;
  for (int axis = 0; axis < D; ++axis) {
    all &=
        static_cast<unsigned>(a.min[axis] <= b.max[axis]) & static_cast<unsigned>(b.min[axis] <= a.max[axis]);
    all &=
        static_cast<unsigned>(a.min[axis] <= a.max[axis]) & static_cast<unsigned>(b.min[axis] <= b.max[axis]);
  }
  return all != 0;
}

#if HWY_TARGET != HWY_SCALAR

using Four = hn::FixedTag<float, 4>;
using Vector = hn::Vec<Four>;

/// Four coordinates of a box, from number `first` on.
template <int D>
HWY_INLINE Vector load(const Box<D>& box, std::size_t first) {
  const hn::FixedTag<std::uint8_t, 16> bytes;
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(&box);
  return hn::BitCast(Four(), hn::LoadU(bytes, begin + first * sizeof(float)));
}

HWY_INLINE bool both_overlap(const Box<2>& a, const Box<2>& b) {
  const Four four;
  const Vector a_bounds = load(a, 0);
  const Vector b_bounds = load(b, 0);
  const Vector minima = hn::ConcatLowerLower(four, b_bounds, a_bounds);
  const auto overlaps = hn::Le(minima, hn::ConcatUpperUpper(four, a_bounds, b_bounds));
  const auto are_present = hn::Le(minima, hn::ConcatUpperUpper(four, b_bounds, a_bounds));
  return hn::AllTrue(four, hn::And(overlaps, are_present));
}

/// Ignores the fourth lane: its numbers are not of one axis.
HWY_INLINE bool both_overlap(const Box<3>& a, const Box<3>& b) {
  const Four four;
  const Vector a_min = load(a, 0);
  const Vector b_min = load(b, 0);
  const Vector a_max = hn::Shuffle0321(load(a, 2));
  const Vector b_max = hn::Shuffle0321(load(b, 2));
  const auto overlaps = hn::And(hn::Le(a_min, b_max), hn::Le(b_min, a_max));
  const auto are_present = hn::And(hn::Le(a_min, a_max), hn::Le(b_min, b_max));
  const auto fourth = hn::Eq(hn::Iota(four, 0.0F), hn::Set(four, 3.0F));
  return hn::AllTrue(four, hn::Or(fourth, hn::And(overlaps, are_present)));
}

#endif

template <int D, typename Real>
void flag_overlaps(std::span<const Box<D, Real>> boxes, std::span<const Pair> pairs, std::uint8_t* flags) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (i + ahead < pairs.size()) {
      hwy::Prefetch(&boxes[index(pairs[i + ahead].first)]);
      hwy::Prefetch(&boxes[index(pairs[i + ahead].second)]);
    }
    flags[i] = both_overlap(boxes[index(pairs[i].first)], boxes[index(pairs[i].second)]);
  }
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& flags_2 = flag_overlaps<2, float>;
constexpr auto& flags_3 = flag_overlaps<3, float>;
constexpr auto& double_flags_2 = flag_overlaps<2, double>;
constexpr auto& double_flags_3 = flag_overlaps<3, double>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(flags_2);
HWY_EXPORT(flags_3);
HWY_EXPORT(double_flags_2);
HWY_EXPORT(double_flags_3);

template <>
void set_overlap_flags(std::span<const Box<2>> boxes, std::span<const Pair> pairs, std::uint8_t* flags) {
  HWY_DYNAMIC_DISPATCH(flags_2)(boxes, pairs, flags);
}
template <>
void set_overlap_flags(std::span<const Box<3>> boxes, std::span<const Pair> pairs, std::uint8_t* flags) {
  HWY_DYNAMIC_DISPATCH(flags_3)(boxes, pairs, flags);
}
template <>
void set_overlap_flags(std::span<const DoubleBox2> boxes, std::span<const Pair> pairs, std::uint8_t* flags) {
  HWY_DYNAMIC_DISPATCH(double_flags_2)(boxes, pairs, flags);
}
template <>
void set_overlap_flags(std::span<const DoubleBox3> boxes, std::span<const Pair> pairs, std::uint8_t* flags) {
  HWY_DYNAMIC_DISPATCH(double_flags_3)(boxes, pairs, flags);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

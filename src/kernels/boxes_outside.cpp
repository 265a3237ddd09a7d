// Selects the boxes that are not within their enlarged boxes, written once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/boxes_outside.cpp"
#include "kernels/boxes_outside.hpp"

#include <cstdint>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/box_coordinates.hpp"
#include "kernels/compress.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// The number of boxes that fill whole vectors in either dimension.
constexpr std::size_t at_once = 4;

template <int D, typename Real>
HWY_INLINE bool is_outside(const Box<D, Real>& box, const Box<D, Real>& enlarged) {
  unsigned inside = 1;
  for (int axis = 0; axis < D; ++axis) {
    inside &= static_cast<unsigned>(enlarged.min[axis] <= box.min[axis]) &
              static_cast<unsigned>(box.max[axis] <= enlarged.max[axis]);
  }
  return inside == 0;
}

/// Bit i is set if box i is outside.
template <int D, typename Real>
HWY_INLINE unsigned four_outside(const Box<D, Real>* boxes, const Box<D, Real>* enlarged) {
  unsigned outside = 0;
  for (std::size_t i = 0; i < at_once; ++i)
    outside |= static_cast<unsigned>(is_outside(boxes[i], enlarged[i])) << i;
  return outside;
}

#if HWY_TARGET != HWY_SCALAR

/// One bit for each coordinate of the boxes, set for minima.
template <int D>
constexpr std::uint32_t minima_of_four() {
  std::uint32_t minima = 0;
  for (std::size_t i = 0; i < at_once; ++i) minima |= ((1U << D) - 1) << (2 * D * i);
  return minima;
}

template <int D>
HWY_INLINE unsigned four_outside(const Box<D>* boxes, const Box<D>* enlarged) {
  constexpr std::size_t coordinates = at_once * 2 * D;
  constexpr std::size_t lanes = HWY_MAX_BYTES >= 32 ? 8 : 4;
  const hn::FixedTag<float, lanes> floats;
  std::uint32_t below = 0;
  std::uint32_t above = 0;
  for (std::size_t i = 0; i < coordinates; i += lanes) {
    const auto box = load_coordinates(floats, boxes, i);
    const auto limit = load_coordinates(floats, enlarged, i);
    below |= bits_of(floats, hn::Lt(box, limit)) << i;
    above |= bits_of(floats, hn::Lt(limit, box)) << i;
  }
  // A minimum must not be below that of the enlarged box, a maximum not above.
  const std::uint32_t wrong = (below & minima_of_four<D>()) | (above & ~minima_of_four<D>());
  if (wrong == 0) return 0;
  unsigned outside = 0;
  for (std::size_t i = 0; i < at_once; ++i)
    outside |= static_cast<unsigned>((wrong >> (2 * D * i) & ((1U << 2 * D) - 1)) != 0) << i;
  return outside;
}

#endif

template <int D, typename Real>
std::size_t select_outside(std::span<const Box<D, Real>> boxes, std::span<const Box<D, Real>> enlarged,
                           BoxId* outside) {
  std::size_t count = 0;
  std::size_t i = 0;
  for (; i + at_once <= boxes.size(); i += at_once) {
    const unsigned which = four_outside(&boxes[i], &enlarged[i]);
    if (HWY_LIKELY(which == 0)) continue;
    for (std::size_t j = 0; j < at_once; ++j) {
      outside[count] = BoxId(i + j);
      count += which >> j & 1U;
    }
  }
  for (; i < boxes.size(); ++i) {
    if (is_outside(boxes[i], enlarged[i])) outside[count++] = BoxId(i);
  }
  return count;
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& outside_2 = select_outside<2, float>;
constexpr auto& outside_3 = select_outside<3, float>;
constexpr auto& double_outside_2 = select_outside<2, double>;
constexpr auto& double_outside_3 = select_outside<3, double>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(outside_2);
HWY_EXPORT(outside_3);
HWY_EXPORT(double_outside_2);
HWY_EXPORT(double_outside_3);

template <>
std::size_t select_outside(std::span<const Box<2>> boxes, std::span<const Box<2>> enlarged, BoxId* outside) {
  return HWY_DYNAMIC_DISPATCH(outside_2)(boxes, enlarged, outside);
}
template <>
std::size_t select_outside(std::span<const Box<3>> boxes, std::span<const Box<3>> enlarged, BoxId* outside) {
  return HWY_DYNAMIC_DISPATCH(outside_3)(boxes, enlarged, outside);
}
template <>
std::size_t select_outside(std::span<const DoubleBox2> boxes, std::span<const DoubleBox2> enlarged,
                           BoxId* outside) {
  return HWY_DYNAMIC_DISPATCH(double_outside_2)(boxes, enlarged, outside);
}
template <>
std::size_t select_outside(std::span<const DoubleBox3> boxes, std::span<const DoubleBox3> enlarged,
                           BoxId* outside) {
  return HWY_DYNAMIC_DISPATCH(double_outside_3)(boxes, enlarged, outside);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

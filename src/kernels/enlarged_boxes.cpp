// Boxes within enlarged ones, written once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/enlarged_boxes.cpp"
#include "kernels/enlarged_boxes.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/box_coordinates.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Returns how many boxes have left theirs.
template <int D, typename Real>
std::size_t enlarge(std::span<Box<D, Real>> kept, std::span<const Box<D, Real>> boxes,
                    const core::Margins<D, Real>& margins, std::uint32_t* left) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (margins.keeps(kept[i], boxes[i], nullptr)) continue;
    kept[i] = margins.enlarged(boxes[i], nullptr);
    left[count++] = static_cast<std::uint32_t>(i);
  }
  return count;
}

#if HWY_TARGET == HWY_SCALAR

/// Leaves all boxes to be tested one by one.
template <int D, typename Real>
std::size_t count(std::span<const Box<D, Real>>, std::span<const Box<D, Real>>, std::size_t,
                  const core::Margins<D, Real>&) {
  return 0;
}

#else

/// How far boxes are enlarged: `relative` times the longest side, but at least `min` and at most `max`.
template <typename Real>
struct MarginRange {
  template <int D>
  explicit MarginRange(const core::Margins<D, Real>& margins)
      : relative(margins.relative),
        min(margins.has_relative ? 0 : margins.margin),
        max(margins.has_relative && !margins.has_margin ? std::numeric_limits<Real>::infinity()
                                                        : margins.margin) {}

  template <typename Tag, typename Vector = hn::Vec<Tag>>
  HWY_INLINE Vector of(Tag tag, Vector longest) const {
    const Vector share = hn::Mul(hn::Set(tag, relative), longest);
    return hn::Max(hn::Set(tag, min), hn::Min(hn::Set(tag, max), share));
  }

  Real relative;
  Real min;
  Real max;
};

/// Tests as many boxes as a vector has lanes, as they are in memory: their coordinates fill 2 * D vectors, in
/// which minima and maxima alternate. So nothing is gathered or shuffled.
template <int D, typename Real>
class KeptTest {
 public:
  static constexpr std::size_t lanes = HWY_LANES(Real);

  explicit KeptTest(const core::Margins<D, Real>& margins) : range_(margins) {}

  /// Reads D coordinates beyond these boxes, and ignores them. As if each side were the longest of its box,
  /// so it may say no where Margins::keeps() says yes.
  HWY_INLINE bool all_kept(const Box<D, Real>* kept, const Box<D, Real>* boxes) const {
    const hn::ScalableTag<Real> tag;
    auto all = hn::FirstN(tag, lanes);
    for (std::size_t at = 0; at < 2 * D * lanes; at += lanes) {
      const auto is_minimum = hn::Ne(hn::Load(tag, &are_minima[at]), hn::Zero(tag));
      const auto outer = load_coordinates(tag, kept, at);
      const auto inner = load_coordinates(tag, boxes, at);
      const auto contains =
          hn::Le(hn::IfThenElse(is_minimum, outer, inner), hn::IfThenElse(is_minimum, inner, outer));
      const auto side = hn::Sub(load_coordinates(tag, boxes, at + D), inner);
      const auto kept_side = hn::Sub(load_coordinates(tag, kept, at + D), outer);
      const auto slack = hn::Mul(hn::Set(tag, core::Margins<D, Real>::max_margins), range_.of(tag, side));
      const auto fits = hn::And(hn::Le(kept_side, hn::Add(side, slack)), hn::Ge(side, hn::Zero(tag)));
      all = hn::And(all, hn::And(contains, hn::Or(fits, hn::Not(is_minimum))));
    }
    return hn::AllTrue(tag, all);
  }

 private:
  /// For each coordinate, 1 if it is a minimum, 0 if it is a maximum.
  HWY_ALIGN static constexpr std::array<Real, 2 * D* lanes> are_minima = [] {
    std::array<Real, 2 * D * lanes> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i % (2 * D) < D ? 1 : 0;
    return all;
  }();

  MarginRange<Real> range_;
};

template <int D, typename Real>
std::size_t count(std::span<const Box<D, Real>> kept, std::span<const Box<D, Real>> boxes, std::size_t size,
                  const core::Margins<D, Real>& margins) {
  std::size_t i = 0;
  if constexpr (HWY_HAVE_FLOAT64 || std::is_same_v<Real, float>) {
    constexpr std::size_t lanes = KeptTest<D, Real>::lanes;
    const KeptTest<D, Real> test(margins);
    const std::size_t readable = std::min(kept.size(), boxes.size());
    // A test reads the box that follows.
    while (i + lanes <= size && i + lanes < readable && test.all_kept(&kept[i], &boxes[i])) i += lanes;
  }
  return i;
}

using Four = hn::FixedTag<float, 4>;
using Vector = hn::Vec<Four>;

/// A box in two vectors, with an axis in each of the first lanes; what the others hold is of no meaning.
struct Bounds {
  Vector min;
  Vector max;
};

HWY_INLINE Bounds bounds_of(const Box<2>& box) {
  const Vector bounds = load_coordinates(Four(), &box, 0);
  return {bounds, hn::Shuffle1032(bounds)};
}
HWY_INLINE Bounds bounds_of(const Box<3>& box) {
  return {load_coordinates(Four(), &box, 0), hn::Shuffle0321(load_coordinates(Four(), &box, 2))};
}

/// Not through the box's arrays, since a vector is longer than these.
HWY_INLINE void store(Vector vector, void* at) {
  const hn::FixedTag<std::uint8_t, 16> bytes;
  hn::StoreU(hn::BitCast(bytes, vector), bytes, static_cast<std::uint8_t*>(at));
}
HWY_INLINE void store(const Bounds& bounds, Box<2>& box) {
  store(hn::ConcatLowerLower(Four(), bounds.max, bounds.min), &box);
}
HWY_INLINE void store(const Bounds& bounds, Box<3>& box) {
  const Four four;
  const auto is_fourth = hn::Eq(hn::Iota(four, 0.0F), hn::Set(four, 3.0F));
  const auto is_first = hn::Eq(hn::Iota(four, 0.0F), hn::Zero(four));
  store(hn::IfThenElse(is_fourth, hn::Broadcast<0>(bounds.max), bounds.min), &box);
  store(hn::IfThenElse(is_first, hn::Broadcast<2>(bounds.min), hn::Shuffle2103(bounds.max)),
        reinterpret_cast<std::uint8_t*>(&box) + 2 * sizeof(float));
}

/// The longest of the finite sides, in all lanes.
template <int D>
HWY_INLINE Vector longest_of(Vector sides) {
  const Four four;
  const Vector finite = hn::IfThenElseZero(hn::Lt(sides, hn::Inf(four)), sides);
  Vector longest = hn::Max(finite, hn::Shuffle0321(finite));
  if constexpr (D == 3) longest = hn::Max(longest, hn::Shuffle1032(finite));
  return hn::Max(hn::Zero(four), hn::Broadcast<0>(longest));
}

/// The functions of Margins, for one box in a vector.
template <int D>
std::size_t enlarge(std::span<Box<D>> kept, std::span<const Box<D>> boxes,
                    const core::Margins<D, float>& margins, std::uint32_t* left) {
  const Four four;
  const MarginRange<float> range(margins);
  const auto is_axis = hn::FirstN(four, D);
  std::size_t count = 0;
  Box<D> unused;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Bounds box = bounds_of(boxes[i]);
    const Bounds outer = bounds_of(kept[i]);
    const Vector sides = hn::Sub(box.max, box.min);
    const Vector margin = range.of(four, longest_of<D>(sides));
    const Vector slack = hn::Mul(hn::Set(four, core::Margins<D, float>::max_margins), margin);
    const auto contains = hn::And(hn::Le(outer.min, box.min), hn::Le(box.max, outer.max));
    const auto fits = hn::Le(hn::Sub(outer.max, outer.min), hn::Add(sides, slack));
    const bool leaves = !hn::AllTrue(four, hn::Or(hn::Not(is_axis), hn::And(contains, fits)));
    // A sum of infinities that is NaN adds nothing, and zeros keep their signs.
    const Vector min = hn::Add(hn::Sub(box.min, margin), hn::Zero(four));
    const Vector max = hn::Add(hn::Add(box.max, margin), hn::Zero(four));
    const Bounds enlarged{hn::IfThenElse(hn::Lt(min, box.min), min, box.min),
                          hn::IfThenElse(hn::Lt(box.max, max), max, box.max)};
    store(enlarged, leaves ? kept[i] : unused);  // without a branch: it could not be foreseen
    left[count] = static_cast<std::uint32_t>(i);
    count += static_cast<std::size_t>(leaves);
  }
  return count;
}

#endif

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& count_2 = count<2, float>;
constexpr auto& count_3 = count<3, float>;
constexpr auto& count_double_2 = count<2, double>;
constexpr auto& count_double_3 = count<3, double>;
constexpr std::size_t (&enlarge_2)(std::span<Box<2>>, std::span<const Box<2>>, const core::Margins<2, float>&,
                                   std::uint32_t*) = enlarge;
constexpr std::size_t (&enlarge_3)(std::span<Box<3>>, std::span<const Box<3>>, const core::Margins<3, float>&,
                                   std::uint32_t*) = enlarge;
constexpr auto& enlarge_double_2 = enlarge<2, double>;
constexpr auto& enlarge_double_3 = enlarge<3, double>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(count_2);
HWY_EXPORT(count_3);
HWY_EXPORT(count_double_2);
HWY_EXPORT(count_double_3);
HWY_EXPORT(enlarge_2);
HWY_EXPORT(enlarge_3);
HWY_EXPORT(enlarge_double_2);
HWY_EXPORT(enlarge_double_3);

template <>
std::size_t count_kept(std::span<const Box<2>> kept, std::span<const Box<2>> boxes, std::size_t count,
                       const core::Margins<2, float>& margins) {
  return HWY_DYNAMIC_DISPATCH(count_2)(kept, boxes, count, margins);
}
template <>
std::size_t count_kept(std::span<const Box<3>> kept, std::span<const Box<3>> boxes, std::size_t count,
                       const core::Margins<3, float>& margins) {
  return HWY_DYNAMIC_DISPATCH(count_3)(kept, boxes, count, margins);
}
template <>
std::size_t count_kept(std::span<const DoubleBox2> kept, std::span<const DoubleBox2> boxes, std::size_t count,
                       const core::Margins<2, double>& margins) {
  return HWY_DYNAMIC_DISPATCH(count_double_2)(kept, boxes, count, margins);
}
template <>
std::size_t count_kept(std::span<const DoubleBox3> kept, std::span<const DoubleBox3> boxes, std::size_t count,
                       const core::Margins<3, double>& margins) {
  return HWY_DYNAMIC_DISPATCH(count_double_3)(kept, boxes, count, margins);
}

template <>
std::size_t enlarge_left(std::span<Box<2>> kept, std::span<const Box<2>> boxes,
                         const core::Margins<2, float>& margins, std::uint32_t* left) {
  return HWY_DYNAMIC_DISPATCH(enlarge_2)(kept, boxes, margins, left);
}
template <>
std::size_t enlarge_left(std::span<Box<3>> kept, std::span<const Box<3>> boxes,
                         const core::Margins<3, float>& margins, std::uint32_t* left) {
  return HWY_DYNAMIC_DISPATCH(enlarge_3)(kept, boxes, margins, left);
}
template <>
std::size_t enlarge_left(std::span<DoubleBox2> kept, std::span<const DoubleBox2> boxes,
                         const core::Margins<2, double>& margins, std::uint32_t* left) {
  return HWY_DYNAMIC_DISPATCH(enlarge_double_2)(kept, boxes, margins, left);
}
template <>
std::size_t enlarge_left(std::span<DoubleBox3> kept, std::span<const DoubleBox3> boxes,
                         const core::Margins<3, double>& margins, std::uint32_t* left) {
  return HWY_DYNAMIC_DISPATCH(enlarge_double_3)(kept, boxes, margins, left);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

// Tests given pairs of boxes for overlap, written once for every instruction set.
//
// A vector tests one pair or two: gathering the coordinates of many pairs would take longer than the tests.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/overlap_flags.cpp"
#include "kernels/overlap_flags.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/box_coordinates.hpp"

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

HWY_INLINE bool both_overlap(const Box<2>& a, const Box<2>& b) {
  const Four four;
  const Vector a_bounds = load_coordinates(four, &a, 0);
  const Vector b_bounds = load_coordinates(four, &b, 0);
  const Vector minima = hn::ConcatLowerLower(four, b_bounds, a_bounds);
  const auto overlaps = hn::Le(minima, hn::ConcatUpperUpper(four, a_bounds, b_bounds));
  const auto are_present = hn::Le(minima, hn::ConcatUpperUpper(four, b_bounds, a_bounds));
  return hn::AllTrue(four, hn::And(overlaps, are_present));
}

/// Ignores the fourth lane: its numbers are not of one axis.
HWY_INLINE bool both_overlap(const Box<3>& a, const Box<3>& b) {
  const Four four;
  const Vector a_min = load_coordinates(four, &a, 0);
  const Vector b_min = load_coordinates(four, &b, 0);
  const Vector a_max = hn::Shuffle0321(load_coordinates(four, &a, 2));
  const Vector b_max = hn::Shuffle0321(load_coordinates(four, &b, 2));
  const auto overlaps = hn::And(hn::Le(a_min, b_max), hn::Le(b_min, a_max));
  const auto are_present = hn::And(hn::Le(a_min, a_max), hn::Le(b_min, b_max));
  const auto fourth = hn::Eq(hn::Iota(four, 0.0F), hn::Set(four, 3.0F));
  return hn::AllTrue(four, hn::Or(fourth, hn::And(overlaps, are_present)));
}

#endif

/// Up to this number of bytes, boxes stay in the second-level cache, and prefetching them costs more than it
/// saves.
constexpr std::size_t max_cached_bytes = std::size_t{1} << 19;

/// Calls test(i) for the two pairs from number i on, and test_last(i) for the last one of an odd number.
template <int D, typename Real, typename Test, typename TestLast>
HWY_INLINE void for_two_pairs(std::span<const Box<D, Real>> boxes, std::span<const Pair> pairs, Test test,
                              TestLast test_last) {
  std::size_t i = 0;
  if (boxes.size_bytes() > max_cached_bytes) {
    for (; i + ahead + 1 < pairs.size(); i += 2) {
      for (std::size_t next = i + ahead; next < i + ahead + 2; ++next) {
        hwy::Prefetch(&boxes[index(pairs[next].first)]);
        hwy::Prefetch(&boxes[index(pairs[next].second)]);
      }
      test(i);
    }
  }
  for (; i + 1 < pairs.size(); i += 2) test(i);
  if (i < pairs.size()) test_last(i);
}

/// Bit 0 is set if the boxes of the first pair overlap, bit 1 if those of the second do.
template <int D, typename Real>
HWY_INLINE unsigned two_overlap(std::span<const Box<D, Real>> boxes, const Pair* pairs) {
  const auto overlap_of = [&](Pair pair) {
    return static_cast<unsigned>(both_overlap(boxes[index(pair.first)], boxes[index(pair.second)]));
  };
  return overlap_of(pairs[0]) | overlap_of(pairs[1]) << 1;
}

#if HWY_TARGET != HWY_SCALAR && HWY_MAX_BYTES >= 32

using Eight = hn::FixedTag<float, 8>;

/// Four coordinates of a box of each pair, from number `first` on.
template <int D>
HWY_INLINE hn::Vec<Eight> load_two(std::span<const Box<D>> boxes, BoxId of_first, BoxId of_second,
                                   std::size_t first) {
  return hn::Combine(Eight(), load_coordinates(Four(), &boxes[index(of_second)], first),
                     load_coordinates(Four(), &boxes[index(of_first)], first));
}

/// One bit for each four lanes, set if the mask holds for all of them or is `ignored` there.
HWY_INLINE unsigned bits_of_fours(hn::Mask<Eight> mask, unsigned ignored) {
  std::array<std::uint8_t, 8> bytes;
  hn::StoreMaskBits(Eight(), mask, bytes.data());
  const unsigned bits = bytes[0] | ignored;
  return static_cast<unsigned>((bits & 0xfU) == 0xfU) | static_cast<unsigned>(bits >= 0xf0U) << 1;
}

HWY_INLINE unsigned two_overlap(std::span<const Box<2>> boxes, const Pair* pairs) {
  const Eight eight;
  const hn::Repartition<double, Eight> points;
  const auto a = hn::BitCast(points, load_two(boxes, pairs[0].first, pairs[1].first, 0));
  const auto b = hn::BitCast(points, load_two(boxes, pairs[0].second, pairs[1].second, 0));
  const auto minima = hn::BitCast(eight, hn::InterleaveLower(points, a, b));
  const auto overlaps = hn::Le(minima, hn::BitCast(eight, hn::InterleaveUpper(points, b, a)));
  const auto are_present = hn::Le(minima, hn::BitCast(eight, hn::InterleaveUpper(points, a, b)));
  return bits_of_fours(hn::And(overlaps, are_present), 0);
}

/// Ignores the fourth lane of each box: its numbers are not of one axis.
HWY_INLINE unsigned two_overlap(std::span<const Box<3>> boxes, const Pair* pairs) {
  const auto a_min = load_two(boxes, pairs[0].first, pairs[1].first, 0);
  const auto b_min = load_two(boxes, pairs[0].second, pairs[1].second, 0);
  const auto a_max = hn::Shuffle0321(load_two(boxes, pairs[0].first, pairs[1].first, 2));
  const auto b_max = hn::Shuffle0321(load_two(boxes, pairs[0].second, pairs[1].second, 2));
  const auto overlaps = hn::And(hn::Le(a_min, b_max), hn::Le(b_min, a_max));
  const auto are_present = hn::And(hn::Le(a_min, a_max), hn::Le(b_min, b_max));
  return bits_of_fours(hn::And(overlaps, are_present), 0x88);
}

#endif

template <int D, typename Real>
void flag_overlaps(std::span<const Box<D, Real>> boxes, std::span<const Pair> pairs, std::uint8_t* flags) {
  for_two_pairs(
      boxes, pairs,
      [&](std::size_t i) {
        const unsigned overlaps = two_overlap(boxes, &pairs[i]);
        flags[i] = overlaps & 1;
        flags[i + 1] = static_cast<std::uint8_t>(overlaps >> 1);
      },
      [&](std::size_t i) {
        flags[i] = both_overlap(boxes[index(pairs[i].first)], boxes[index(pairs[i].second)]);
      });
}

/// Nearly all flags stay as they are, so that a branch pays.
template <int D, typename Real>
std::size_t renew_flags(std::span<const Box<D, Real>> boxes, std::span<const Pair> pairs, std::uint8_t* flags,
                        std::uint32_t* changed) {
  std::size_t count = 0;
  const auto change = [&](std::size_t i) {
    flags[i] ^= 1;
    changed[count++] = static_cast<std::uint32_t>(i);
  };
  for_two_pairs(
      boxes, pairs,
      [&](std::size_t i) {
        const unsigned before = flags[i] | static_cast<unsigned>(flags[i + 1]) << 1;
        const unsigned differ = two_overlap(boxes, &pairs[i]) ^ before;
        if (HWY_LIKELY(differ == 0)) return;
        if ((differ & 1) != 0) change(i);
        if (differ > 1) change(i + 1);
      },
      [&](std::size_t i) {
        const unsigned is = both_overlap(boxes[index(pairs[i].first)], boxes[index(pairs[i].second)]);
        if (is != flags[i]) change(i);
      });
  return count;
}

/// Branchless: which pairs part cannot be predicted.
template <int D, typename Real>
std::size_t select_apart(std::span<const Box<D, Real>> boxes, std::span<const Pair> pairs, Pair* apart) {
  std::size_t count = 0;
  for_two_pairs(
      boxes, pairs,
      [&](std::size_t i) {
        const unsigned are_apart = two_overlap(boxes, &pairs[i]) ^ 3;
        apart[count] = pairs[i];
        count += are_apart & 1;
        apart[count] = pairs[i + 1];
        count += are_apart >> 1;
      },
      [&](std::size_t i) {
        apart[count] = pairs[i];
        count += static_cast<std::size_t>(
            !both_overlap(boxes[index(pairs[i].first)], boxes[index(pairs[i].second)]));
      });
  return count;
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& apart_2 = select_apart<2, float>;
constexpr auto& apart_3 = select_apart<3, float>;
constexpr auto& double_apart_2 = select_apart<2, double>;
constexpr auto& double_apart_3 = select_apart<3, double>;
constexpr auto& renew_2 = renew_flags<2, float>;
constexpr auto& renew_3 = renew_flags<3, float>;
constexpr auto& double_renew_2 = renew_flags<2, double>;
constexpr auto& double_renew_3 = renew_flags<3, double>;
constexpr auto& flags_2 = flag_overlaps<2, float>;
constexpr auto& flags_3 = flag_overlaps<3, float>;
constexpr auto& double_flags_2 = flag_overlaps<2, double>;
constexpr auto& double_flags_3 = flag_overlaps<3, double>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(apart_2);
HWY_EXPORT(apart_3);
HWY_EXPORT(double_apart_2);
HWY_EXPORT(double_apart_3);
HWY_EXPORT(renew_2);
HWY_EXPORT(renew_3);
HWY_EXPORT(double_renew_2);
HWY_EXPORT(double_renew_3);
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

template <>
std::size_t select_apart(std::span<const Box<2, float>> boxes, std::span<const Pair> pairs, Pair* apart) {
  return HWY_DYNAMIC_DISPATCH(apart_2)(boxes, pairs, apart);
}
template <>
std::size_t select_apart(std::span<const Box<3, float>> boxes, std::span<const Pair> pairs, Pair* apart) {
  return HWY_DYNAMIC_DISPATCH(apart_3)(boxes, pairs, apart);
}
template <>
std::size_t select_apart(std::span<const Box<2, double>> boxes, std::span<const Pair> pairs, Pair* apart) {
  return HWY_DYNAMIC_DISPATCH(double_apart_2)(boxes, pairs, apart);
}
template <>
std::size_t select_apart(std::span<const Box<3, double>> boxes, std::span<const Pair> pairs, Pair* apart) {
  return HWY_DYNAMIC_DISPATCH(double_apart_3)(boxes, pairs, apart);
}

template <>
std::size_t renew_overlap_flags(std::span<const Box<2, float>> boxes, std::span<const Pair> pairs,
                                std::uint8_t* flags, std::uint32_t* changed) {
  return HWY_DYNAMIC_DISPATCH(renew_2)(boxes, pairs, flags, changed);
}
template <>
std::size_t renew_overlap_flags(std::span<const Box<3, float>> boxes, std::span<const Pair> pairs,
                                std::uint8_t* flags, std::uint32_t* changed) {
  return HWY_DYNAMIC_DISPATCH(renew_3)(boxes, pairs, flags, changed);
}
template <>
std::size_t renew_overlap_flags(std::span<const Box<2, double>> boxes, std::span<const Pair> pairs,
                                std::uint8_t* flags, std::uint32_t* changed) {
  return HWY_DYNAMIC_DISPATCH(double_renew_2)(boxes, pairs, flags, changed);
}
template <>
std::size_t renew_overlap_flags(std::span<const Box<3, double>> boxes, std::span<const Pair> pairs,
                                std::uint8_t* flags, std::uint32_t* changed) {
  return HWY_DYNAMIC_DISPATCH(double_renew_3)(boxes, pairs, flags, changed);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

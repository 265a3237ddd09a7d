// Tests whether boxes stay within enlarged ones, written once for every instruction set.
//
// Boxes are taken as they are in memory: vectors of coordinates, in which minima and maxima alternate. So
// nothing is gathered or shuffled.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/count_kept.cpp"
#include "kernels/count_kept.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

template <typename Real>
using Tag = hn::ScalableTag<Real>;

/// A vector of the coordinates of boxes, from number `first` on.
template <int D, typename Real>
HWY_INLINE hn::Vec<Tag<Real>> coordinates(const Box<D, Real>* boxes, std::size_t first) {
  const hn::Repartition<std::uint8_t, Tag<Real>> bytes;
  const auto* const begin = reinterpret_cast<const std::uint8_t*>(boxes);
  return hn::BitCast(Tag<Real>(), hn::LoadU(bytes, begin + first * sizeof(Real)));
}

/// As many boxes as a vector has lanes, whose coordinates fill 2 * D vectors.
template <int D, typename Real>
class KeptTest {
 public:
  static constexpr std::size_t lanes = HWY_LANES(Real);

  explicit KeptTest(const SideSlack<Real>& slack)
      : factor_(hn::Set(tag, slack.factor)),
        per_side_(hn::Set(tag, slack.per_side)),
        min_(hn::Set(tag, slack.min)),
        max_(hn::Set(tag, slack.max)) {}

  /// Reads D coordinates beyond these boxes, and ignores them.
  HWY_INLINE bool all_kept(const Box<D, Real>* kept, const Box<D, Real>* boxes) const {
    auto all = hn::FirstN(tag, lanes);
    for (std::size_t vector = 0; vector < 2 * D; ++vector) {
      const std::size_t at = vector * lanes;
      const auto is_minimum = hn::Ne(hn::Load(tag, &minima[at]), hn::Zero(tag));
      const auto outer = coordinates(kept, at);
      const auto inner = coordinates(boxes, at);
      const auto contains =
          hn::Le(hn::IfThenElse(is_minimum, outer, inner), hn::IfThenElse(is_minimum, inner, outer));
      const auto side = hn::Sub(coordinates(boxes, at + D), inner);
      const auto kept_side = hn::Sub(coordinates(kept, at + D), outer);
      const auto slack = hn::Max(min_, hn::Min(max_, hn::Mul(per_side_, side)));
      const auto fits =
          hn::And(hn::Le(kept_side, hn::Add(side, hn::Mul(factor_, slack))), hn::Ge(side, hn::Zero(tag)));
      all = hn::And(all, hn::And(contains, hn::Or(fits, hn::Not(is_minimum))));
    }
    return hn::AllTrue(tag, all);
  }

 private:
  static constexpr Tag<Real> tag{};
  using Vector = hn::Vec<Tag<Real>>;

  /// For each coordinate, 1 if it is a minimum, 0 if it is a maximum.
  HWY_ALIGN static constexpr std::array<Real, 2 * D* lanes> minima = [] {
    std::array<Real, 2 * D * lanes> all{};
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i % (2 * D) < D ? 1 : 0;
    return all;
  }();

  Vector factor_;
  Vector per_side_;
  Vector min_;
  Vector max_;
};

template <int D, typename Real>
std::size_t count(std::span<const Box<D, Real>> kept, std::span<const Box<D, Real>> boxes, std::size_t size,
                  const SideSlack<Real>& slack) {
  constexpr std::size_t lanes = KeptTest<D, Real>::lanes;
  const KeptTest<D, Real> test(slack);
  const std::size_t readable = std::min(kept.size(), boxes.size());
  std::size_t i = 0;
  // A test reads the box that follows.
  while (i + lanes <= size && i + lanes < readable && test.all_kept(&kept[i], &boxes[i])) i += lanes;
  return i;
}

#else

/// Leaves all boxes to be tested one by one.
template <int D, typename Real>
std::size_t count(std::span<const Box<D, Real>>, std::span<const Box<D, Real>>, std::size_t,
                  const SideSlack<Real>&) {
  return 0;
}

#endif

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& count_2 = count<2, float>;
constexpr auto& count_3 = count<3, float>;
constexpr auto& count_double_2 = count<2, double>;
constexpr auto& count_double_3 = count<3, double>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(count_2);
HWY_EXPORT(count_3);
HWY_EXPORT(count_double_2);
HWY_EXPORT(count_double_3);

template <>
std::size_t count_kept(std::span<const Box<2>> kept, std::span<const Box<2>> boxes, std::size_t count,
                       const SideSlack<float>& slack) {
  return HWY_DYNAMIC_DISPATCH(count_2)(kept, boxes, count, slack);
}
template <>
std::size_t count_kept(std::span<const Box<3>> kept, std::span<const Box<3>> boxes, std::size_t count,
                       const SideSlack<float>& slack) {
  return HWY_DYNAMIC_DISPATCH(count_3)(kept, boxes, count, slack);
}
template <>
std::size_t count_kept(std::span<const DoubleBox2> kept, std::span<const DoubleBox2> boxes, std::size_t count,
                       const SideSlack<double>& slack) {
  return HWY_DYNAMIC_DISPATCH(count_double_2)(kept, boxes, count, slack);
}
template <>
std::size_t count_kept(std::span<const DoubleBox3> kept, std::span<const DoubleBox3> boxes, std::size_t count,
                       const SideSlack<double>& slack) {
  return HWY_DYNAMIC_DISPATCH(count_double_3)(kept, boxes, count, slack);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

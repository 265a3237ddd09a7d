// Tests whether all boxes are present, written once for every instruction set.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/all_present.cpp"
#include "kernels/all_present.hpp"

#include <cstddef>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "kernels/box_coordinates.hpp"

HWY_BEFORE_NAMESPACE();
namespace broadside::kernels::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Branchless within a few boxes, since nearly all boxes are present.
template <typename Boxes>
HWY_INLINE bool are_present(const Boxes& boxes) {
  unsigned all = 1;
  for (const auto& box : boxes) all &= static_cast<unsigned>(is_present(box));
  return all != 0;
}

#if HWY_TARGET != HWY_SCALAR

using Four = hn::FixedTag<float, 4>;
using Vector = hn::Vec<Four>;

HWY_INLINE bool are_present(std::span<const Box<2>, 8> boxes) {
  const Four four;
  auto all = hn::FirstN(four, 4);
  for (std::size_t i = 0; i < boxes.size(); i += 2) {
    const Vector first = load_coordinates(four, &boxes[i], 0);
    const Vector second = load_coordinates(four, &boxes[i + 1], 0);
    all = hn::And(
        all, hn::Le(hn::ConcatLowerLower(four, second, first), hn::ConcatUpperUpper(four, second, first)));
  }
  return hn::AllTrue(four, all);
}

/// The fourth lane compares numbers of different axes, and is ignored.
HWY_INLINE bool are_present(std::span<const Box<3>, 8> boxes) {
  const Four four;
  auto all = hn::FirstN(four, 4);
  for (const Box<3>& box : boxes)
    all = hn::And(all,
                  hn::Le(load_coordinates(four, &box, 0), hn::Shuffle0321(load_coordinates(four, &box, 2))));
  return hn::AllTrue(four, hn::Or(all, hn::Eq(hn::Iota(four, 0.0F), hn::Set(four, 3.0F))));
}

#endif

template <int D, typename Real>
bool test_all(std::span<const Box<D, Real>> boxes) {
  constexpr std::size_t at_once = 8;
  std::size_t i = 0;
  for (; i + at_once <= boxes.size(); i += at_once) {
    if (!are_present(std::span<const Box<D, Real>, at_once>(boxes.subspan(i, at_once)))) return false;
  }
  return are_present(boxes.subspan(i));
}

}  // namespace

// Names for the dispatch below, which cannot name templates.
constexpr auto& present_2 = test_all<2, float>;
constexpr auto& present_3 = test_all<3, float>;
constexpr auto& double_present_2 = test_all<2, double>;
constexpr auto& double_present_3 = test_all<3, double>;

}  // namespace broadside::kernels::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace broadside::kernels {

HWY_EXPORT(present_2);
HWY_EXPORT(present_3);
HWY_EXPORT(double_present_2);
HWY_EXPORT(double_present_3);

template <>
bool all_present(std::span<const Box<2>> boxes) {
  return HWY_DYNAMIC_DISPATCH(present_2)(boxes);
}
template <>
bool all_present(std::span<const Box<3>> boxes) {
  return HWY_DYNAMIC_DISPATCH(present_3)(boxes);
}
template <>
bool all_present(std::span<const DoubleBox2> boxes) {
  return HWY_DYNAMIC_DISPATCH(double_present_2)(boxes);
}
template <>
bool all_present(std::span<const DoubleBox3> boxes) {
  return HWY_DYNAMIC_DISPATCH(double_present_3)(boxes);
}

}  // namespace broadside::kernels
#endif  // HWY_ONCE

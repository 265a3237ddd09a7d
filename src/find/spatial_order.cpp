// SpatialOrder: keys along a Z-order curve, and a radix sort.
#include "find/spatial_order.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/cell_axis.hpp"

namespace broadside::find {
namespace {

/// Puts a zero, or two in 3D, between the bits of a number.
template <int D>
std::uint32_t spread(std::uint32_t number) {
  std::uint32_t bits = 0;
  for (int bit = 0; bit < 11; ++bit) bits |= (number >> bit & 1) << (D * bit);
  return bits;
}

/// A box's key on the curve.
template <int D, typename Real>
class ZOrder {
 public:
  explicit ZOrder(std::span<const Box<D, Real>> boxes) : low_(boxes[0].min) {
    Point<D, Real> high = low_;
    for (const Box<D, Real>& box : boxes) {
      for (std::size_t axis = 0; axis < D; ++axis) {
        low_[axis] = std::min(low_[axis], box.min[axis]);
        high[axis] = std::max(high[axis], box.min[axis]);
      }
    }
    for (std::size_t axis = 0; axis < D; ++axis)
      cells_[axis] = {0, cells_per_axis / static_cast<float>(high[axis] - low_[axis]), cells_per_axis - 1};
    for (std::uint32_t cell = 0; cell < spread_.size(); ++cell) spread_[cell] = spread<D>(cell);
  }

  std::uint32_t operator()(const Box<D, Real>& box) const {
    std::uint32_t key = 0;
    for (std::size_t axis = 0; axis < D; ++axis)
      key |= spread_[cells_[axis](static_cast<float>(box.min[axis] - low_[axis]))] << axis;
    return key;
  }

 private:
  static constexpr float cells_per_axis = D == 2 ? 1 << 11 : 1 << 7;

  Point<D, Real> low_;
  std::array<core::CellAxis, D> cells_;
  std::array<std::uint32_t, static_cast<std::size_t>(cells_per_axis)> spread_;
};

}  // namespace

template <int D, typename Real>
std::span<const core::KeyedPlace> SpatialOrder<D, Real>::sort(std::span<const Box<D, Real>> boxes,
                                                              core::Parallel& parallel) {
  if (boxes.empty()) return {};
  const ZOrder<D, Real> curve(boxes);
  const std::span<core::KeyedPlace> places = radix_.places(boxes.size());
  parallel.for_ranges(boxes.size(), [&](core::Range range, std::size_t) {
    for (std::size_t i = range.begin; i < range.end; ++i)
      places[i] = {curve(boxes[i]), static_cast<std::uint32_t>(i)};
  });
  return radix_.sort(parallel);
}

template class SpatialOrder<2, float>;
template class SpatialOrder<3, float>;
template class SpatialOrder<2, double>;
template class SpatialOrder<3, double>;

}  // namespace broadside::find

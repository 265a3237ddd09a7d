// The mean and variance of boxes' centres on each axis, by which sweeps and trees choose an axis.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "broadside/box.hpp"

namespace broadside::lab::literature {

/// Accumulates the mean and variance of centres. Ignores infinite centres.
template <int D>
class Centres {
 public:
  void add(const Box<D>& box) noexcept {
    for (int axis = 0; axis < D; ++axis) {
      const double centre = (double{box.min[axis]} + double{box.max[axis]}) / 2;
      if (!std::isfinite(centre)) continue;
      ++count_[axis];
      sum_[axis] += centre;
      square_sum_[axis] += centre * centre;
    }
  }

  double mean(int axis) const noexcept { return count_[axis] == 0 ? 0 : sum_[axis] / count_[axis]; }

  double variance(int axis) const noexcept {
    return count_[axis] == 0 ? 0 : square_sum_[axis] / count_[axis] - mean(axis) * mean(axis);
  }

  /// The axis of maximum variance.
  int widest_axis() const noexcept {
    int widest = 0;
    for (int axis = 1; axis < D; ++axis) {
      if (variance(axis) > variance(widest)) widest = axis;
    }
    return widest;
  }

 private:
  std::array<double, D> count_{};
  std::array<double, D> sum_{};
  std::array<double, D> square_sum_{};
};

}  // namespace broadside::lab::literature

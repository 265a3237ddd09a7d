// Margins: how far boxes are enlarged, and when they are enlarged anew.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "broadside/box.hpp"

namespace broadside::core {

/// The margins of WorldOptions, in the number type of the boxes. A null velocity means that there is none.
template <int D, typename Real>
struct Margins {
  /// How many margins a kept box may be longer than its box. A newly enlarged one is longer by two.
  static constexpr Real max_margins = 6;

  Real margin;
  Real relative;
  Real frames;
  bool is_of_shortest = false;  ///< `relative` is a part of a box's shortest side, not of its longest

  /// Whether `margin` and `relative` apply. One that is given but rounds to 0 does: it limits the other to 0.
  bool has_margin = margin > 0;
  bool has_relative = relative > 0;

  /// Whether boxes are enlarged at all.
  bool any() const noexcept { return margin > 0 || relative > 0 || frames > 0; }

  /// The box with its margin on every side, and extended along its velocity. A sum of infinities that is NaN
  /// adds nothing, so an absent box stays absent.
  Box<D, Real> enlarged(Box<D, Real> box, const Point<D, Real>* velocity) const noexcept {
    const Real its_margin = margin_of(box);
    for (int axis = 0; axis < D; ++axis) {
      const Real way = velocity == nullptr ? 0 : frames * (*velocity)[axis];
      box.min[axis] = std::min(box.min[axis], box.min[axis] - its_margin + std::min<Real>(way, 0));
      box.max[axis] = std::max(box.max[axis], box.max[axis] + its_margin + std::max<Real>(way, 0));
    }
    return box;
  }

  /// Whether `kept` can stay the enlarged box of a moved box: it contains `box`, and is not far too long for
  /// it after the box shrank or slowed down. Branchless. False if only one of the two is absent.
  bool keeps(const Box<D, Real>& kept, const Box<D, Real>& box,
             const Point<D, Real>* velocity) const noexcept {
    const Real slack = max_margins * margin_of(box);
    unsigned keeps = 1;
    for (int axis = 0; axis < D; ++axis) {
      const Real way = velocity == nullptr ? 0 : std::abs(frames * (*velocity)[axis]);
      // False for NaN.
      const bool fits = kept.max[axis] - kept.min[axis] <= box.max[axis] - box.min[axis] + slack + way;
      keeps &= static_cast<unsigned>(kept.min[axis] <= box.min[axis]) &
               static_cast<unsigned>(box.max[axis] <= kept.max[axis]) & static_cast<unsigned>(fits);
    }
    return keeps != 0;
  }

  /// The margin of a box on each side. Infinite sides are ignored.
  Real margin_of(const Box<D, Real>& box) const noexcept {
    if (!has_relative) return margin;
    constexpr Real infinity = std::numeric_limits<Real>::infinity();
    Real longest = 0;
    Real shortest = infinity;
    for (int axis = 0; axis < D; ++axis) {
      const Real side = box.max[axis] - box.min[axis];
      longest = std::max(longest, side < infinity ? side : 0);
      shortest = std::min(shortest, side);
    }
    const Real share = relative * (is_of_shortest ? std::min(shortest, longest) : longest);
    return has_margin ? std::min(margin, share) : share;
  }
};

}  // namespace broadside::core

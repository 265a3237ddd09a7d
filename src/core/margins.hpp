// Margins: how far boxes are enlarged, and when that is done anew.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "broadside/box.hpp"

namespace broadside::core {

/// The distances of WorldOptions, as numbers of the boxes' type. A pointer to a velocity may be null: none.
template <int D, typename Real>
struct Margins {
  Real margin;
  Real relative;
  Real frames;
  bool is_of_shortest = false;  ///< whether `relative` is of a box's shortest side, instead of its longest

  /// Whether each of the two applies. A given one that rounds to 0 does apply: it limits the other one to 0.
  bool has_margin = margin > 0;
  bool has_relative = relative > 0;

  /// Whether boxes are enlarged at all.
  bool any() const noexcept { return margin > 0 || relative > 0 || frames > 0; }

  /// The box with its margin on every side, and extended along its velocity. Sums of infinities that are no
  /// number add nothing, so that an absent box stays absent.
  Box<D, Real> enlarged(Box<D, Real> box, const Point<D, Real>* velocity) const noexcept {
    const Real its_margin = margin_of(box);
    for (int axis = 0; axis < D; ++axis) {
      const Real way = velocity == nullptr ? 0 : frames * (*velocity)[axis];
      box.min[axis] = std::min(box.min[axis], box.min[axis] - its_margin + std::min<Real>(way, 0));
      box.max[axis] = std::max(box.max[axis], box.max[axis] + its_margin + std::max<Real>(way, 0));
    }
    return box;
  }

  /// Whether `kept` stays the enlarged box of a box that moved: it contains it, and is not far too long for a
  /// box that has shrunk or slowed down. Without a branch. No absent box stays another's.
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

 private:
  /// A new enlarged box is longer than its box by two margins.
  static constexpr Real max_margins = 6;

  /// A side that is not finite counts for nothing.
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

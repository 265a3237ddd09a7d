// outline(): checks the boxes, lets the algorithm lay itself out, and ends it at their bounds.
#include "broadside/debug/outline.hpp"

#include <algorithm>
#include <cmath>

#include "core/float_environment.hpp"
#include "interface/input_check.hpp"

namespace broadside {
namespace {

/// The bounds of the boxes' finite coordinates; 0 to 0 on an axis without any.
template <int D, typename Real>
Box<D, Real> finite_bounds(std::span<const Box<D, Real>> boxes) {
  Box<D, Real> bounds = absent_box<D, Real>();
  for (const Box<D, Real>& box : boxes) {
    for (int axis = 0; axis < D; ++axis) {
      for (const Real x : {box.min[axis], box.max[axis]}) {
        if (!std::isfinite(x)) continue;
        bounds.min[axis] = std::min(bounds.min[axis], x);
        bounds.max[axis] = std::max(bounds.max[axis], x);
      }
    }
  }
  for (int axis = 0; axis < D; ++axis) {
    if (!(bounds.min[axis] <= bounds.max[axis])) bounds.min[axis] = bounds.max[axis] = 0;
  }
  return bounds;
}

/// Ends what is infinite at the bounds.
template <int D, typename Real>
void make_finite(Box<D, Real>& part, const Box<D, Real>& bounds) {
  for (int axis = 0; axis < D; ++axis) {
    Real& min = part.min[axis];
    Real& max = part.max[axis];
    if (!std::isfinite(min)) min = std::isfinite(max) ? std::min(max, bounds.min[axis]) : bounds.min[axis];
    if (!std::isfinite(max)) max = std::max(min, bounds.max[axis]);
  }
}

}  // namespace

template <int D, typename Real>
Outline<D, Real> outline(PairFinder<D, Real>& finder,
                         std::type_identity_t<std::span<const Box<D, Real>>> boxes) {
  const core::DefaultEnvironment environment;
  core::check_count(boxes.size());
  core::check_boxes(boxes, 0, finder.bad_input());
  Outlined<D, Real>* const outlined = finder.outlined();
  // Copied first, since another thread may change the caller's boxes.
  std::vector<Box<D, Real>> present(boxes.begin(), boxes.end());
  std::erase_if(present, [](const Box<D, Real>& box) { return !is_present(box); });
  if (outlined == nullptr || present.empty()) return {};
  Outline<D, Real> outline = outlined->lay_out(present);
  const Box<D, Real> bounds = finite_bounds<D, Real>(present);
  for (auto& level : outline.levels) {
    for (Box<D, Real>& part : level) make_finite(part, bounds);
  }
  return outline;
}

template Outline<2> outline(PairFinder<2>&, std::span<const Box<2>>);
template Outline<3> outline(PairFinder<3>&, std::span<const Box<3>>);
template Outline<2, double> outline(PairFinder<2, double>&, std::span<const Box<2, double>>);
template Outline<3, double> outline(PairFinder<3, double>&, std::span<const Box<3, double>>);

}  // namespace broadside

// outline(): checks the boxes, asks the algorithm for its outline, and clips it to the boxes' bounds.
#include "broadside/debug/outline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <vector>

#include "algorithms/registry.hpp"
#include "core/float_environment.hpp"
#include "core/input_check.hpp"
#include "core/rounding.hpp"

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

/// Clips infinite sides to the bounds.
template <int D, typename Real>
void make_finite(Box<D, Real>& part, const Box<D, Real>& bounds) {
  for (int axis = 0; axis < D; ++axis) {
    Real& min = part.min[axis];
    Real& max = part.max[axis];
    if (!std::isfinite(min)) min = std::isfinite(max) ? std::min(max, bounds.min[axis]) : bounds.min[axis];
    if (!std::isfinite(max)) max = std::max(min, bounds.max[axis]);
  }
}

/// Lays out doubles that are rounded linearly.
template <int D>
Outline<D, double> lay_out_rounded(const MakeOutline<D>& make, std::span<const Box<D, double>> boxes,
                                   const Workers& workers, const Settings& settings) {
  const std::array<core::LinearRounding, D> fit = core::fit_linear<D>(boxes);
  std::vector<Box<D>> floats(boxes.size());
  std::transform(boxes.begin(), boxes.end(), floats.begin(),
                 [&](const auto& box) { return core::rounded(box, fit); });
  const Outline<D> laid_out = make(floats, workers, settings);
  Outline<D, double> outline{laid_out.kind, laid_out.caption, laid_out.swept_axis, {}};
  for (const auto& level : laid_out.levels) {
    auto& parts = outline.levels.emplace_back(level.size());
    for (std::size_t i = 0; i < level.size(); ++i) {
      for (int axis = 0; axis < D; ++axis) {
        parts[i].min[axis] = fit[axis].back(level[i].min[axis]);
        parts[i].max[axis] = fit[axis].back(level[i].max[axis]);
      }
    }
  }
  return outline;
}

}  // namespace

template <int D, typename Real>
Outline<D, Real> outline(const Algorithm& algorithm, const Spec& spec, std::span<const Box<D, Real>> boxes,
                         const Workers& workers) {
  const core::DefaultEnvironment environment;
  core::check_count(boxes.size());
  core::check_boxes(boxes);
  const Settings settings(spec, algorithm.tunables);
  // Copied first, since another thread may change the caller's boxes.
  std::vector<Box<D, Real>> present(boxes.begin(), boxes.end());
  std::erase_if(present, [](const Box<D, Real>& box) { return !is_present(box); });
  const MakeOutline<D>& make = algorithm.in<D>().outline;
  if (!make || present.empty()) return {};
  Outline<D, Real> outline;
  if constexpr (std::is_same_v<Real, float>)
    outline = make(present, workers, settings);
  else
    outline = lay_out_rounded<D>(make, present, workers, settings);
  const Box<D, Real> bounds = finite_bounds<D, Real>(present);
  for (auto& level : outline.levels) {
    for (Box<D, Real>& part : level) make_finite(part, bounds);
  }
  return outline;
}

template <int D, typename Real>
Outline<D, Real> outline(const Spec& spec, std::span<const Box<D, Real>> boxes, const Workers& workers) {
  return outline<D, Real>(algorithm::require_algorithm(spec.name), spec, boxes, workers);
}

template Outline<2, float> outline(const Algorithm&, const Spec&, std::span<const Box<2, float>>,
                                   const Workers&);
template Outline<2, float> outline(const Spec&, std::span<const Box<2, float>>, const Workers&);
template Outline<3, float> outline(const Algorithm&, const Spec&, std::span<const Box<3, float>>,
                                   const Workers&);
template Outline<3, float> outline(const Spec&, std::span<const Box<3, float>>, const Workers&);
template Outline<2, double> outline(const Algorithm&, const Spec&, std::span<const Box<2, double>>,
                                    const Workers&);
template Outline<2, double> outline(const Spec&, std::span<const Box<2, double>>, const Workers&);
template Outline<3, double> outline(const Algorithm&, const Spec&, std::span<const Box<3, double>>,
                                    const Workers&);
template Outline<3, double> outline(const Spec&, std::span<const Box<3, double>>, const Workers&);

}  // namespace broadside

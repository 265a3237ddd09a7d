// margins_for(): margins by a sample of the boxes that changed.
#include "interface/margins.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>

#include "core/sample.hpp"

namespace broadside::core {
namespace {

// Thresholds: docs/lab-notes.md, "Enlarged boxes within trackers", has the measurements.

/// Boxes are enlarged up to this displacement in a frame, as a fraction of their shortest side.
constexpr double max_displacement = 0.0125;

/// A margin divided by that displacement: about the minimum number of frames for which boxes stay within it.
/// Then the limits of a margin, as fractions of a box's shortest side: a large margin makes far more
/// candidates than pairs.
constexpr double frames_within_margin = 48;
constexpr double min_margin = 0.01;
constexpr double max_margin = 0.2;

/// How many displacements are sampled, and the fraction of them that the margins should cover.
constexpr std::size_t sampled_displacements = 64;
constexpr double covered = 0.75;

/// The maximum margin follows this quantile of the covered boxes' displacements, so that a few large boxes do
/// not decide for all others. The factor after it allows for the boxes beyond the quantile.
constexpr double covered_by_greatest = 0.9;
constexpr double added_to_greatest = 1.25;

/// The upper limit of the maximum margin divided by a displacement. If boxes hardly move, the quotient of two
/// numbers near 0 may be anything.
constexpr double max_frames_within_greatest = 1e6;

/// How far a box moved in a frame.
template <typename Real>
struct Displacement {
  Real relative;  ///< over the shortest side; infinite for absent boxes and for moving boxes with a side of 0
  Real absolute;
};

template <int D, typename Real>
Displacement<Real> displacement_of(const Box<D, Real>& before, const Box<D, Real>& now) {
  Real displacement = 0;
  Real side = std::numeric_limits<Real>::infinity();
  for (int axis = 0; axis < D; ++axis) {
    displacement = std::max({displacement, std::abs(now.min[axis] - before.min[axis]),
                             std::abs(now.max[axis] - before.max[axis])});
    side = std::min(side, now.max[axis] - now.min[axis]);
  }
  const Real relative = displacement / side;
  return {relative >= 0 ? relative : std::numeric_limits<Real>::infinity(), displacement};
}

}  // namespace

/// A margin is a fraction of a box's shortest side; with a fraction of the longest side, thin boxes would
/// meet many more boxes. It is also limited in proportion to the boxes' motion, so that large boxes at rest
/// do not meet all small boxes around them. Both values come from the same boxes: different boxes could
/// exceed two independent quantiles, which would cover few boxes together.
template <int D, typename Real>
std::optional<Margins<D, Real>> margins_for(const Change<D, Real>& change) {
  std::array<Displacement<Real>, sampled_displacements> sampled;
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    const std::size_t place = index(change.changed[sampled_place(i, change.changed.size())]);
    sampled[i] = displacement_of<D, Real>(change.before[place], change.now[place]);
  }
  const auto last = sampled.begin() + static_cast<std::ptrdiff_t>(covered * (sampled.size() - 1));
  std::nth_element(sampled.begin(), last, sampled.end(), [](const auto& a, const auto& b) {
    return std::tie(a.relative, a.absolute) < std::tie(b.relative, b.absolute);
  });
  const Real displacement = last->relative;
  if (!(displacement <= static_cast<Real>(max_displacement))) return std::nullopt;
  const auto greatest =
      sampled.begin() +
      static_cast<std::ptrdiff_t>(covered_by_greatest * static_cast<double>(last - sampled.begin()));
  std::nth_element(sampled.begin(), greatest, last + 1,
                   [](const auto& a, const auto& b) { return a.absolute < b.absolute; });
  // No margins if the listed boxes did not move.
  if (!(greatest->absolute > 0)) return std::nullopt;
  const Real relative = std::clamp(static_cast<Real>(frames_within_margin) * displacement,
                                   static_cast<Real>(min_margin), static_cast<Real>(max_margin));
  const Real frames = std::min(static_cast<Real>(added_to_greatest) * relative / displacement,
                               static_cast<Real>(max_frames_within_greatest));
  return Margins<D, Real>{
      .margin = greatest->absolute * frames, .relative = relative, .frames = 0, .is_of_shortest = true};
}

template std::optional<Margins<2, float>> margins_for(const Change<2, float>&);
template std::optional<Margins<3, float>> margins_for(const Change<3, float>&);
template std::optional<Margins<2, double>> margins_for(const Change<2, double>&);
template std::optional<Margins<3, double>> margins_for(const Change<3, double>&);

}  // namespace broadside::core

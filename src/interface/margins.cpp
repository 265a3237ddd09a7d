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

/// The displacement in a frame, over their shortest side, up to which boxes are enlarged.
constexpr double max_displacement = 0.0125;

/// A margin over that displacement: boxes stay within it for at least about so many frames. And its limits,
/// over a box's shortest side: a large one makes far more candidates than pairs.
constexpr double frames_within_margin = 48;
constexpr double min_margin = 0.01;
constexpr double max_margin = 0.2;

/// How many displacements are sampled, and the part of them that the margins are made for.
constexpr std::size_t sampled_displacements = 64;
constexpr double covered = 0.75;

/// Of the boxes that are covered, the part by whose displacements the greatest margin goes, so that a few
/// large boxes do not decide about all others; and what is added, for those beyond.
constexpr double covered_by_greatest = 0.9;
constexpr double added_to_greatest = 1.25;

/// The most that the greatest margin is over a displacement: where boxes hardly move, the quotient of two
/// numbers near 0 may be anything.
constexpr double max_frames_within_greatest = 1e6;

/// How far a box moved in a frame.
template <typename Real>
struct Displacement {
  Real relative;  ///< over its shortest side; infinite for absent boxes, and those that move and have no side
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

/// Margins are a part of a box's shortest side: by a part of the longest, thin boxes would meet many more.
/// And at most by what boxes move, so that large ones at rest do not meet all small ones around them. Both go
/// by the same boxes: two quantiles, each of all, may be exceeded by different boxes, and cover few together.
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
  // None where the boxes that are listed did not move.
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

// StaggeredMargins: chooses the margins of a tracker's enlarged boxes, and changes them.
#include "track/staggered_margins.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

#include "core/sample.hpp"

namespace broadside::track {
namespace {

// Thresholds: docs/lab-notes.md, "Enlarged boxes within trackers", has the measurements.

/// Boxes are enlarged up to this displacement in a frame, as a fraction of their shortest side.
constexpr double max_displacement = 0.0125;

/// A margin divided by the displacement in a frame: about the minimum number of frames for which boxes stay
/// within it. Then the limits of a margin, as fractions of a box's shortest side: a large margin makes far
/// more candidates than pairs.
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

/// A box first gets a share of its margin, from this one to the whole.
constexpr double min_share_of_margin = 0.125;

/// After each sweep over all boxes, margins are divided by `shrinking` if less than one box in `calm_part`
/// left its enlarged box in it. They grow by the same factor, and never shrink again, once more than one in
/// `restless_part` leaves in a frame.
constexpr std::size_t calm_part = 64;
constexpr std::size_t restless_part = 32;
constexpr double shrinking = 4;

template <int D, typename Real>
core::Margins<D, Real> scaled(core::Margins<D, Real> margins, double factor) {
  margins.margin *= static_cast<Real>(factor);
  margins.relative *= static_cast<Real>(factor);
  return margins;
}

/// Whether an enlarged box is longer by at most an eighth of the box's shortest side. A smaller margin would
/// save few candidates.
template <int D, typename Real>
bool is_little_larger(const Box<D, Real>& enlarged, const Box<D, Real>& box) {
  constexpr Real little = 0.125;
  Real side = std::numeric_limits<Real>::infinity();
  Real longer = 0;
  for (int axis = 0; axis < D; ++axis) {
    const Real length = box.max[axis] - box.min[axis];
    side = std::min(side, length);
    longer = std::max(longer, enlarged.max[axis] - enlarged.min[axis] - length);
  }
  return longer <= little * side;
}

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
auto StaggeredMargins<D, Real>::suiting(const Change<D, Real>& change)
    -> std::optional<core::Margins<D, Real>> {
  std::array<Displacement<Real>, sampled_displacements> sampled;
  for (std::size_t i = 0; i < sampled.size(); ++i) {
    const std::size_t place = index(change.changed[core::sampled_place(i, change.changed.size())]);
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
  return core::Margins<D, Real>{
      .margin = greatest->absolute * frames, .relative = relative, .frames = 0, .is_of_shortest = true};
}

/// The margins of boxes of median size: large boxes do not meet all small ones around them.
template <int D, typename Real>
auto StaggeredMargins<D, Real>::guessed(std::span<const Box<D, Real>> boxes)
    -> std::optional<core::Margins<D, Real>> {
  std::vector<Real> sides;
  core::for_present_sample(boxes, sampled_displacements, [&](const Box<D, Real>& box) {
    Real side = std::numeric_limits<Real>::infinity();
    for (int axis = 0; axis < D; ++axis) side = std::min(side, box.max[axis] - box.min[axis]);
    sides.push_back(side);
  });
  const Real margin = static_cast<Real>(max_margin) * core::median(sides);
  if (!(margin > 0 && margin < std::numeric_limits<Real>::infinity())) return std::nullopt;
  return core::Margins<D, Real>{
      .margin = margin, .relative = static_cast<Real>(max_margin), .frames = 0, .is_of_shortest = true};
}

template <int D, typename Real>
void StaggeredMargins<D, Real>::enlarge_all(std::span<const Box<D, Real>> boxes,
                                            std::span<Box<D, Real>> enlarged) const {
  constexpr std::size_t steps = std::size_t{1} << 20;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const Real place = static_cast<Real>(core::sampled_place(i, steps)) / steps;
    const Real share =
        static_cast<Real>(min_share_of_margin) + static_cast<Real>(1 - min_share_of_margin) * place;
    const Box<D, Real>& box = boxes[i];
    const Real margin = share * now_.margin_of(box);
    // Coordinate by coordinate, since a copy of the whole box would wait for these stores.
    for (int axis = 0; axis < D; ++axis) {
      enlarged[i].min[axis] = std::min(box.min[axis], box.min[axis] - margin);
      enlarged[i].max[axis] = std::max(box.max[axis], box.max[axis] + margin);
    }
  }
}

template <int D, typename Real>
bool StaggeredMargins<D, Real>::are_much_too_large(const Box<D, Real>& enlarged,
                                                   const Box<D, Real>& box) const {
  return !now_.keeps(enlarged, box, nullptr) && !is_little_larger(enlarged, box);
}

template <int D, typename Real>
void StaggeredMargins<D, Real>::note_left(std::size_t left, std::size_t boxes) {
  left_ += left;
  if (left <= boxes / restless_part || share_ >= 1) return;
  may_shrink_ = false;
  share_ = std::min(1.0, shrinking * share_);
  now_ = scaled(first_, share_);
}

template <int D, typename Real>
void StaggeredMargins<D, Real>::end_sweep(std::size_t boxes) {
  next_ = 0;
  const std::size_t left = std::exchange(left_, 0);
  if (left >= boxes / calm_part || !may_shrink_) return;
  const double least = min_margin / static_cast<double>(first_.relative);
  share_ = std::min(share_, std::max(share_ / shrinking, least));
  now_ = scaled(first_, share_);
}

template class StaggeredMargins<2, float>;
template class StaggeredMargins<3, float>;
template class StaggeredMargins<2, double>;
template class StaggeredMargins<3, double>;

}  // namespace broadside::track

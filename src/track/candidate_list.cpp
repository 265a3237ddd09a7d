// CandidateList: chooses margins, and keeps and tests the pairs of enlarged boxes.
#include "track/candidate_list.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <tuple>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/sample.hpp"
#include "core/sort_pairs.hpp"
#include "kernels/overlap_flags.hpp"
#include "track/candidate_limit.hpp"

namespace broadside::track {
namespace {

/// The maximum number of candidates, per pair that holds and per box. If there would be more, boxes are no
/// longer enlarged.
constexpr std::size_t max_candidates_per_pair = 4;
constexpr std::size_t max_candidates_per_box = 16;

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
auto CandidateList<D, Real>::margins_for(const Change<D, Real>& change)
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

template <int D, typename Real>
std::uint64_t CandidateList<D, Real>::start(const Change<D, Real>& change,
                                            const core::Margins<D, Real>& margins,
                                            FollowOrFind<D, Real>& pairs, bool& changes_pairs) {
  const std::size_t size = change.now.size();
  margins_ = margins;
  now_.resize(size);
  for (std::size_t i = 0; i < size; ++i) now_[i] = margins_.enlarged(change.now[i], nullptr);
  CandidateCollector<D, Real> collector(candidates_, max_candidates_per_box * size, max_candidates_per_pair,
                                        change.now);
  const std::optional<Statistics> found =
      pairs.find_within_limits(now_, change.filters_now, change.workers, collector);
  collector.flush();
  core::sort_unique(candidates_, spare_);
  test_candidates(change.now, change.workers);
  holding_ = static_cast<std::size_t>(std::count(holds_.begin(), holds_.end(), std::uint8_t{1}));
  changes_pairs = true;
  pairs.start_at(now_, candidates_.size(), found, change.workers);
  before_ = now_;
  flags_.assign(size, 0);
  return found.value_or(Statistics{}).tests + candidates_.size();
}

template <int D, typename Real>
Statistics CandidateList<D, Real>::update(const Change<D, Real>& change, FollowOrFind<D, Real>& pairs,
                                          PairSink& begun, PairSink& ended) {
  left_.clear();
  last_ = {.boxes = change.now.size(), .changed = change.changed.size()};
  if (change.changed.empty()) return {};
  enlarge_anew(change);
  Statistics statistics;
  if (!left_.empty()) {
    statistics = find_candidates(change, pairs);
    change_candidates(ended);
    for (const BoxId id : left_) {
      before_[index(id)] = now_[index(id)];
      flags_[index(id)] = 0;
    }
  }
  report(change, begun, ended);
  last_.left = left_.size();
  last_.candidates = candidates_.size();
  statistics.tests += last_.candidates;
  return statistics;
}

template <int D, typename Real>
std::size_t CandidateList<D, Real>::max_candidates() const noexcept {
  return max_candidates_per_box * now_.size() + max_candidates_per_pair * holding_;
}

/// Sets begun_ and ended_ to the candidates that began and ended. Throws LimitPassed.
template <int D, typename Real>
Statistics CandidateList<D, Real>::find_candidates(const Change<D, Real>& change,
                                                   FollowOrFind<D, Real>& pairs) {
  std::optional<Statistics> statistics;
  begun_.clear();
  ended_.clear();
  const std::size_t max = max_candidates();
  {
    PairCollector begun_candidates(begun_);
    PairCollector ended_candidates(ended_);
    // An event may be written more than once.
    LimitSink limited(2 * max, begun_candidates);
    pairs.limit_pairs(max);
    statistics = pairs.update({.before = before_,
                               .now = now_,
                               .changed = left_,
                               .flags = flags_,
                               .filters_before = change.filters_before,
                               .filters_now = change.filters_now,
                               .workers = change.workers},
                              limited, ended_candidates);
    limited.flush();
    begun_candidates.flush();
    ended_candidates.flush();
  }
  core::sort_unique(begun_, spare_);
  core::sort_unique(ended_, spare_);
  if (candidates_.size() + begun_.size() > max + ended_.size()) throw LimitPassed();
  return statistics.value_or(Statistics{});
}

/// Sets left_ and flags_, and enlarges the boxes in left_.
template <int D, typename Real>
void CandidateList<D, Real>::enlarge_anew(const Change<D, Real>& change) {
  const std::size_t size = change.now.size();
  before_.resize(size, absent_box<D, Real>());
  now_.resize(size, absent_box<D, Real>());
  flags_.resize(size);
  left_.resize(change.changed.size());
  const bool has_filters = !change.filters_now.empty();
  std::size_t count = 0;
  for (const BoxId id : change.changed) {
    const std::size_t i = index(id);
    const bool stays = margins_.keeps(now_[i], change.now[i], nullptr) &&
                       !(has_filters && change.filters_before[i] != change.filters_now[i]);
    left_[count] = id;
    count += static_cast<std::size_t>(!stays);
  }
  left_.resize(count);
  for (const BoxId id : left_) {
    now_[index(id)] = margins_.enlarged(change.now[index(id)], nullptr);
    flags_[index(id)] = 1;
  }
}

/// Removes the candidates that ended, with an event if they held, and inserts those that began.
template <int D, typename Real>
void CandidateList<D, Real>::change_candidates(PairSink& ended) {
  if (begun_.empty() && ended_.empty()) return;
  spare_.clear();
  held_.clear();
  auto next_begun = begun_.begin();
  auto next_ended = ended_.begin();
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Pair pair = candidates_[i];
    if (next_ended != ended_.end() && *next_ended == pair) {
      ++next_ended;
      if (holds_[i] == 0) continue;
      ended.add(pair.first, pair.second);
      --holding_;
      continue;
    }
    for (; next_begun != begun_.end() && *next_begun < pair; ++next_begun) {
      spare_.push_back(*next_begun);
      held_.push_back(0);
    }
    spare_.push_back(pair);
    held_.push_back(holds_[i]);
  }
  spare_.insert(spare_.end(), next_begun, begun_.end());
  held_.resize(spare_.size());
  std::swap(candidates_, spare_);
  std::swap(holds_, held_);
}

/// Sets holds_.
template <int D, typename Real>
void CandidateList<D, Real>::test_candidates(std::span<const Box<D, Real>> boxes, const Workers& workers) {
  holds_.resize(candidates_.size());
  parallel_.start(workers, candidates_.size() / pairs_per_box);
  parallel_.for_ranges(candidates_.size(), [&](core::Range range, std::size_t) {
    kernels::set_overlap_flags(boxes, std::span<const Pair>(candidates_).subspan(range.begin, range.size()),
                               holds_.data() + range.begin);
  });
}

/// Tests the candidates, and reports those that began or ceased to hold.
template <int D, typename Real>
void CandidateList<D, Real>::report(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  std::swap(held_, holds_);
  test_candidates(change.now, change.workers);
  const auto compare = [&](std::size_t i) {
    if (holds_[i] == held_[i]) return;
    (holds_[i] != 0 ? begun : ended).add(candidates_[i].first, candidates_[i].second);
    holding_ += holds_[i];
    holding_ -= held_[i];
  };
  // Nearly all candidates are unchanged.
  constexpr std::size_t at_once = sizeof(std::uint64_t);
  std::size_t i = 0;
  for (; i + at_once <= candidates_.size(); i += at_once) {
    if (std::memcmp(&holds_[i], &held_[i], at_once) == 0) continue;
    for (std::size_t j = i; j < i + at_once; ++j) compare(j);
  }
  for (; i < candidates_.size(); ++i) compare(i);
}

template class CandidateList<2, float>;
template class CandidateList<3, float>;
template class CandidateList<2, double>;
template class CandidateList<3, double>;

}  // namespace broadside::track

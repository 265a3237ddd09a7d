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
#include "kernels/boxes_outside.hpp"
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

/// The number of candidates that are tested before what changed is noted.
constexpr std::size_t tested_at_once = 512;

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

/// All boxes are enlarged in one frame, but boxes that move alike must not leave their enlarged boxes in one
/// frame. So a box first gets a share of its margin, from this one to the whole, by its id.
constexpr double min_share_of_margin = 0.125;

/// The number of frames in which a share of the boxes is looked at each, so that all are. Then the margins
/// are divided by `shrinking` if less than one in `calm_part` of the boxes left their enlarged boxes: smaller
/// margins make fewer candidates. They grow by the same factor, and never shrink again, once more than one in
/// `restless_part` leaves in a frame.
constexpr std::size_t frames_of_sweep = 64;
constexpr std::size_t calm_part = 64;
constexpr std::size_t restless_part = 32;
constexpr double shrinking = 4;

/// Steps of the golden ratio fill [0, 1) evenly, however many there are.
double share_of_margin(std::size_t i) {
  const auto step = static_cast<std::uint32_t>(i * 0x9e3779b9U);
  return min_share_of_margin + (1 - min_share_of_margin) * 0x1p-32 * step;
}

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
                                            FollowOrFind<D, Real>& pairs, const EventSinks* events) {
  const std::size_t size = change.now.size();
  margins_ = margins;
  sweep_ = {.largest = margins};
  is_sorted_ = false;
  is_followed_ = false;
  now_.resize(size);
  for (std::size_t i = 0; i < size; ++i)
    now_[i] = scaled(margins_, share_of_margin(i)).enlarged(change.now[i], nullptr);
  pairs.lend_memory(candidates_);
  CandidateCollector<D, Real> collector(candidates_, max_candidates_per_box * size, max_candidates_per_pair,
                                        change.now);
  found_ = pairs.find_within_limits(now_, change.filters_now, change.workers, collector);
  collector.flush();
  test_candidates(change.now, change.workers);
  holding_ = static_cast<std::size_t>(std::count(holds_.begin(), holds_.end(), std::uint8_t{1}));
  before_ = now_;
  flags_.assign(size, 0);
  if (events != nullptr) {
    begun_.clear();
    begun_.reserve(holding_);
    for (std::size_t i = 0; i < candidates_.size(); ++i) {
      if (holds_[i] != 0) begun_.push_back(candidates_[i]);
    }
    pairs.report(change, begun_, events->begun, events->ended);
  }
  return found_.value_or(Statistics{}).tests + candidates_.size();
}

template <int D, typename Real>
Statistics CandidateList<D, Real>::update(const Change<D, Real>& change, FollowOrFind<D, Real>& pairs,
                                          PairSink& begun, PairSink& ended) {
  left_.clear();
  last_ = {.boxes = change.now.size(), .changed = change.changed.size()};
  if (change.changed.empty()) return {};
  if (!std::exchange(is_sorted_, true)) {
    core::sort_unique(candidates_, sorting_);
    core::give_back(sorting_);
    test_candidates(change.before, change.workers);
  }
  enlarge_anew(change);
  Statistics statistics;
  if (!left_.empty()) {
    if (!std::exchange(is_followed_, true))
      pairs.start_at(before_, candidates_.size(), found_, change.workers);
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
  core::sort_unique(begun_, sorting_);
  core::sort_unique(ended_, sorting_);
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
  find_left(change);
  for (const BoxId id : left_) flags_[index(id)] = 1;
  sweep_.left += left_.size();
  if (left_.size() > size / restless_part) grow_margins();
  review(change);
  for (const BoxId id : left_) now_[index(id)] = margins_.enlarged(change.now[index(id)], nullptr);
}

/// Sets left_.
template <int D, typename Real>
void CandidateList<D, Real>::find_left(const Change<D, Real>& change) {
  const bool has_filters = !change.filters_now.empty();
  left_.resize(change.changed.size());
  std::size_t count = 0;
  if (change.changed.size() == change.now.size() && !has_filters) {
    count = kernels::select_outside(change.now, std::span<const Box<D, Real>>(now_), left_.data());
  } else {
    for (const BoxId id : change.changed) {
      const std::size_t i = index(id);
      const bool stays = margins_.keeps(now_[i], change.now[i], nullptr) &&
                         !(has_filters && change.filters_before[i] != change.filters_now[i]);
      left_[count] = id;
      count += static_cast<std::size_t>(!stays);
    }
  }
  left_.resize(count);
}

/// For the boxes that are enlarged from now on.
template <int D, typename Real>
void CandidateList<D, Real>::grow_margins() {
  if (sweep_.share >= 1) return;
  sweep_.may_shrink = false;
  sweep_.share = std::min(1.0, shrinking * sweep_.share);
  margins_ = scaled(sweep_.largest, sweep_.share);
}

/// Adds to left_ those of a share of the boxes whose enlarged boxes are far too large, as after boxes or
/// margins shrank. Shrinks the margins after a sweep over all boxes in which hardly any left.
template <int D, typename Real>
void CandidateList<D, Real>::review(const Change<D, Real>& change) {
  const std::size_t size = change.now.size();
  const std::size_t end = std::min(size, sweep_.next + size / frames_of_sweep + 1);
  for (; sweep_.next < end; ++sweep_.next) {
    const std::size_t i = sweep_.next;
    const Box<D, Real>& box = change.now[i];
    if (flags_[i] != 0 || margins_.keeps(now_[i], box, nullptr) || is_little_larger(now_[i], box)) continue;
    flags_[i] = 1;
    left_.push_back(BoxId(i));
  }
  if (sweep_.next < size) return;
  sweep_.next = 0;
  const std::size_t left = std::exchange(sweep_.left, 0);
  if (left >= size / calm_part || !sweep_.may_shrink) return;
  const double least = min_margin / static_cast<double>(sweep_.largest.relative);
  sweep_.share = std::min(sweep_.share, std::max(sweep_.share / shrinking, least));
  margins_ = scaled(sweep_.largest, sweep_.share);
}

/// Removes the candidates that ended, with an event if they held, and inserts those that began. Both are few:
/// in place, the candidates between two of them are moved as a block.
template <int D, typename Real>
void CandidateList<D, Real>::change_candidates(PairSink& ended) {
  const auto move = [this](std::size_t begin, std::size_t end, std::size_t to) {
    if (begin == to || begin == end) return;
    std::memmove(&candidates_[to], &candidates_[begin], (end - begin) * sizeof(Pair));
    std::memmove(&holds_[to], &holds_[begin], end - begin);
  };
  std::size_t from = 0;
  std::size_t to = 0;
  for (const Pair pair : ended_) {
    const std::size_t place = place_of(pair, from, candidates_.size());
    move(from, place, to);
    to += place - from;
    from = place;
    if (from == candidates_.size() || candidates_[from] != pair) continue;
    if (holds_[from++] == 0) continue;
    ended.add(pair.first, pair.second);
    --holding_;
  }
  move(from, candidates_.size(), to);
  std::size_t end = to + candidates_.size() - from;
  places_.clear();
  for (const Pair pair : begun_) places_.push_back(place_of(pair, places_.empty() ? 0 : places_.back(), end));
  core::resize_by_eighths(candidates_, end + begun_.size());
  core::resize_by_eighths(holds_, candidates_.size());
  // From the last one to the first, since candidates move towards the end.
  for (std::size_t i = begun_.size(); i-- > 0;) {
    move(places_[i], end, places_[i] + i + 1);
    end = places_[i];
    candidates_[end + i] = begun_[i];
    holds_[end + i] = 0;
  }
}

/// The place of the first candidate in [from, end) that is not below `pair`, by steps that double; else
/// `end`.
template <int D, typename Real>
std::size_t CandidateList<D, Real>::place_of(Pair pair, std::size_t from, std::size_t end) const noexcept {
  std::size_t to = from;
  for (std::size_t step = 1; to < end && candidates_[to] < pair; step *= 2) {
    from = to + 1;
    to += step;
  }
  const auto begin = candidates_.begin();
  return static_cast<std::size_t>(std::lower_bound(begin + static_cast<std::ptrdiff_t>(from),
                                                   begin + static_cast<std::ptrdiff_t>(std::min(to, end)),
                                                   pair) -
                                  begin);
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
  parallel_.start(change.workers, candidates_.size() / pairs_per_box);
  toggled_.resize(std::max(toggled_.size(), parallel_.range_count()));
  parallel_.for_numbered_ranges(candidates_.size(), [&](std::size_t number, core::Range range, std::size_t) {
    std::vector<std::uint32_t>& toggled = toggled_[number];
    toggled.clear();
    std::array<std::uint32_t, tested_at_once> changed;
    for (std::size_t begin = range.begin; begin < range.end; begin += tested_at_once) {
      const auto some =
          std::span<const Pair>(candidates_).subspan(begin, std::min(tested_at_once, range.end - begin));
      const std::size_t count =
          kernels::renew_overlap_flags(change.now, some, &holds_[begin], changed.data());
      for (std::size_t i = 0; i < count; ++i)
        toggled.push_back(static_cast<std::uint32_t>(begin + changed[i]));
    }
  });
  for (std::size_t number = 0; number < parallel_.range_count(); ++number) {
    for (const std::size_t i : toggled_[number]) {
      const bool holds = holds_[i] != 0;
      (holds ? begun : ended).add(candidates_[i].first, candidates_[i].second);
      holding_ = holds ? holding_ + 1 : holding_ - 1;
    }
  }
}

template class CandidateList<2, float>;
template class CandidateList<3, float>;
template class CandidateList<2, double>;
template class CandidateList<3, double>;

}  // namespace broadside::track

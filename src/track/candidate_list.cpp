// CandidateList: keeps and tests the pairs of enlarged boxes.
#include "track/candidate_list.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/sort_pairs.hpp"
#include "kernels/boxes_outside.hpp"
#include "kernels/overlap_flags.hpp"
#include "track/candidate_limit.hpp"

namespace broadside::track {
namespace {

// Thresholds: docs/lab-notes.md, "Enlarged boxes within trackers", has the measurements.

/// The maximum number of candidates, per pair that holds and per box. If there would be more, boxes are no
/// longer enlarged.
constexpr std::size_t max_candidates_per_pair = 4;
constexpr std::size_t max_candidates_per_box = 16;

/// The number of candidates that are tested before what changed is noted.
constexpr std::size_t tested_at_once = 512;

/// The number of frames over which a structure takes enlarged boxes, if none leaves before.
constexpr std::size_t frames_to_follow = 16;

/// Branchless. Every box has an absent one within it, as in kernels::select_outside().
template <int D, typename Real>
bool is_within(const Box<D, Real>& enlarged, const Box<D, Real>& box) {
  unsigned within = 1;
  for (int axis = 0; axis < D; ++axis) {
    within &= static_cast<unsigned>(enlarged.min[axis] <= box.min[axis]) &
              static_cast<unsigned>(box.max[axis] <= enlarged.max[axis]);
  }
  return within != 0;
}

}  // namespace

template <int D, typename Real>
std::uint64_t CandidateList<D, Real>::start(const Change<D, Real>& change,
                                            const core::Margins<D, Real>& margins,
                                            FollowOrFind<D, Real>& pairs, const EventSinks* events) {
  find_all(change, margins, pairs);
  test_all(change.now, change.workers);
  if (events != nullptr) {
    select_holding(begun_);
    pairs.report(change, begun_, events->begun, events->ended);
  }
  return found_.value_or(Statistics{}).tests + candidates_.size();
}

template <int D, typename Real>
std::optional<Statistics> CandidateList<D, Real>::prepare(const Change<D, Real>& change,
                                                          const core::Margins<D, Real>& margins,
                                                          FollowOrFind<D, Real>& pairs,
                                                          std::vector<Pair>& holding) {
  find_all(change, margins, pairs);
  before_.assign(change.now.begin(), change.now.end());
  partly_ = before_;
  sort_all();
  test_all(change.now, change.workers);
  select_holding(holding);
  std::optional<Statistics> statistics = found_;
  if (statistics) statistics->tests += candidates_.size();
  return statistics;
}

template <int D, typename Real>
void CandidateList<D, Real>::set_margins(const core::Margins<D, Real>& margins) {
  const bool are_smaller = margins.relative < margins_.now().relative;
  margins_ = StaggeredMargins<D, Real>(margins);
  if (!are_smaller) return;
  std::vector<Box<D, Real>> smaller(before_.size());
  margins_.enlarge_all(before_, smaller);
  for (std::size_t i = 0; i < smaller.size(); ++i) {
    for (int axis = 0; axis < D; ++axis) {
      now_[i].min[axis] = std::max(now_[i].min[axis], smaller[i].min[axis]);
      now_[i].max[axis] = std::min(now_[i].max[axis], smaller[i].max[axis]);
    }
  }
  std::vector<std::uint8_t> stays(candidates_.size());
  kernels::set_overlap_flags(std::span<const Box<D, Real>>(now_), std::span<const Pair>(candidates_),
                             stays.data());
  std::size_t count = 0;
  for (std::size_t i = 0; i < stays.size(); ++i) {
    candidates_[count] = candidates_[i];
    holds_[count] = holds_[i];
    count += stays[i];
  }
  candidates_.resize(count);
  holds_.resize(count);
}

/// Sets now_ to all boxes, enlarged, and candidates_ to their pairs.
template <int D, typename Real>
void CandidateList<D, Real>::find_all(const Change<D, Real>& change, const core::Margins<D, Real>& margins,
                                      FollowOrFind<D, Real>& pairs) {
  const std::size_t size = change.now.size();
  margins_ = StaggeredMargins<D, Real>(margins);
  is_sorted_ = false;
  is_followed_ = false;
  followed_ = 0;
  takes_shares_ = false;
  now_.resize(size);
  margins_.enlarge_all(change.now, now_);
  pairs.lend_memory(candidates_);
  CandidateCollector<D, Real> collector(candidates_, max_candidates_per_box * size, max_candidates_per_pair,
                                        change.now);
  found_ = pairs.find_within_limits(now_, change.filters_now, change.workers, collector);
  collector.flush();
  flags_.assign(size, 0);
}

/// Branchless: which candidates hold cannot be predicted.
template <int D, typename Real>
void CandidateList<D, Real>::select_holding(std::vector<Pair>& holding) const {
  holding.resize(holding_ + 1);
  std::size_t count = 0;
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    holding[count] = candidates_[i];
    count += holds_[i];
  }
  holding.resize(holding_);
}

template <int D, typename Real>
Statistics CandidateList<D, Real>::update(const Change<D, Real>& change, FollowOrFind<D, Real>& pairs,
                                          PairSink& begun, PairSink& ended) {
  left_.clear();
  last_ = {.boxes = change.now.size(), .changed = change.changed.size()};
  if (change.changed.empty()) return {};
  if (!is_sorted_) {
    sort_all();
    test_all(change.before, change.workers);
  }
  list_left(change);
  last_.left = left_.size();
  Statistics statistics;
  if (!left_.empty()) {
    if (!std::exchange(is_followed_, true)) {
      before_ = now_;  // enlarged as before this frame
      core::give_back(partly_);
      pairs.start_at(before_, candidates_.size(), found_, change.workers);
    }
    for (const BoxId id : left_) now_[index(id)] = margins().enlarged(change.now[index(id)], nullptr);
    statistics = find_candidates(change, pairs);
    change_candidates(ended);
    keep_left();
  } else if (takes_shares_ && !partly_.empty() && pairs.is_following()) {
    statistics = follow_share(change, pairs);
  }
  report(change, begun, ended);
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
    statistics = update_pairs(change, now_, pairs, limited, ended_candidates);
    limited.flush();
    begun_candidates.flush();
    ended_candidates.flush();
  }
  core::sort_unique(begun_, sorting_);
  core::sort_unique(ended_, sorting_);
  if (candidates_.size() + begun_.size() > max + ended_.size()) throw LimitPassed();
  return statistics.value_or(Statistics{});
}

/// Updates the pairs of enlarged boxes: those in left_ change from before_ to `now`.
template <int D, typename Real>
std::optional<Statistics> CandidateList<D, Real>::update_pairs(const Change<D, Real>& change,
                                                               std::span<const Box<D, Real>> now,
                                                               FollowOrFind<D, Real>& pairs, PairSink& begun,
                                                               PairSink& ended) {
  pairs.limit_pairs(max_candidates());
  return pairs.update({.before = before_,
                       .now = now,
                       .changed = left_,
                       .flags = flags_,
                       .filters_before = change.filters_before,
                       .filters_now = change.filters_now,
                       .workers = change.workers},
                      begun, ended);
}

/// Puts the next share of the enlarged boxes into the structure of the boxes themselves, in their stead.
/// Their pairs are candidates already.
template <int D, typename Real>
Statistics CandidateList<D, Real>::follow_share(const Change<D, Real>& change, FollowOrFind<D, Real>& pairs) {
  const std::size_t size = now_.size();
  const std::size_t end = std::min(size, followed_ + size / frames_to_follow + 1);
  partly_.resize(size, absent_box<D, Real>());
  for (; followed_ < end; ++followed_) {
    partly_[followed_] = now_[followed_];
    leave(followed_);
  }
  PairCounter none;
  const auto statistics = update_pairs(change, partly_, pairs, none, none);
  keep_left();
  is_followed_ = followed_ >= size;
  if (is_followed_) core::give_back(partly_);
  return statistics.value_or(Statistics{});
}

/// Makes the enlarged boxes in left_ those of the frame before.
template <int D, typename Real>
void CandidateList<D, Real>::keep_left() noexcept {
  for (const BoxId id : left_) {
    before_[index(id)] = now_[index(id)];
    flags_[index(id)] = 0;
  }
}

/// Sets left_ and flags_.
template <int D, typename Real>
void CandidateList<D, Real>::list_left(const Change<D, Real>& change) {
  const std::size_t size = change.now.size();
  before_.resize(size, absent_box<D, Real>());
  now_.resize(size, absent_box<D, Real>());
  flags_.resize(size);
  find_left(change);
  for (const BoxId id : left_) flags_[index(id)] = 1;
  // Elsewhere an absent box stays in its enlarged box. Here the array may have ended with the frame, and the
  // next frame would not know of these.
  for (std::size_t i = size; i > 0 && !is_present(change.now[i - 1]); --i) {
    if (is_present(now_[i - 1])) leave(i - 1);
  }
  margins_.note_left(left_.size(), size);
  review(change);
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
      const bool stays = is_within(now_[i], change.now[i]) &&
                         !(has_filters && change.filters_before[i] != change.filters_now[i]);
      left_[count] = id;
      count += static_cast<std::size_t>(!stays);
    }
  }
  left_.resize(count);
}

/// Adds to left_ the boxes of a share of all whose enlarged boxes are much too large for them, since the
/// boxes or the margins shrank.
template <int D, typename Real>
void CandidateList<D, Real>::review(const Change<D, Real>& change) {
  margins_.review(change.now.size(), [&](std::size_t i) {
    if (flags_[i] != 0 || !margins_.are_much_too_large(now_[i], change.now[i])) return;
    // A box that leaves before the structure has all would have it built anew, in one frame.
    if (partly_.empty())
      leave(i);
    else
      takes_shares_ = true;
  });
}

/// Lists a box in left_, once.
template <int D, typename Real>
void CandidateList<D, Real>::leave(std::size_t i) {
  if (std::exchange(flags_[i], std::uint8_t{1}) == 0) left_.push_back(BoxId(i));
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

template <int D, typename Real>
void CandidateList<D, Real>::sort_all() {
  core::sort_unique(candidates_, sorting_);
  core::give_back(sorting_);
  is_sorted_ = true;
}

/// Sets holds_ and holding_.
template <int D, typename Real>
void CandidateList<D, Real>::test_all(std::span<const Box<D, Real>> boxes, const Workers& workers) {
  holds_.resize(candidates_.size());
  parallel_.start(workers, candidates_.size() / pairs_per_box);
  parallel_.for_ranges(candidates_.size(), [&](core::Range range, std::size_t) {
    kernels::set_overlap_flags(boxes, std::span<const Pair>(candidates_).subspan(range.begin, range.size()),
                               holds_.data() + range.begin);
  });
  holding_ = static_cast<std::size_t>(std::count(holds_.begin(), holds_.end(), std::uint8_t{1}));
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

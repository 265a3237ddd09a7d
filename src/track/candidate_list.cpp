// MarginTracker.
#include "interface/margin_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>
#include <optional>
#include <span>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/grow.hpp"
#include "core/number_text.hpp"
#include "core/sort_pairs.hpp"
#include "interface/candidate_limit.hpp"
#include "interface/pair_difference.hpp"
#include "kernels/overlap_flags.hpp"

namespace broadside::core {
namespace {

// Thresholds: docs/lab-notes.md, "Enlarged boxes within trackers", has the measurements.

/// With fewer boxes, finding all pairs anew takes no longer than keeping candidates.
constexpr std::size_t least_boxes = 512;

/// Of all boxes, the part that must move before they are enlarged.
constexpr std::size_t many_movers = 8;

/// The part below which they are no longer enlarged. Hysteresis: leave a bit later than you enter, so that a
/// count near the limit does not flip each frame.
constexpr std::size_t too_few_movers = 16;

/// Candidates that are tested in the time that it takes to follow a mover without tests, and each of its
/// tests; and the frames in a row in which following would have taken less before boxes are no longer
/// enlarged.
constexpr double candidates_a_mover = 96;
constexpr double candidates_a_test = 1.5;
constexpr std::size_t most_calm_frames = 8;

/// The maximum number of candidates, per pair that holds and per box. If there would be more, boxes are no
/// longer enlarged.
constexpr std::size_t max_candidates_per_pair = 4;
constexpr std::size_t max_candidates_per_box = 16;

/// Of the changed boxes, the part that may leave their enlarged ones, and the frames over which it is
/// averaged: boxes that move alike leave in the same frame.
constexpr double most_left = 0.1;
constexpr double averaged_frames = 16;
constexpr std::size_t min_pause = 16;
constexpr std::size_t max_pause = 1024;
constexpr std::size_t max_pause_after_limit = 16 * max_pause;

}  // namespace

template <int D, typename Real>
void MarginTracker<D, Real>::update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  was_enlarged_ = boxes_ == Boxes::enlarged && !change.rebuild && follow_enlarged(change, begun, ended);
  if (was_enlarged_) return;
  update_exactly(change, begun, ended);
  if (change.rebuild || !suits_margins(change)) return;
  Statistics statistics = this->statistics().value_or(Statistics{});
  try {
    statistics.tests += start(change);
  } catch (const LimitPassed&) {
    // The tests made so far count. The other tracker has not changed.
    statistics.tests += candidates_.size() + tracker_->statistics().value_or(Statistics{}).tests;
    give_up(pause_after_limit());
  } catch (const std::bad_alloc&) {
    // The frame itself is whole.
    give_up(max_pause);
  } catch (...) {  // thrown by a checkpoint or an executor
    give_up(min_pause);
    throw;
  }
  this->count(statistics);
}

template <int D, typename Real>
void MarginTracker<D, Real>::update_exactly(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  Change<D, Real> exact = change;
  if (boxes_ != Boxes::exact) {
    exact.rebuild = true;
    release();
    tracker_->limit_pairs(AdaptiveTracker<D, Real>::no_limit);
    boxes_ = Boxes::exact;
  }
  this->update_with(*tracker_, exact, begun, ended);
}

/// Whether many boxes moved and hardly any moved far. If so, sets margins_.
template <int D, typename Real>
bool MarginTracker<D, Real>::suits_margins(const Change<D, Real>& change) {
  if (change.now.size() < least_boxes || change.changed.size() < change.now.size() / many_movers)
    return false;
  if (pause_ > 0) {
    --pause_;
    return false;
  }
  const std::optional<Margins<D, Real>> margins = margins_for(change);
  if (margins) margins_ = *margins;
  return margins.has_value();
}

/// Enlarges all boxes of a frame, whose events are already reported, and finds the candidates. Returns the
/// number of tests.
template <int D, typename Real>
std::uint64_t MarginTracker<D, Real>::start(const Change<D, Real>& change) {
  const std::size_t size = change.now.size();
  now_.resize(size);
  for (std::size_t i = 0; i < size; ++i) now_[i] = margins_.enlarged(change.now[i], nullptr);
  CandidateCollector<D, Real> collector(candidates_, {max_candidates_per_box * size, max_candidates_per_pair},
                                        change.now);
  tracker_->find_within_limits(now_, change.filters_now, collector);
  std::uint64_t tests = tracker_->statistics().value_or(Statistics{}).tests;
  sort_unique(candidates_, spare_);
  test_candidates(change.now);
  tests += candidates_.size();
  holding_ = static_cast<std::size_t>(std::ranges::count(holds_, std::uint8_t{1}));
  boxes_ = Boxes::ending;  // until everything is built
  tracker_->start_at(now_, candidates_.size());
  before_ = now_;
  flags_.assign(size, 0);
  boxes_ = Boxes::enlarged;
  left_share_ = 0;
  calm_frames_ = 0;
  lasted_ = 0;
  return tests;
}

/// The maximum number of candidates.
template <int D, typename Real>
std::size_t MarginTracker<D, Real>::max_candidates() const noexcept {
  return max_candidates_per_box * now_.size() + max_candidates_per_pair * holding_;
}

/// A try that ends at a limit costs about as much as one that succeeds. The pause makes that less than a
/// hundredth of the cost of the frames until the next try. It doubles with each failure in a row, because the
/// same boxes will most likely exceed the limit again.
template <int D, typename Real>
std::size_t MarginTracker<D, Real>::pause_after_limit() const noexcept {
  return std::clamp(2 * next_pause_, max_pause, max_pause_after_limit);
}

/// Returns false if there would be too many candidates. It has then reported no event of this frame, and the
/// enlarged boxes are gone.
template <int D, typename Real>
bool MarginTracker<D, Real>::follow_enlarged(const Change<D, Real>& change, PairSink& begun,
                                             PairSink& ended) {
  left_.clear();
  candidate_count_ = 0;
  changed_ = change.changed.size();
  this->count(Statistics{});
  if (change.changed.empty()) return true;
  enlarge_anew(change);
  Statistics statistics;
  if (!left_.empty()) {
    try {
      find_candidates(change);
    } catch (const LimitPassed&) {
      give_up(pause_after_limit());
      return false;
    }
    statistics = this->statistics().value_or(Statistics{});
    change_candidates(ended);
    for (const BoxId id : left_) {
      before_[index(id)] = now_[index(id)];
      flags_[index(id)] = 0;
    }
  }
  report(change, begun, ended);
  candidate_count_ = candidates_.size();
  statistics.tests += candidate_count_;
  this->count(statistics);
  judge();
  return true;
}

/// Sets begun_ and ended_ by updating the other tracker. Throws LimitPassed.
template <int D, typename Real>
void MarginTracker<D, Real>::find_candidates(const Change<D, Real>& change) {
  begun_.clear();
  ended_.clear();
  const std::size_t max = max_candidates();
  {
    PairCollector begun_candidates(begun_);
    PairCollector ended_candidates(ended_);
    // A tracker may write an event more than once.
    LimitSink limited(2 * max, begun_candidates);
    tracker_->limit_pairs(max);
    this->update_with(
        *tracker_, {before_, now_, left_, flags_, false, change.filters_before, change.filters_now, nullptr},
        limited, ended_candidates);
    limited.flush();
    begun_candidates.flush();
    ended_candidates.flush();
  }
  sort_unique(begun_, spare_);
  sort_unique(ended_, spare_);
  if (candidates_.size() + begun_.size() > max + ended_.size()) throw LimitPassed();
}

/// Sets left_ and flags_, and enlarges the boxes that are in left_.
template <int D, typename Real>
void MarginTracker<D, Real>::enlarge_anew(const Change<D, Real>& change) {
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

/// Takes out the candidates that ended, whose pairs ended if they held, and puts in those that began.
template <int D, typename Real>
void MarginTracker<D, Real>::change_candidates(PairSink& ended) {
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
void MarginTracker<D, Real>::test_candidates(std::span<const Box<D, Real>> boxes) {
  holds_.resize(candidates_.size());
  parallel_.start(this->workers(), candidates_.size() / pairs_a_box);
  parallel_.for_ranges(candidates_.size(), [&](Range range, std::size_t) {
    kernels::set_overlap_flags(
        boxes, std::span<const Pair>(candidates_).subspan(range.begin, range.end - range.begin),
        holds_.data() + range.begin);
  });
}

/// Tests the candidates, and reports those that hold now and did not, or the other way round.
template <int D, typename Real>
void MarginTracker<D, Real>::report(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  std::swap(held_, holds_);
  test_candidates(change.now);
  const auto compare = [&](std::size_t i) {
    if (holds_[i] == held_[i]) return;
    (holds_[i] != 0 ? begun : ended).add(candidates_[i].first, candidates_[i].second);
    holding_ += holds_[i];
    holding_ -= held_[i];
  };
  // Nearly all are as they were.
  constexpr std::size_t at_once = sizeof(std::uint64_t);
  std::size_t i = 0;
  for (; i + at_once <= candidates_.size(); i += at_once) {
    if (std::memcmp(&holds_[i], &held_[i], at_once) == 0) continue;
    for (std::size_t j = i; j < i + at_once; ++j) compare(j);
  }
  for (; i < candidates_.size(); ++i) compare(i);
}

/// Decides whether boxes stay enlarged, by how many changed and how many of them left.
template <int D, typename Real>
void MarginTracker<D, Real>::judge() {
  // Fewer candidates are allowed once pairs have ended.
  if (candidates_.size() > max_candidates()) return give_up(pause_after_limit());
  ++lasted_;
  const auto boxes = static_cast<double>(now_.size());
  const auto candidates = static_cast<double>(candidates_.size());
  // A mover has the candidates of which it is the first, and those of which it is the second.
  const double following =
      static_cast<double>(changed_) * (candidates_a_mover + candidates_a_test * 2 * candidates / boxes);
  const bool is_calm = following < candidates || changed_ < now_.size() / too_few_movers;
  calm_frames_ = is_calm ? calm_frames_ + 1 : 0;
  const double left = static_cast<double>(left_.size()) / static_cast<double>(changed_);
  left_share_ += (left - left_share_) / averaged_frames;
  if (left_share_ <= most_left && calm_frames_ < most_calm_frames) return;
  give_up(lasted_ > next_pause_ ? min_pause : std::min(2 * next_pause_, max_pause));
}

/// From the next frame on, the other tracker gets the boxes themselves.
template <int D, typename Real>
void MarginTracker<D, Real>::give_up(std::size_t pause) noexcept {
  if (boxes_ == Boxes::enlarged) boxes_ = Boxes::ending;
  pause_ = next_pause_ = pause;
  release();
}

/// Releases the memory for enlarged boxes.
template <int D, typename Real>
void MarginTracker<D, Real>::release() noexcept {
  give_back(before_, now_, flags_, candidates_, holds_, held_, begun_, ended_, spare_);
  if (boxes_ != Boxes::exact) tracker_->forget();
}

template <int D, typename Real>
std::string MarginTracker<D, Real>::explanation() const {
  if (!was_enlarged_) return tracker_->explanation();
  return std::to_string(candidate_count_) + " pairs of boxes enlarged by " +
         text_of(std::round(1000 * static_cast<double>(margins_.relative)) / 10) +
         " % of their shortest side were tested, since only " + std::to_string(left_.size()) + " of the " +
         std::to_string(changed_) + " boxes that changed left their enlarged ones";
}

template <int D, typename Real>
std::size_t MarginTracker<D, Real>::algorithm_bytes() const noexcept {
  return this->kept_bytes(*tracker_) + (before_.capacity() + now_.capacity()) * sizeof(Box<D, Real>) +
         left_.capacity() * sizeof(BoxId) + flags_.capacity() + holds_.capacity() + held_.capacity() +
         (candidates_.capacity() + begun_.capacity() + ended_.capacity() + spare_.capacity()) * sizeof(Pair);
}

template class MarginTracker<2, float>;
template class MarginTracker<3, float>;
template class MarginTracker<2, double>;
template class MarginTracker<3, double>;

}  // namespace broadside::core

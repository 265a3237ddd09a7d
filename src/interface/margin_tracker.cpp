// MarginTracker.
#include "interface/margin_tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/number_text.hpp"
#include "core/sample.hpp"
#include "core/sort_pairs.hpp"
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

/// The displacement in a frame, over their shortest side, up to which boxes are enlarged.
constexpr double largest_displacement = 0.0125;

/// A margin over that displacement: boxes stay within it for at least about so many frames. And its limits,
/// over a box's shortest side: a large one makes far more candidates than pairs.
constexpr double frames_within_margin = 48;
constexpr double smallest_margin = 0.01;
constexpr double largest_margin = 0.2;

/// How many displacements are sampled, and the quantile of them that counts.
constexpr std::size_t most_sampled = 64;
constexpr double quantile = 0.75;

/// More candidates than this, a pair that holds and a box, are not kept.
constexpr std::size_t most_candidates_a_pair = 4;
constexpr std::size_t most_candidates_a_box = 16;

/// Of the changed boxes, the part that may leave their enlarged ones, and the frames over which it is
/// averaged: boxes that move alike leave in the same frame.
constexpr double most_left = 0.1;
constexpr double averaged_frames = 16;
constexpr std::size_t shortest_pause = 16;
constexpr std::size_t longest_pause = 1024;

}  // namespace

template <int D, typename Real>
void MarginTracker<D, Real>::update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  was_enlarged_ = boxes_ == Boxes::enlarged && !change.rebuild;
  if (was_enlarged_) {
    follow_enlarged(change, begun, ended);
    return;
  }
  Change<D, Real> exact = change;
  exact.rebuild |= std::exchange(boxes_, Boxes::exact) != Boxes::exact;
  this->update_with(*tracker_, exact, begun, ended);
  if (change.rebuild || !suits_margins(change)) return;
  try {
    start(change);
  } catch (const std::bad_alloc&) {
    // The frame itself is whole.
    give_up(longest_pause);
  }
}

/// Whether many boxes moved and hardly any far; sets margins_ then. Margins are a part of a box's shortest
/// side: by a part of the longest, thin boxes would meet many more. And at most by what boxes move, so that
/// large ones at rest do not meet all small ones around them.
template <int D, typename Real>
bool MarginTracker<D, Real>::suits_margins(const Change<D, Real>& change) {
  const std::size_t count = change.changed.size();
  if (change.now.size() < least_boxes || count < change.now.size() / many_movers) return false;
  if (pause_ > 0) {
    --pause_;
    return false;
  }
  struct Displacement {
    Real relative;
    Real absolute;
  };
  std::array<Displacement, most_sampled> sampled;
  for (std::size_t i = 0; i < most_sampled; ++i) {
    const std::size_t place = index(change.changed[sampled_place(i, count)]);
    const Box<D, Real>& before = change.before[place];
    const Box<D, Real>& now = change.now[place];
    Real displacement = 0;
    Real side = std::numeric_limits<Real>::infinity();
    for (int axis = 0; axis < D; ++axis) {
      displacement = std::max({displacement, std::abs(now.min[axis] - before.min[axis]),
                               std::abs(now.max[axis] - before.max[axis])});
      side = std::min(side, now.max[axis] - now.min[axis]);
    }
    const Real over_side = displacement / side;
    // Not for absent boxes, nor for those without a side.
    sampled[i] = {over_side >= 0 ? over_side : std::numeric_limits<Real>::infinity(), displacement};
  }
  const auto at = sampled.begin() + static_cast<std::ptrdiff_t>(quantile * (most_sampled - 1));
  std::nth_element(sampled.begin(), at, sampled.end(),
                   [](const auto& a, const auto& b) { return a.absolute < b.absolute; });
  const Real absolute = at->absolute;
  std::nth_element(sampled.begin(), at, sampled.end(),
                   [](const auto& a, const auto& b) { return a.relative < b.relative; });
  // None where the boxes that are listed did not move.
  if (!(at->relative <= static_cast<Real>(largest_displacement)) || !(absolute > 0)) return false;
  const Real relative = std::clamp(static_cast<Real>(frames_within_margin) * at->relative,
                                   static_cast<Real>(smallest_margin), static_cast<Real>(largest_margin));
  margins_ = {.margin = absolute * (relative / at->relative),
              .relative = relative,
              .frames = 0,
              .is_of_shortest = true};
  return true;
}

/// Enlarges all boxes of a frame whose events are told, and finds the candidates.
template <int D, typename Real>
void MarginTracker<D, Real>::start(const Change<D, Real>& change) {
  Statistics statistics = this->statistics().value_or(Statistics{});
  boxes_ = Boxes::ending;  // until all is made
  const std::size_t size = change.now.size();
  before_.assign(size, absent_box<D, Real>());
  now_.resize(size);
  left_.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    now_[i] = margins_.enlarged(change.now[i], nullptr);
    left_[i] = BoxId(i);
  }
  flags_.assign(size, 1);
  candidates_.clear();
  {
    PairCollector all(candidates_);
    PairCounter none;
    this->update_with(*tracker_,
                      {before_, now_, left_, flags_, true, change.filters_now, change.filters_now, nullptr},
                      all, none);
    all.flush();
  }
  sort_unique(candidates_, spare_);
  test_candidates(change.now);
  statistics.tests += this->statistics().value_or(Statistics{}).tests + candidates_.size();
  this->count(statistics);
  const auto pairs = static_cast<std::size_t>(std::ranges::count(holds_, std::uint8_t{1}));
  if (candidates_.size() > most_candidates_a_pair * pairs + most_candidates_a_box * size)
    return give_up(longest_pause);
  before_ = now_;
  flags_.assign(size, 0);
  boxes_ = Boxes::enlarged;
  left_share_ = 0;
  calm_frames_ = 0;
  lasted_ = 0;
}

template <int D, typename Real>
void MarginTracker<D, Real>::follow_enlarged(const Change<D, Real>& change, PairSink& begun,
                                             PairSink& ended) {
  left_.clear();
  candidate_count_ = 0;
  changed_ = change.changed.size();
  this->count(Statistics{});
  if (change.changed.empty()) return;
  enlarge_anew(change);
  Statistics statistics;
  if (!left_.empty()) {
    begun_.clear();
    ended_.clear();
    PairCollector begun_candidates(begun_);
    PairCollector ended_candidates(ended_);
    this->update_with(
        *tracker_, {before_, now_, left_, flags_, false, change.filters_before, change.filters_now, nullptr},
        begun_candidates, ended_candidates);
    begun_candidates.flush();
    ended_candidates.flush();
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
  sort_unique(begun_, spare_);
  sort_unique(ended_, spare_);
  if (begun_.empty() && ended_.empty()) return;
  spare_.clear();
  held_.clear();
  auto next_begun = begun_.begin();
  auto next_ended = ended_.begin();
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Pair pair = candidates_[i];
    if (next_ended != ended_.end() && *next_ended == pair) {
      ++next_ended;
      if (holds_[i] != 0) ended.add(pair.first, pair.second);
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
    if (holds_[i] != held_[i])
      (holds_[i] != 0 ? begun : ended).add(candidates_[i].first, candidates_[i].second);
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
  give_up(lasted_ > next_pause_ ? shortest_pause : std::min(2 * next_pause_, longest_pause));
}

/// From the next frame on, the other tracker gets the boxes themselves.
template <int D, typename Real>
void MarginTracker<D, Real>::give_up(std::size_t pause) noexcept {
  boxes_ = Boxes::ending;
  pause_ = next_pause_ = pause;
  before_ = {};
  now_ = {};
  flags_ = {};
  candidates_ = {};
  holds_ = {};
  held_ = {};
  begun_ = {};
  ended_ = {};
  spare_ = {};
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

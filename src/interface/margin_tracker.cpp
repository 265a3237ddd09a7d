// MarginTracker.
#include "interface/margin_tracker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/number_text.hpp"
#include "core/sample.hpp"
#include "core/sort_pairs.hpp"
#include "kernels/overlap_flags.hpp"

namespace broadside::core {
namespace {

// Thresholds: docs/lab-notes.md, "Enlarged boxes in `auto`", has the measurements.

/// With fewer boxes, finding all pairs anew takes no longer than keeping candidates.
constexpr std::size_t least_boxes = 512;

/// Of all boxes, the part that must move before they are enlarged.
constexpr std::size_t many_movers = 8;

/// Candidates that are tested in the time that it takes to follow a mover without tests, and each of its
/// tests; and the frames in a row in which following would have taken less before boxes are no longer
/// enlarged.
constexpr double candidates_a_mover = 96;
constexpr double candidates_a_test = 1.5;
constexpr std::size_t most_calm_frames = 8;

/// How far most boxes may move in a frame, over their shortest side.
constexpr double longest_way = 0.0125;

/// A margin over the way of most boxes in a frame: they stay within it for at least about so many frames. And
/// its limits, over a box's shortest side: a large one makes far more candidates than pairs.
constexpr double frames_within_margin = 32;
constexpr double smallest_margin = 0.01;
constexpr double largest_margin = 0.2;

/// Boxes whose way is looked at, and which of them, in order, counts as that of most.
constexpr std::size_t most_sampled = 64;
constexpr double of_most = 0.75;

/// Of the changed boxes, the part that may leave their enlarged ones before the frame is a bad one, and the
/// bad frames after which boxes are no longer enlarged.
constexpr std::size_t many_left = 5;
constexpr std::size_t most_bad_frames = 3;
constexpr std::size_t shortest_pause = 16;
constexpr std::size_t longest_pause = 1024;

/// Candidates that take as long as one box of a search.
constexpr std::size_t pairs_a_box = 8;
constexpr std::size_t pairs_at_once = 4096;

}  // namespace

template <int D, typename Real>
void MarginTracker<D, Real>::update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  was_enlarged_ = is_enlarged_ && goes_on_ && !change.rebuild;
  if (was_enlarged_) {
    follow_enlarged(change, begun, ended);
    return;
  }
  Change<D, Real> exact = change;
  exact.rebuild |= std::exchange(is_enlarged_, false);
  this->update_with(*tracker_, exact, begun, ended);
  if (change.rebuild) return;
  if (const Real margin = relative_margin_for(change); margin > 0) start(change, margin);
}

/// The margin that suits how far boxes moved, over a box's shortest side; 0 where none does. Over the
/// longest, the margins of thin boxes would make far more candidates than pairs.
template <int D, typename Real>
Real MarginTracker<D, Real>::relative_margin_for(const Change<D, Real>& change) {
  const std::size_t count = change.changed.size();
  if (change.now.size() < least_boxes || count < change.now.size() / many_movers) return 0;
  if (pause_ > 0) {
    --pause_;
    return 0;
  }
  std::array<Real, most_sampled> ways;
  std::size_t size = 0;
  for (std::size_t i = 0; i < most_sampled; ++i) {
    const std::size_t place = index(change.changed[sampled_place(i, count)]);
    const Box<D, Real>& before = change.before[place];
    const Box<D, Real>& now = change.now[place];
    Real way = 0;
    Real side = std::numeric_limits<Real>::infinity();
    for (int axis = 0; axis < D; ++axis) {
      way = std::max(
          {way, std::abs(now.min[axis] - before.min[axis]), std::abs(now.max[axis] - before.max[axis])});
      side = std::min(side, now.max[axis] - now.min[axis]);
    }
    // Not for absent boxes, nor for unbounded ones.
    const Real relative = way / side;
    ways[size++] = relative >= 0 ? relative : std::numeric_limits<Real>::infinity();
  }
  const auto most = ways.begin() + static_cast<std::ptrdiff_t>(of_most * (most_sampled - 1));
  std::nth_element(ways.begin(), most, ways.end());
  if (!(*most <= static_cast<Real>(longest_way))) return 0;
  return std::clamp(static_cast<Real>(frames_within_margin) * *most, static_cast<Real>(smallest_margin),
                    static_cast<Real>(largest_margin));
}

/// Enlarges all boxes of a frame whose events are told, and finds the candidates.
template <int D, typename Real>
void MarginTracker<D, Real>::start(const Change<D, Real>& change, Real relative_margin) {
  const std::optional<Statistics> statistics = this->statistics();
  margins_ = {.margin = 0, .relative = relative_margin, .frames = 0, .is_of_shortest = true};
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
  holds_.resize(candidates_.size());
  kernels::set_overlap_flags(change.now, std::span<const Pair>(candidates_), holds_.data());
  before_ = now_;
  flags_.assign(size, 0);
  this->count(statistics);
  is_enlarged_ = true;
  goes_on_ = true;
  bad_frames_ = 0;
  calm_frames_ = 0;
  lasted_ = 0;
}

template <int D, typename Real>
void MarginTracker<D, Real>::follow_enlarged(const Change<D, Real>& change, PairSink& begun,
                                             PairSink& ended) {
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
  judge(change.changed.size());
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

/// Tests the candidates, and reports those that hold now and did not, or the other way round.
template <int D, typename Real>
void MarginTracker<D, Real>::report(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  std::swap(held_, holds_);
  holds_.resize(candidates_.size());
  parallel_.start(this->workers(), candidates_.size() / pairs_a_box);
  parallel_.for_ranges(candidates_.size(), [&](Range range, std::size_t) {
    kernels::set_overlap_flags(
        change.now, std::span<const Pair>(candidates_).subspan(range.begin, range.end - range.begin),
        holds_.data() + range.begin);
  });
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
void MarginTracker<D, Real>::judge(std::size_t changed) {
  ++lasted_;
  const auto candidates = static_cast<double>(candidates_.size());
  // A mover has the candidates of two boxes: its own, and those of which it is the second.
  const double tests = 2 * candidates / static_cast<double>(now_.size());
  const bool is_calm =
      static_cast<double>(changed) * (candidates_a_mover + candidates_a_test * tests) < candidates;
  calm_frames_ = is_calm ? calm_frames_ + 1 : 0;
  if (left_.size() > changed / many_left && left_.size() > least_boxes / many_left)
    ++bad_frames_;
  else if (bad_frames_ > 0)
    --bad_frames_;
  if (bad_frames_ < most_bad_frames && calm_frames_ < most_calm_frames) return;
  next_pause_ = lasted_ > next_pause_ ? shortest_pause : std::min(2 * next_pause_, longest_pause);
  pause_ = next_pause_;
  stop();
}

/// The other tracker gets the boxes themselves from the next frame on.
template <int D, typename Real>
void MarginTracker<D, Real>::stop() noexcept {
  goes_on_ = false;
  before_ = {};
  now_ = {};
  flags_ = {};
  candidates_ = {};
  holds_ = {};
  held_ = {};
  spare_ = {};
}

template <int D, typename Real>
std::string MarginTracker<D, Real>::explanation() const {
  if (!was_enlarged_) return tracker_->explanation();
  return std::to_string(candidate_count_) + " pairs of boxes enlarged by " +
         text_of(std::round(1000 * static_cast<double>(margins_.relative)) / 10) +
         " % of their shortest side were tested, since most boxes move by little and " +
         std::to_string(left_.size()) + " left their enlarged ones";
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

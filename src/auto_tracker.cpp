// The tracker of auto.
//
// When few boxes move it pays to move them in a structure that stays; when many do, to find all pairs anew,
// as B. Sowell et al. found for spatial joins ("An experimental analysis of iterated spatial joins in main
// memory", VLDB 2013). What ended in a frame that finds all pairs anew is seen from the pairs of the frame
// before. Nobody keeps these while boxes are followed: that would cost as much again in some frames as it
// saves in one, the first that finds all anew, which finds those of the frame before as well.
#include "auto_tracker.hpp"

#include <algorithm>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/pair_difference.hpp"

namespace broadside::own {
namespace {

/// What things cost, in nanoseconds of the machine on which they were measured; only their ratios matter.
template <int D>
constexpr double cost_of_filing = D == 2 ? 15 : 18;  // a box, when the follower starts
template <int D>
constexpr double cost_of_moving = D == 2 ? 110 : 140;  // a box that moved, but for the tests
constexpr double cost_of_a_test_of_a_mover = 1.8;
template <int D>
constexpr double cost_of_finding = D == 2 ? 40 : 65;  // a box, but for its pairs
constexpr double cost_of_a_pair = 7;
constexpr double cost_of_a_candidate = 15;  // a pair that boxes of doubles have to decide

/// Below so many boxes that moved nobody needs to think.
constexpr std::size_t few = 8;

/// Up to so many boxes comparing each that changed with all others costs less than keeping cells, or at most
/// so many where it was done in the frame before.
constexpr std::size_t few_boxes = 320;
constexpr std::size_t most_few_boxes = 400;

}  // namespace

template <int D, typename Real>
AutoTracker<D, Real>::AutoTracker(std::unique_ptr<PairFinder<D, Real>> finder,
                                  std::unique_ptr<PairTracker<D, Real>> follower,
                                  std::unique_ptr<PairTracker<D, Real>> for_few, Suits suits, Way way)
    : finder_(std::move(finder)),
      follower_(std::move(follower)),
      for_few_(std::move(for_few)),
      suits_(suits),
      way_(way),
      cost_of_mover_(cost_of_moving<D>),
      cost_of_box_(cost_of_finding<D>) {}

template <int D, typename Real>
void AutoTracker<D, Real>::update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  changed_ = change.changed.size();
  const bool has_few = std::exchange(were_few_, are_few(change.now.size()));
  if (were_few_) {
    Change<D, Real> seen = change;
    seen.rebuild |= !has_few;
    this->update_with(*for_few_, seen, begun, ended);
    followed_ = false;
    has_pairs_ = false;
    saved_ = 0;
    return;
  }
  was_incremental_ = is_incremental(change);
  if (was_incremental_) {
    follow(change, begun, ended);
  } else {
    rebuild(change, begun, ended);
    // After a first frame come others, most often with few changes: what follows them is made ready with it,
    // so that the second frame does not take longer than those after it.
    if (change.rebuild && way_ == Way::automatic && suits_(change.now)) start_following(change.now);
  }
}

template <int D, typename Real>
void AutoTracker<D, Real>::start_following(std::span<const Box<D, Real>> boxes) {
  // Nothing has changed, so that nobody asks for the flag of a box.
  const Change<D, Real> nothing{.before = boxes, .now = boxes, .changed = {}, .flags = {}, .rebuild = true};
  PairCounter none;
  const std::optional<Statistics> statistics = this->statistics();
  this->update_with(*follower_, nothing, none, none);
  this->count(statistics);
  followed_ = true;
}

/// Who has them keeps some more: boxes may come and go by turns.
template <int D, typename Real>
bool AutoTracker<D, Real>::are_few(std::size_t boxes) const {
  return for_few_ && way_ == Way::automatic && boxes <= (were_few_ ? most_few_boxes : few_boxes);
}

template <int D, typename Real>
bool AutoTracker<D, Real>::is_incremental(const Change<D, Real>& change) {
  const auto boxes = static_cast<double>(change.now.size());
  const auto movers = static_cast<double>(change.changed.size());
  break_even_ = static_cast<std::size_t>(boxes * cost_of_box_ / cost_of_mover_);
  if (way_ != Way::automatic) return way_ == Way::incremental;
  // Of the first frame all boxes are new, and after a failed one nothing is known.
  if (change.rebuild) return false;
  if (change.changed.size() <= few && followed_) return true;
  const double saving = boxes * cost_of_box_ - movers * cost_of_mover_;
  if (saving <= 0) return false;
  if (followed_) return true;
  // To start following costs something as well. It is done at once where the frame is no dearer for it, and
  // else as soon as it would have paid: so nobody loses much who moves few boxes and many by turns.
  saved_ += saving;
  if (saved_ < boxes * cost_of_filing<D>) return false;
  saved_ = 0;
  return suits_(change.now);
}

template <int D, typename Real>
void AutoTracker<D, Real>::rebuild(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  const auto find = [this](std::span<const Box<D, Real>> boxes, std::vector<Pair>& pairs) {
    pairs.clear();
    PairCollector collector(pairs);
    finder_->find(boxes, collector);
  };
  if (change.rebuild || !has_pairs_) find(change.before, pairs_);
  find(change.now, found_);
  core::report_differences<D, Real>(change, found_, pairs_, begun, ended);
  std::swap(pairs_, found_);
  has_pairs_ = true;
  followed_ = false;
  this->count(finder_->statistics());
  const double pairs = static_cast<double>(pairs_.size()) / std::max<double>(1, change.now.size());
  cost_of_box_ = cost_of_finding<D> + cost_of_a_pair * pairs;
}

template <int D, typename Real>
void AutoTracker<D, Real>::follow(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  Change<D, Real> followed = change;
  followed.rebuild = !followed_ || change.rebuild;
  this->update_with(*follower_, followed, begun, ended);
  followed_ = true;
  has_pairs_ = false;
  saved_ = 0;
  // Few movers tell little about what one costs.
  constexpr std::size_t telling = 64;
  if (changed_ < telling || !this->statistics()) return;
  const double tests = static_cast<double>(this->statistics()->tests) / static_cast<double>(changed_);
  const double hits = static_cast<double>(this->statistics()->hits) / static_cast<double>(changed_);
  cost_of_mover_ = cost_of_moving<D> + cost_of_a_test_of_a_mover * tests + cost_of_a_candidate * hits;
}

template <int D, typename Real>
std::string AutoTracker<D, Real>::explanation() const {
  if (were_few_) return "brute_force, since so few boxes need no cells; " + for_few_->explanation();
  const std::string changed = std::to_string(changed_) + (changed_ == 1 ? " box changed" : " boxes changed");
  if (was_incremental_) {
    const std::string why = way_ == Way::incremental
                                ? std::string(", as asked for")
                                : ", and up to " + std::to_string(std::max(break_even_, few)) +
                                      " that costs less than finding all pairs anew";
    return "followed by hierarchical_grid, since " + changed + why;
  }
  std::string found = "all pairs found anew by " + finder_->explanation();
  if (way_ == Way::rebuild) return found;
  return found + "; " + changed + ", and it pays to follow boxes up to " + std::to_string(break_even_);
}

template <int D, typename Real>
std::size_t AutoTracker<D, Real>::algorithm_bytes() const noexcept {
  const std::size_t for_few = for_few_ ? this->kept_bytes(*for_few_) : 0;
  return for_few + this->kept_bytes(*follower_) + (pairs_.capacity() + found_.capacity()) * sizeof(Pair);
}

template class AutoTracker<2, float>;
template class AutoTracker<3, float>;
template class AutoTracker<2, double>;
template class AutoTracker<3, double>;

}  // namespace broadside::own

// The tracker of auto.
//
// When few boxes move it pays to move them in a structure that stays; when many do, to find all pairs anew,
// as B. Sowell et al. found for spatial joins ("An experimental analysis of iterated spatial joins in main
// memory", VLDB 2013). What ended in a frame that finds all pairs anew is seen from the pairs of the frame
// before, so these are kept in the other frames as well: what begins is added, and what has ended is dropped
// by and by, some pairs a frame, so that no frame pays for others.
#include "auto_tracker.hpp"

#include <algorithm>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/pair_difference.hpp"
#include "core/sort_pairs.hpp"

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

/// Below so many boxes that moved nobody needs to think.
constexpr std::size_t few = 8;

}  // namespace

template <int D>
AutoTracker<D>::AutoTracker(std::unique_ptr<PairFinder<D>> finder, std::unique_ptr<PairTracker<D>> follower,
                            Way way)
    : finder_(std::move(finder)),
      follower_(std::move(follower)),
      way_(way),
      cost_of_mover_(cost_of_moving<D>),
      cost_of_box_(cost_of_finding<D>) {}

template <int D>
void AutoTracker<D>::update_valid(const Change<D>& change, PairSink& begun, PairSink& ended) {
  changed_ = change.changed.size();
  was_incremental_ = is_incremental(change);
  if (was_incremental_) {
    follow(change, begun, ended);
  } else {
    rebuild(change, begun, ended);
  }
}

template <int D>
bool AutoTracker<D>::is_incremental(const Change<D>& change) {
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
  return saved_ >= boxes * cost_of_filing<D>;
}

template <int D>
void AutoTracker<D>::rebuild(const Change<D>& change, PairSink& begun, PairSink& ended) {
  const auto find = [this](std::span<const Box<D>> boxes, std::vector<Pair>& pairs) {
    pairs.clear();
    PairCollector collector(pairs);
    finder_->find(boxes, collector);
  };
  if (change.rebuild) find(change.before, pairs_);
  find(change.now, found_);
  core::report_differences<D, float>(change, found_, pairs_, begun, ended);
  std::swap(pairs_, found_);
  found_count_ = pairs_.size();
  looked_at_ = 0;
  followed_ = false;
  this->count(finder_->statistics());
  const double pairs = static_cast<double>(pairs_.size()) / std::max<double>(1, change.now.size());
  cost_of_box_ = cost_of_finding<D> + cost_of_a_pair * pairs;
}

template <int D>
void AutoTracker<D>::follow(const Change<D>& change, PairSink& begun, PairSink& ended) {
  begun_.clear();
  PairCollector new_pairs(begun_);
  Change<D> followed = change;
  followed.rebuild = !followed_ || change.rebuild;
  this->update_with(*follower_, followed, new_pairs, ended);
  new_pairs.flush();
  followed_ = true;
  saved_ = 0;
  begun.put(begun_);
  if (way_ == Way::automatic) {
    pairs_.insert(pairs_.end(), begun_.begin(), begun_.end());
    drop_ended(change, begun_.size());
  }
  // Few movers tell little about what one costs.
  constexpr std::size_t telling = 64;
  if (changed_ < telling || !this->statistics()) return;
  const double tests = static_cast<double>(this->statistics()->tests) / static_cast<double>(changed_);
  cost_of_mover_ = cost_of_moving<D> + cost_of_a_test_of_a_mover * tests;
}

/// Looks at some of the pairs and drops those that hold no more: enough, in the long run, to keep up with
/// those that are added.
template <int D>
void AutoTracker<D>::drop_ended(const Change<D>& change, std::size_t added) {
  constexpr std::size_t spare = 256;
  if (pairs_.size() <= found_count_ + found_count_ / 8 + spare) return;
  const std::size_t looks = std::min(3 * added + spare, pairs_.size());
  for (std::size_t look = 0; look < looks && !pairs_.empty(); ++look) {
    if (looked_at_ >= pairs_.size()) looked_at_ = 0;
    const Pair pair = pairs_[looked_at_];
    if (change.holds(pair.first, pair.second)) {
      ++looked_at_;
    } else {
      pairs_[looked_at_] = pairs_.back();
      pairs_.pop_back();
    }
  }
  // Pairs that begin again and again may be there many times, and pairs may have become many more.
  if (pairs_.size() <= found_count_ + found_count_ / 2 + 4 * spare) return;
  std::erase_if(pairs_, [&](Pair pair) { return !change.holds(pair.first, pair.second); });
  core::sort_unique(pairs_, found_);
  found_count_ = pairs_.size();
}

template <int D>
std::string AutoTracker<D>::explanation() const {
  const std::string changed = std::to_string(changed_) + (changed_ == 1 ? " box changed" : " boxes changed");
  if (was_incremental_) {
    const std::string why = way_ == Way::incremental ? std::string(", as asked for")
                                                     : ", and up to " + std::to_string(break_even_) +
                                                           " that costs less than finding all pairs anew";
    return "followed by hierarchical_grid, since " + changed + why;
  }
  const std::string found = "all pairs found anew by " + finder_->explanation();
  if (way_ == Way::rebuild) return found;
  return found + "; " + changed + ", and it pays to follow boxes up to " + std::to_string(break_even_);
}

template <int D>
std::size_t AutoTracker<D>::algorithm_bytes() const noexcept {
  return this->kept_bytes(*follower_) +
         (pairs_.capacity() + found_.capacity() + begun_.capacity()) * sizeof(Pair);
}

template class AutoTracker<2>;
template class AutoTracker<3>;

}  // namespace broadside::own

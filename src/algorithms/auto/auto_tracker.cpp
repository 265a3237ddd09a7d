// The tracker of auto.
//
// When few boxes move it pays to move them in a structure that stays; when many do, to find all pairs anew,
// as B. Sowell et al. found for spatial joins ("An experimental analysis of iterated spatial joins in main
// memory", VLDB 2013). What ended in a frame that finds all pairs anew is seen from the pairs of the frame
// before. These are not kept while boxes are followed: that would cost as much again in some frames as it
// saves in one, the first that finds all anew, which finds those of the frame before as well.
#include "algorithms/auto/auto_tracker.hpp"

#include <algorithm>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/sample.hpp"
#include "interface/pair_difference.hpp"

namespace broadside::own {
namespace {

/// What things cost, in nanoseconds of the machine on which they were measured; only their ratios matter.
template <int D>
constexpr double cost_of_finding = D == 2 ? 40 : 65;  // a box, but for its pairs
constexpr double cost_of_a_pair = 7;
constexpr double cost_of_a_further_test = 0.5;      // beyond those that finding takes where boxes are even
constexpr double cost_of_a_further_reference = 30;  // and so for a box's entries
constexpr double usual_tests = 64;
constexpr double usual_references = 4;
constexpr double cost_of_a_candidate = 15;  // a pair that boxes of doubles have to decide

/// How much of the way back to what was thought at first a follower's cost goes in each frame that another
/// one follows: boxes may have changed their character.
constexpr double forgotten = 0.01;

/// Fewer movers tell little about what one costs.
constexpr std::size_t telling = 64;

/// Up to this number of movers the follower is taken without estimating costs.
constexpr std::size_t few = 8;

/// Up to so many boxes comparing each that changed with all others costs less than keeping cells, or at most
/// so many where it was done in the frame before.
constexpr std::size_t few_boxes = 320;
constexpr std::size_t most_few_boxes = 400;

}  // namespace

template <int D, typename Real>
AutoTracker<D, Real>::AutoTracker(std::unique_ptr<PairFinder<D, Real>> finder,
                                  std::span<const Follower<D, Real>> followers,
                                  std::unique_ptr<PairTracker<D, Real>> for_few, Way way)
    : finder_(std::move(finder)),
      followers_(followers),
      follower_(followers[0].make()),
      for_few_(std::move(for_few)),
      way_(way),
      cost_of_box_(cost_of_finding<D>) {
  for (const Follower<D, Real>& follower : followers) of_mover_.push_back(follower.mover);
}

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
    if (change.rebuild && way_ == Way::automatic) start_following(change.now);
  }
}

/// Starts the follower that costs least, by trying one after the other.
template <int D, typename Real>
void AutoTracker<D, Real>::start_following(std::span<const Box<D, Real>> boxes) {
  const std::optional<Statistics> statistics = this->statistics();
  try_out(boxes);
  std::vector<bool> was_tried(followers_.size());
  was_tried[current_] = true;
  while (cheapest() != current_) {
    use(cheapest());
    // The last one may be one that was tried, and turned out to be the best.
    try_out(boxes);
    if (was_tried[current_]) break;
    was_tried[current_] = true;
  }
  patience_ = 1;
  this->count(statistics);
  followed_ = true;
}

/// Starts the follower, and lets it follow some boxes that stay where they are: that tells what a mover
/// costs.
template <int D, typename Real>
void AutoTracker<D, Real>::try_out(std::span<const Box<D, Real>> boxes) {
  PairCounter none;
  // Nothing has changed, so the follower does not read the flags.
  Change<D, Real> change{.before = boxes, .now = boxes, .changed = {}, .flags = {}, .rebuild = true};
  this->update_with(*follower_, change, none, none);
  if (followers_.size() == 1) return;
  std::vector<std::uint8_t> flags(boxes.size());
  std::vector<BoxId> changed;
  for (std::size_t i = 0; i < std::min(telling, boxes.size()); ++i) {
    const std::size_t place = core::sampled_place(i, boxes.size());
    if (is_present(boxes[place]) && std::exchange(flags[place], 1) == 0) changed.push_back(BoxId(place));
  }
  change.changed = changed;
  change.flags = flags;
  change.rebuild = false;
  this->update_with(*follower_, change, none, none);
  if (this->statistics()) weigh(changed.size());
}

/// The limit is higher while boxes are few, so that boxes that come and go by turns do not change it.
template <int D, typename Real>
bool AutoTracker<D, Real>::are_few(std::size_t boxes) const {
  return for_few_ && way_ == Way::automatic && boxes <= (were_few_ ? most_few_boxes : few_boxes);
}

template <int D, typename Real>
bool AutoTracker<D, Real>::is_incremental(const Change<D, Real>& change) {
  const auto boxes = static_cast<double>(change.now.size());
  const auto movers = static_cast<double>(change.changed.size());
  const std::size_t best = cheapest();
  const double finding = boxes * cost_of_box_;
  break_even_ = static_cast<std::size_t>(finding / of_mover_[followed_ ? current_ : best]);
  if (way_ != Way::automatic) return way_ == Way::incremental;
  // Of the first frame all boxes are new, and after a failed one nothing is known.
  if (change.rebuild) return false;
  const bool is_best = followed_ && best == current_;
  if (change.changed.size() <= few && is_best) return true;
  const double now = followed_ ? std::min(finding, movers * of_mover_[current_]) : finding;
  const double saving = now - movers * of_mover_[best];
  if (is_best) return finding > movers * of_mover_[current_];
  const bool follows = followed_ && now < finding;
  if (saving <= 0) return follows;
  // To start following costs something as well. It is done at once where the frame is no dearer for it, and
  // else as soon as it would have paid: so little is lost where few boxes and many move by turns.
  saved_ += saving;
  const double patience = best == current_ ? 1 : patience_;
  if (saved_ < patience * boxes * followers_[best].start) return follows;
  saved_ = 0;
  if (best != current_) use(best);
  return true;
}

template <int D, typename Real>
std::size_t AutoTracker<D, Real>::cheapest() const {
  return static_cast<std::size_t>(std::ranges::min_element(of_mover_) - of_mover_.begin());
}

/// Gives up one follower for another, which has to start.
template <int D, typename Real>
void AutoTracker<D, Real>::use(std::size_t follower) {
  // One that has not started keeps no memory.
  follower_ = followers_[follower].make();
  followed_ = false;
  current_ = follower;
  patience_ *= 2;
  seen_movers_ = 0;
  seen_tests_ = 0;
  seen_hits_ = 0;
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
  const auto a_box = [&](auto count) {
    return static_cast<double>(count) / std::max<double>(1, change.now.size());
  };
  const double pairs = a_box(pairs_.size());
  cost_of_box_ = cost_of_finding<D> + cost_of_a_pair * pairs;
  if (!this->statistics()) return;
  const double tests = a_box(this->statistics()->tests);
  const double references = a_box(this->statistics()->references);
  cost_of_box_ += cost_of_a_further_test * std::max(0.0, tests - 2 * pairs - usual_tests) +
                  cost_of_a_further_reference * std::max(0.0, references - usual_references);
}

template <int D, typename Real>
void AutoTracker<D, Real>::follow(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  Change<D, Real> followed = change;
  followed.rebuild = !followed_ || change.rebuild;
  this->update_with(*follower_, followed, begun, ended);
  followed_ = true;
  has_pairs_ = false;
  if (cheapest() == current_) saved_ = 0;
  if (this->statistics()) weigh(changed_);
}

/// Takes what the follower did for this number of movers for what it costs.
template <int D, typename Real>
void AutoTracker<D, Real>::weigh(std::size_t number) {
  seen_movers_ += number;
  seen_tests_ += static_cast<double>(this->statistics()->tests);
  seen_hits_ += static_cast<double>(this->statistics()->hits);
  if (seen_movers_ < telling) return;
  const auto movers = static_cast<double>(std::exchange(seen_movers_, 0));
  const double tests = std::exchange(seen_tests_, 0) / movers;
  const double hits = std::exchange(seen_hits_, 0) / movers;
  for (std::size_t i = 0; i < followers_.size(); ++i)
    of_mover_[i] += forgotten * (followers_[i].mover - of_mover_[i]);
  const Follower<D, Real>& follower = followers_[current_];
  of_mover_[current_] = follower.mover_alone + follower.test * std::min(tests, usual_tests) +
                        follower.further_test * std::max(0.0, tests - usual_tests) +
                        cost_of_a_candidate * hits;
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
    return "followed by " + std::string(followers_[current_].name) + ", since " + changed + why;
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

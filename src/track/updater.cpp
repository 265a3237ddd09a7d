// AdaptiveTracker.
//
// When few boxes move it pays to move them in a structure that stays; when many do, to find all pairs anew,
// as B. Sowell et al. found for spatial joins ("An experimental analysis of iterated spatial joins in main
// memory", VLDB 2013). A frame that finds all pairs anew needs those of the frame before, to tell which
// ended. They are not kept up to date while boxes are followed, which would cost more than it saves: the
// first frame that finds all pairs anew finds those of the frame before as well.
#include "interface/adaptive_tracker.hpp"

#include <algorithm>
#include <optional>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/grow.hpp"
#include "core/lean.hpp"
#include "core/sample.hpp"
#include "interface/candidate_limit.hpp"
#include "interface/pair_difference.hpp"
#include "interface/yielding.hpp"

namespace broadside::core {
namespace {

/// Boxes that are followed at first to see what a mover costs.
constexpr std::size_t tried_movers = 64;

/// Up to this many boxes, comparing each mover with all others costs less than keeping cells. Hysteresis:
/// leave a bit later than you enter, so that a count near the limit does not flip it each frame.
constexpr std::size_t boxes_for_brute_force = 320;
constexpr std::size_t most_boxes_for_brute_force = 400;

template <int D, typename Real>
std::vector<FollowCosts> costs_of(const std::vector<Follower<D, Real>>& followers) {
  std::vector<FollowCosts> costs;
  for (const Follower<D, Real>& follower : followers) costs.push_back(follower.costs);
  return costs;
}

}  // namespace

template <int D, typename Real>
AdaptiveTracker<D, Real>::AdaptiveTracker(Update update, std::unique_ptr<PairFinder<D, Real>> finder,
                                          const FindCosts& finding, std::vector<Follower<D, Real>> followers,
                                          std::unique_ptr<PairTracker<D, Real>> for_few)
    : finder_(std::move(finder)),
      followers_(std::move(followers)),
      for_few_(std::move(for_few)),
      policy_(update, finding, costs_of(followers_)) {}

template <int D, typename Real>
void AdaptiveTracker<D, Real>::update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  changed_ = change.changed.size();
  const bool has_few = std::exchange(were_few_, are_few(change.now.size()));
  if (were_few_) {
    Change<D, Real> seen = change;
    seen.rebuild |= !has_few;
    policy_.lost();
    has_pairs_ = false;
    this->update_with(*for_few_, seen, begun, ended);
    return;
  }
  was_followed_ = policy_.follows(change.now.size(), changed_, change.rebuild);
  if (was_followed_) {
    follow(change, begun, ended);
  } else {
    rebuild(change, begun, ended);
    // After a first frame come others, most often with few changes: what follows them is made ready with it,
    // so that the second frame does not take longer than those after it.
    if (change.rebuild && policy_.update() == Update::automatic) start_following(change.now);
  }
}

/// The structure in use. One that has not started keeps no memory.
template <int D, typename Real>
PairTracker<D, Real>& AdaptiveTracker<D, Real>::follower() {
  if (!follower_ || follower_number_ != policy_.current()) {
    follower_ = followers_[policy_.current()].make();
    follower_number_ = policy_.current();
  }
  return *follower_;
}

/// Starts the structure that costs least, by trying one after the other.
template <int D, typename Real>
void AdaptiveTracker<D, Real>::start_following(std::span<const Box<D, Real>> boxes) {
  const std::optional<Statistics> statistics = this->statistics();
  std::vector<std::uint8_t> was_tried(followers_.size());
  do {
    // The last one may be one that was tried, and turned out to be the best.
    policy_.use(policy_.cheapest());
    try_out(boxes);
  } while (std::exchange(was_tried[policy_.current()], std::uint8_t{1}) == 0 &&
           policy_.cheapest() != policy_.current());
  policy_.settle();
  this->count(statistics);
}

/// Starts the structure without a few boxes, which it then takes in: that tells what a mover costs.
template <int D, typename Real>
void AdaptiveTracker<D, Real>::try_out(std::span<const Box<D, Real>> boxes) {
  std::vector<Box<D, Real>> before(boxes.begin(), boxes.end());
  std::vector<std::uint8_t> flags(boxes.size());
  std::vector<BoxId> changed;
  for (std::size_t i = 0; i < std::min(tried_movers, boxes.size()); ++i) {
    const std::size_t place = sampled_place(i, boxes.size());
    if (!is_present(boxes[place]) || std::exchange(flags[place], 1) != 0) continue;
    before[place] = absent_box<D, Real>();
    changed.push_back(BoxId(place));
  }
  PairCounter none;
  const std::vector<std::uint8_t> no_flags(boxes.size());
  this->update_with(follower(), {before, before, {}, no_flags, true}, none, none);
  policy_.followed(0, this->statistics());
  this->update_with(follower(), {before, boxes, changed, flags, false}, none, none);
  policy_.followed(changed.size(), this->statistics());
}

template <int D, typename Real>
bool AdaptiveTracker<D, Real>::are_few(std::size_t boxes) const {
  return for_few_ && policy_.update() == Update::automatic &&
         boxes <= (were_few_ ? most_boxes_for_brute_force : boxes_for_brute_force);
}

template <int D, typename Real>
void AdaptiveTracker<D, Real>::rebuild(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  const auto find_into = [this](std::vector<Pair>& pairs, std::span<const Box<D, Real>> boxes,
                                std::span<const Filter> filters) {
    pairs.clear();
    CandidateCollector<D, Real> collector(pairs, {most_pairs_});
    if (is_limited())
      find_within_limits(boxes, filters, collector);
    else
      finder_->find(boxes, collector);
  };
  if (change.rebuild || !has_pairs_) find_into(pairs_, change.before, change.filters_before);
  find_into(found_, change.now, change.filters_now);
  report_differences<D, Real>(change, found_, pairs_, this->workers(), parallel_, begun, ended);
  std::swap(pairs_, found_);
  has_pairs_ = true;
  this->count(finder_->statistics());
  policy_.found(change.now.size(), pairs_.size(), this->statistics());
}

/// The number of tests is limited only if the finder can give up. If an algorithm that chooses gives up,
/// another one continues.
template <int D, typename Real>
void AdaptiveTracker<D, Real>::find_within_limits(std::span<const Box<D, Real>> boxes,
                                                  std::span<const Filter> filters, PairSink& pairs) {
  this->count(std::nullopt);
  Yielding<D>* const yielding = finder_->yielding();
  if (yielding != nullptr) yielding->let_yield(true);
  const auto end = [&] {
    if (yielding != nullptr) yielding->let_yield(false);
    this->count(finder_->statistics());
  };
  try {
    finder_->find(boxes, pairs, {.filters = filters});
  } catch (...) {
    end();
    throw;
  }
  end();
  if (yielding != nullptr && yielding->has_yielded()) throw LimitPassed();
}

template <int D, typename Real>
void AdaptiveTracker<D, Real>::start_at(std::span<const Box<D, Real>> boxes, std::size_t pairs) {
  forget();
  were_few_ = false;
  policy_.found(boxes.size(), pairs, finder_->statistics());
  start_following(boxes);
}

template <int D, typename Real>
void AdaptiveTracker<D, Real>::forget() noexcept {
  give_back(pairs_, found_);
  has_pairs_ = false;
  follower_.reset();
  was_followed_ = false;
  policy_.lost();
}

template <int D, typename Real>
void AdaptiveTracker<D, Real>::follow(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  Change<D, Real> followed = change;
  followed.rebuild |= !policy_.is_following();
  this->update_with(follower(), followed, begun, ended);
  has_pairs_ = false;
  policy_.followed(changed_, this->statistics());
}

template <int D, typename Real>
std::string AdaptiveTracker<D, Real>::explanation() const {
  if constexpr (core::is_lean) return {};
  if (were_few_) return "brute_force, since so few boxes need no cells; " + for_few_->explanation();
  const std::string changed = std::to_string(changed_) + (changed_ == 1 ? " box changed" : " boxes changed");
  const std::string break_even = std::to_string(policy_.break_even());
  const bool is_asked_for = policy_.update() != Update::automatic;
  if (was_followed_) {
    return "followed by " + std::string(followers_[policy_.current()].name) + ", since " + changed +
           (is_asked_for ? ", as asked for"
                         : ", and up to " + break_even + " that costs less than finding all pairs anew");
  }
  const std::string by = finder_->explanation();
  std::string found = "all pairs found anew" + (by.empty() ? "" : " by " + by);
  if (is_asked_for) return found;
  return found + "; " + changed + ", and it pays to follow boxes up to " + break_even;
}

/// A follower that was only made ready for the next frame has seen no filters, so its index cannot be used
/// yet.
template <int D, typename Real>
const BoxIndex<D, Real>* AdaptiveTracker<D, Real>::algorithm_index() const noexcept {
  return were_few_ || !was_followed_ ? nullptr : this->index_of(*follower_);
}

template <int D, typename Real>
std::size_t AdaptiveTracker<D, Real>::algorithm_bytes() const noexcept {
  if constexpr (is_lean) return 0;
  std::size_t bytes = (pairs_.capacity() + found_.capacity()) * sizeof(Pair);
  if (for_few_) bytes += this->kept_bytes(*for_few_);
  if (follower_) bytes += this->kept_bytes(*follower_);
  return bytes;
}

template class AdaptiveTracker<2, float>;
template class AdaptiveTracker<3, float>;
template class AdaptiveTracker<2, double>;
template class AdaptiveTracker<3, double>;

}  // namespace broadside::core

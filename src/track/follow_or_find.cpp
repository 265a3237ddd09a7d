// FollowOrFind: follows or finds by its policy, starts structures, and explains the choice.
#include "track/follow_or_find.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <utility>

#include "broadside/sinks.hpp"

#include "core/sample.hpp"

namespace broadside::track {
namespace {

/// The number of boxes followed at first, to measure the cost of a mover.
constexpr std::size_t tried_movers = 64;

/// The number of boxes whose hash decides which ones.
constexpr std::size_t hashed_boxes = 1024;

template <int D>
std::vector<StructureCosts> costs_of(const std::vector<FollowerChoice<D>>& structures) {
  std::vector<StructureCosts> costs;
  for (const FollowerChoice<D>& structure : structures)
    costs.push_back({structure.costs, structure.max_boxes});
  return costs;
}

}  // namespace

template <int D, typename Real>
FollowOrFind<D, Real>::FollowOrFind(TrackerPlan<D> plan)
    : structures_(std::move(plan.structures)),
      settings_(std::move(plan.settings)),
      explains_(plan.explains),
      policy_(plan.update, plan.find_costs, costs_of(structures_), !std::is_same_v<Real, float>) {
  if (plan.follower) follower_ = followed(std::move(plan.follower));
  if (plan.searchers.first) find_anew_.emplace(std::move(plan.searchers));
}

template <int D, typename Real>
std::optional<Statistics> FollowOrFind<D, Real>::update(const Change<D, Real>& change, PairSink& begun,
                                                        PairSink& ended) {
  changed_ = change.changed.size();
  was_followed_ = policy_.follows(change.now.size(), changed_, change.rebuild);
  std::optional<Statistics> statistics;
  std::uint64_t tests_in_vain = 0;
  while (was_followed_) {
    const std::uint64_t max_tests = policy_.max_tests();
    statistics = follow(change, max_tests, begun, ended);
    if (!statistics || statistics->tests <= max_tests) break;
    const bool may_follow = tests_in_vain == 0;  // once, since each structure has to be built
    tests_in_vain += max_tests;                  // the statistics' tests may depend on the number of threads
    was_followed_ = policy_.passed_max_tests(changed_, may_follow);
  }
  if (was_followed_) {
    if (find_anew_) find_anew_->skip();
    policy_.followed(changed_, statistics);
  } else {
    statistics = find(change, begun, ended);
  }
  if (statistics) statistics->tests += tests_in_vain;
  return statistics;
}

template <int D, typename Real>
std::optional<Statistics> FollowOrFind<D, Real>::follow(const Change<D, Real>& change,
                                                        std::uint64_t max_tests, PairSink& begun,
                                                        PairSink& ended) {
  Change<D, Real> followed = change;
  followed.rebuild |= !policy_.is_following();
  followed.max_tests = max_tests;
  return follower().follow(followed, begun, ended);
}

template <int D, typename Real>
std::optional<Statistics> FollowOrFind<D, Real>::find(const Change<D, Real>& change, PairSink& begun,
                                                      PairSink& ended) {
  const std::optional<Statistics> statistics = find_anew_->update(change, max_pairs_, begun, ended);
  found(change, statistics);
  return statistics;
}

template <int D, typename Real>
void FollowOrFind<D, Real>::start_with(const Change<D, Real>& change, std::vector<Pair>&& pairs,
                                       const std::optional<Statistics>& statistics) {
  changed_ = change.changed.size();
  was_followed_ = policy_.follows(change.now.size(), changed_, true);
  find_anew_->take(std::move(pairs));
  found(change, statistics);
}

/// Notes that all pairs were found.
template <int D, typename Real>
void FollowOrFind<D, Real>::found(const Change<D, Real>& change,
                                  const std::optional<Statistics>& statistics) {
  policy_.found(change.now.size(), find_anew_->pair_count(), statistics);
  // Frames after the first usually have few changes. The structure that follows them is built now, so that
  // the second frame does not take longer than later ones.
  if (change.rebuild && policy_.update() == Update::automatic && !structures_.empty())
    start_following(change.now, change.workers);
}

/// The structure in use; makes it if it does not exist yet.
template <int D, typename Real>
auto FollowOrFind<D, Real>::follower() -> Followed& {
  if (!follower_ || follower_number_ != policy_.current()) {
    follower_ = followed(structures_[policy_.current()].make(*settings_));
    follower_number_ = policy_.current();
  }
  return *follower_;
}

template <int D, typename Real>
auto FollowOrFind<D, Real>::followed(std::unique_ptr<Follower<D>> follower) -> std::unique_ptr<Followed> {
  if (!follower) throw std::invalid_argument("Tracker was given a null follower; expected a follower");
  if constexpr (std::is_same_v<Real, float>)
    return follower;
  else
    return std::make_unique<DoubleFollower<D>>(std::move(follower));
}

/// Tries structures, the cheapest first by what is known, and starts the cheapest.
template <int D, typename Real>
void FollowOrFind<D, Real>::start_following(std::span<const Box<D, Real>> boxes, const Workers& workers) {
  std::vector<std::uint8_t> was_tried(structures_.size());
  do {
    // The last structure may have been tried before, and turned out to be the cheapest.
    policy_.use(policy_.cheapest());
    try_out(boxes, workers);
  } while (std::exchange(was_tried[policy_.current()], std::uint8_t{1}) == 0 &&
           policy_.cheapest() != policy_.current());
  policy_.settle();
}

/// Starts the structure without a few boxes and then adds these, to measure the cost of a mover.
template <int D, typename Real>
void FollowOrFind<D, Real>::try_out(std::span<const Box<D, Real>> boxes, const Workers& workers) {
  std::vector<Box<D, Real>> before(boxes.begin(), boxes.end());
  std::vector<std::uint8_t> flags(boxes.size());
  std::vector<BoxId> changed;
  const std::uint32_t shift = core::sample_shift(boxes, hashed_boxes);
  for (std::size_t i = 0; i < std::min(tried_movers, boxes.size()); ++i) {
    const std::size_t place = core::sampled_place(i + shift, boxes.size());
    if (!is_present(boxes[place]) || std::exchange(flags[place], 1) != 0) continue;
    before[place] = absent_box<D, Real>();
    changed.push_back(BoxId(place));
  }
  PairCounter none;
  const std::vector<std::uint8_t> no_flags(boxes.size());
  const Change<D, Real> start{
      .before = before, .now = before, .changed = {}, .flags = no_flags, .rebuild = true, .workers = workers};
  policy_.followed(0, follower().follow(start, none, none));
  const Change<D, Real> taken{
      .before = before, .now = boxes, .changed = changed, .flags = flags, .workers = workers};
  policy_.followed(changed.size(), follower().follow(taken, none, none));
}

template <int D, typename Real>
std::string FollowOrFind<D, Real>::explanation() const {
  if (!explains_) return find_anew_ ? find_anew_->explanation() : std::string();
  std::string text;
  if (policy_.are_few())
    text = structures_[policy_.current()].name + ", because so few boxes need no structure; ";
  const std::string changed = std::to_string(changed_) + (changed_ == 1 ? " box changed" : " boxes changed");
  const std::string break_even = std::to_string(policy_.break_even());
  const bool is_asked_for = policy_.update() != Update::automatic;
  if (was_followed_) {
    return text + "followed by " + structures_[policy_.current()].name + ", since " + changed +
           (is_asked_for ? ", as asked for"
                         : "; up to " + break_even + ", following costs less than finding all pairs anew");
  }
  const std::string by = find_anew_ ? find_anew_->explanation() : std::string();
  text += "all pairs found anew" + (by.empty() ? "" : " by " + by);
  if (is_asked_for) return text;
  return text + "; " + changed + ", and following them would pay for at most " + break_even;
}

template class FollowOrFind<2, float>;
template class FollowOrFind<3, float>;
template class FollowOrFind<2, double>;
template class FollowOrFind<3, double>;

}  // namespace broadside::track

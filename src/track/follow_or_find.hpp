// FollowOrFind: follows changes in a persistent structure or finds all pairs anew, whichever costs less.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "broadside/algorithm.hpp"
#include "broadside/follower.hpp"

#include "track/double_follower.hpp"
#include "track/find_anew.hpp"
#include "track/update_policy.hpp"

namespace broadside::track {

/// The means by which a tracker updates its pairs.
template <int D>
struct TrackerPlan {
  Update update = Update::automatic;
  std::vector<FollowerChoice<D>> structures{};  ///< may be empty
  std::optional<Settings> settings{};           ///< for making structures
  std::unique_ptr<Follower<D>> follower{};      ///< of the first structure, if already made
  find::Searchers<D> searchers{};               ///< may be empty if `update` is `follow`
  FindCosts find_costs{};
  bool explains = true;  ///< whether there is more than one way
};

/// Three of a tracker's ways: a structure that compares all boxes, a structure that follows them, and finding
/// all pairs anew.
///
/// If few boxes move, it pays to move them in a persistent structure; if many do, to find all pairs anew, as
/// B. Sowell et al. found for spatial joins ("An experimental analysis of iterated spatial joins in main
/// memory", VLDB 2013). One structure is kept at a time; if there are several, another takes over when the
/// first makes many tests.
template <int D, typename Real>
class FollowOrFind {
 public:
  explicit FollowOrFind(TrackerPlan<D> plan);

  /// Writes the events of a change. One may be written more than once.
  std::optional<Statistics> update(const Change<D, Real>& change, PairSink& begun, PairSink& ended);

  /// Finds all pairs that the filters accept. Throws LimitPassed if that takes far more tests than the
  /// numbers of boxes and pairs justify, and throws what the sink throws.
  std::optional<Statistics> find_within_limits(std::span<const Box<D, Real>> boxes,
                                               std::span<const Filter> filters, const Workers& workers,
                                               PairSink& pairs) {
    return find_anew_->find_within_limits(boxes, filters, workers, pairs);
  }

  /// Whether the last update found all pairs anew, so that report() can be called.
  bool knows_pairs() const noexcept { return find_anew_ && find_anew_->knows_pairs(); }

  /// As FindAnew::report().
  void report(const Change<D, Real>& change, std::span<const Pair> found, PairSink& begun, PairSink& ended) {
    changed_ = change.changed.size();
    find_anew_->report(change, found, begun, ended);
  }

  /// As update() in a first frame, with pairs that were found in another way.
  void start_with(const Change<D, Real>& change, std::vector<Pair>&& pairs,
                  const std::optional<Statistics>& statistics);

  /// As FindAnew::lend_memory().
  void lend_memory(std::vector<Pair>& pairs) noexcept { find_anew_->lend_memory(pairs); }

  /// Prepares to follow these boxes from the next update on. Call it after find_within_limits(), with the
  /// number of pairs that it found and its statistics.
  void start_at(std::span<const Box<D, Real>> boxes, std::size_t pairs,
                const std::optional<Statistics>& statistics, const Workers& workers) {
    forget();
    policy_.found(boxes.size(), pairs, statistics);
    start_following(boxes, workers);
  }

  /// From now on, an update that finds all pairs anew keeps at most `max` pairs. If it finds more, or makes
  /// too many tests (see above), it throws LimitPassed, and the next update must be a rebuild.
  void limit_pairs(std::size_t max) noexcept { max_pairs_ = max; }

  /// Releases the memory for the pairs of the last frame, and keeps that of the structure for the next one,
  /// whose pages are in use already. The next update must be a rebuild.
  void forget() noexcept {
    forget_pairs();
    policy_.lost();
  }

  /// Releases the memory for the pairs of the last frame. The structure still follows.
  void forget_pairs() noexcept {
    if (find_anew_) find_anew_->forget();
    was_followed_ = false;
  }

  /// Whether a structure has the boxes of the last frame.
  bool is_following() const noexcept { return policy_.is_following(); }

  /// Whether the structure in use compares all boxes, and whether the last update did so.
  bool compares_all() const noexcept { return structures_[policy_.current()].max_boxes > 0; }
  bool has_compared_all() const noexcept { return was_followed_ && compares_all(); }

  std::string explanation() const;

  /// The index of the structure that followed the last frame. A structure that was only prepared for the next
  /// frame has seen no filters, so its index cannot be used yet.
  const BoxIndex<D, Real>* box_index() const noexcept {
    if constexpr (std::is_same_v<Real, float>)
      return was_followed_ && follower_ ? follower_->box_index() : nullptr;
    else
      return nullptr;
  }

  std::size_t bytes() const noexcept {
    return (find_anew_ ? find_anew_->bytes() : 0) + (follower_ ? follower_->bytes() : 0);
  }

 private:
  using Followed = std::conditional_t<std::is_same_v<Real, float>, Follower<D>, DoubleFollower<D>>;

  std::optional<Statistics> follow(const Change<D, Real>& change, std::uint64_t max_tests, PairSink& begun,
                                   PairSink& ended);
  std::optional<Statistics> find(const Change<D, Real>& change, PairSink& begun, PairSink& ended);
  void found(const Change<D, Real>& change, const std::optional<Statistics>& statistics);
  void start_following(std::span<const Box<D, Real>> boxes, const Workers& workers);
  void try_out(std::span<const Box<D, Real>> boxes, const Workers& workers);
  Followed& follower();
  static std::unique_ptr<Followed> followed(std::unique_ptr<Follower<D>> follower);

  std::vector<FollowerChoice<D>> structures_;
  std::optional<Settings> settings_;
  bool explains_;
  FollowPolicy policy_;
  std::unique_ptr<Followed> follower_;  // null until one is needed
  std::size_t follower_number_ = 0;
  std::optional<FindAnew<D, Real>> find_anew_;  // empty if all frames are followed
  std::size_t max_pairs_ = no_limit;
  std::size_t changed_ = 0;    // of the last update
  bool was_followed_ = false;  // whether the last frame was followed
};

}  // namespace broadside::track

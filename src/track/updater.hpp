// AdaptiveTracker: follows what changed in a structure that stays, or finds all pairs anew, whichever costs
// less in this frame.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

#include "core/lean.hpp"
#include "core/parallel.hpp"
#include "interface/follow_policy.hpp"

namespace broadside::core {

/// A structure that follows boxes: a tracker that does nothing else.
template <int D, typename Real>
struct Follower {
  std::string_view name;
  std::function<std::unique_ptr<PairTracker<D, Real>>()> make;
  FollowCosts costs;
};

/// One structure is kept at a time; where there are several, another takes over when the first makes many
/// tests.
template <int D, typename Real = float>
class AdaptiveTracker final : public PairTracker<D, Real> {
 public:
  /// `finder` finds all pairs anew; `followers`, at least one, are the structures to choose from; `for_few`,
  /// if not null, does everything where boxes are few.
  AdaptiveTracker(Update update, std::unique_ptr<PairFinder<D, Real>> finder, const FindCosts& finding,
                  std::vector<Follower<D, Real>> followers,
                  std::unique_ptr<PairTracker<D, Real>> for_few = nullptr);

  std::string explanation() const override;

  /// Finds all pairs that the filters accept, and changes only the statistics. Throws LimitPassed if that
  /// takes far more tests than the numbers of boxes and pairs justify, and throws what the sink throws.
  void find_within_limits(std::span<const Box<D, Real>> boxes, std::span<const Filter> filters,
                          PairSink& pairs);

  /// To be called after find_within_limits(), with the number of pairs it found: prepares to follow these
  /// boxes from the next update on.
  void start_at(std::span<const Box<D, Real>> boxes, std::size_t pairs);

  /// From now on, an update that finds all pairs anew keeps at most `most` pairs, and none that the filters
  /// refuse. If it finds more, or makes too many tests (see above), it throws LimitPassed, and the next
  /// update must be a rebuild.
  void limit_pairs(std::size_t most) noexcept { most_pairs_ = most; }
  static constexpr std::size_t no_limit = std::numeric_limits<std::size_t>::max();

  /// Releases the memory for the last frame. The next update must be a rebuild.
  void forget() noexcept;

  /// Where it does nothing but follow.
  core::CandidateTracker<D>* candidate_tracker() override {
    return policy_.update() == Update::follow ? follower().candidate_tracker() : nullptr;
  }

 private:
  void update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) override;
  void workers_changed() override {
    if constexpr (!is_lean) finder_->set_workers(this->workers());
  }
  std::size_t algorithm_bytes() const noexcept override;
  const BoxIndex<D, Real>* algorithm_index() const noexcept override;

  bool is_limited() const noexcept { return !is_lean && most_pairs_ != no_limit; }
  bool are_few(std::size_t boxes) const;
  void rebuild(const Change<D, Real>& change, PairSink& begun, PairSink& ended);
  void follow(const Change<D, Real>& change, PairSink& begun, PairSink& ended);
  void start_following(std::span<const Box<D, Real>> boxes);
  void try_out(std::span<const Box<D, Real>> boxes);
  PairTracker<D, Real>& follower();

  std::unique_ptr<PairFinder<D, Real>> finder_;
  std::vector<Follower<D, Real>> followers_;
  std::unique_ptr<PairTracker<D, Real>> for_few_;  // null: none
  FollowPolicy policy_;
  std::unique_ptr<PairTracker<D, Real>> follower_;  // null: none was needed yet
  std::size_t follower_number_ = 0;

  bool were_few_ = false;      // whether for_few_ has the boxes of the last frame
  bool was_followed_ = false;  // whether the last frame was
  std::size_t changed_ = 0;    // of the last update
  std::vector<Pair> pairs_;    // those of the frame before, if has_pairs_
  std::vector<Pair> found_;
  Parallel parallel_;
  bool has_pairs_ = false;
  std::size_t most_pairs_ = no_limit;
};

}  // namespace broadside::core

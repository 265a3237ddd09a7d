// The tracker of auto: boxes are moved in a structure that stays, or all pairs are found anew, whichever
// costs less in this frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "broadside/pair_finder.hpp"
#include "broadside/pair_tracker.hpp"

namespace broadside::own {

/// How a frame is done.
enum class Way { automatic, rebuild, incremental };

/// A way to follow boxes, and what it costs. One after the other is tried where those before make many tests.
template <int D, typename Real>
struct Follower {
  std::string_view name;
  std::unique_ptr<PairTracker<D, Real>> (*make)();

  /// In nanoseconds of one machine; only their ratios matter.
  double start;         ///< to start, a box
  double mover;         ///< to follow a box that moves, before it was tried
  double mover_alone;   ///< to follow a box that moves, but for its tests
  double test;          ///< each of the first 64 tests of a mover
  double further_test;  ///< and each further one
};

/// Decides by counts alone, of boxes, of changes and of tests, so that the same history always goes the same
/// way. Cost of an update: near the lesser of the two ways', and never much more than finding all pairs anew.
template <int D, typename Real>
class AutoTracker final : public PairTracker<D, Real> {
 public:
  /// All are of the library: what finds all pairs; what may follow boxes that move, one at a time; and what
  /// does all of it where boxes are few, or null for none.
  AutoTracker(std::unique_ptr<PairFinder<D, Real>> finder, std::span<const Follower<D, Real>> followers,
              std::unique_ptr<PairTracker<D, Real>> for_few, Way way);

  std::string explanation() const override;

 private:
  void update_valid(const Change<D, Real>& change, PairSink& begun, PairSink& ended) override;
  void workers_changed() override { finder_->set_workers(this->workers()); }
  std::size_t algorithm_bytes() const noexcept override;

  bool are_few(std::size_t boxes) const;
  bool is_incremental(const Change<D, Real>& change);
  std::size_t cheapest() const;
  void use(std::size_t follower);
  void weigh(std::size_t number);
  void rebuild(const Change<D, Real>& change, PairSink& begun, PairSink& ended);
  void start_following(std::span<const Box<D, Real>> boxes);
  void try_out(std::span<const Box<D, Real>> boxes);
  void follow(const Change<D, Real>& change, PairSink& begun, PairSink& ended);

  std::unique_ptr<PairFinder<D, Real>> finder_;
  std::span<const Follower<D, Real>> followers_;
  std::unique_ptr<PairTracker<D, Real>> follower_;
  std::unique_ptr<PairTracker<D, Real>> for_few_;  // null: none
  Way way_;

  bool were_few_ = false;         // whether for_few_ has the boxes of the last frame
  bool followed_ = false;         // whether the follower has the boxes of the last frame
  std::size_t current_ = 0;       // which of the followers follower_ is
  std::vector<double> of_mover_;  // by follower: the cost of a mover when it was last used, or thought to be
  double cost_of_box_;            // in nanoseconds of one machine; only their ratios matter
  double saved_ = 0;     // what following would have saved since it was last done, or another follower
  double patience_ = 1;  // grows with each change of followers, so that they do not take turns
  std::uint64_t seen_movers_ = 0;  // since the follower was last weighed
  double seen_tests_ = 0;
  double seen_hits_ = 0;
  bool was_incremental_ = false;
  std::size_t changed_ = 0;  // of the last update
  std::size_t break_even_ = 0;

  bool has_pairs_ = false;  // whether pairs_ are those of the last frame
  std::vector<Pair> pairs_;
  std::vector<Pair> found_;
};

}  // namespace broadside::own

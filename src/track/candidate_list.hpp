// CandidateList: the pairs of enlarged boxes, all of which are tested in each frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "broadside/follower.hpp"

#include "core/grow.hpp"
#include "core/margins.hpp"
#include "core/parallel.hpp"
#include "track/follow_or_find.hpp"
#include "track/update_policy.hpp"

namespace broadside::track {

/// A Verlet list (L. Verlet, Phys. Rev. 159, 1967; "fat" boxes in physics engines). An enlarged box changes
/// only when its box leaves it; a FollowOrFind then updates the pairs of enlarged boxes, the candidates. The
/// events are those of the boxes themselves.
///
/// Cost of a frame: a comparison per changed box, a test per candidate, and the cost of FollowOrFind for the
/// boxes that left their enlarged boxes. The numbers of boxes and pairs limit the number of candidates, and
/// of tests to find them; the limit is checked during the search.
template <int D, typename Real>
class CandidateList {
 public:
  /// Margins that suit a sample of the changed boxes; nothing if these moved too far or not at all.
  static std::optional<core::Margins<D, Real>> margins_for(const Change<D, Real>& change);

  /// Enlarges all boxes of a frame whose events have been reported, and finds the candidates. Returns the
  /// number of tests. Throws LimitPassed, and whatever else ends a search. `changes_pairs` is set as soon as
  /// `pairs` no longer knows the boxes themselves.
  std::uint64_t start(const Change<D, Real>& change, const core::Margins<D, Real>& margins,
                      FollowOrFind<D, Real>& pairs, bool& changes_pairs);

  /// Writes the events of a frame. Throws LimitPassed before anything is written.
  Statistics update(const Change<D, Real>& change, FollowOrFind<D, Real>& pairs, PairSink& begun,
                    PairSink& ended);

  /// Counts of the last update.
  const EnlargedFrame& last() const noexcept { return last_; }

  /// Whether there are too many candidates for the pairs that are left.
  bool exceeds_limit() const noexcept { return candidates_.size() > max_candidates(); }

  const core::Margins<D, Real>& margins() const noexcept { return margins_; }
  std::size_t candidate_count() const noexcept { return candidates_.size(); }

  void release() noexcept {
    core::give_back(before_, now_, flags_, candidates_, holds_, held_, begun_, ended_, spare_);
  }

  std::size_t bytes() const noexcept {
    return core::bytes_of(before_, now_, left_, flags_, candidates_, holds_, held_, begun_, ended_, spare_);
  }

 private:
  std::size_t max_candidates() const noexcept;
  Statistics find_candidates(const Change<D, Real>& change, FollowOrFind<D, Real>& pairs);
  void enlarge_anew(const Change<D, Real>& change);
  void change_candidates(PairSink& ended);
  void report(const Change<D, Real>& change, PairSink& begun, PairSink& ended);
  void test_candidates(std::span<const Box<D, Real>> boxes, const Workers& workers);

  core::Margins<D, Real> margins_{};
  EnlargedFrame last_;
  std::vector<Box<D, Real>> before_;  // enlarged boxes of the frame before
  std::vector<Box<D, Real>> now_;
  std::vector<BoxId> left_;          // boxes that left their enlarged boxes, or whose filter changed
  std::vector<std::uint8_t> flags_;  // for each box, 1 if it is in left_; all 0 between updates
  std::vector<Pair> candidates_;     // sorted
  std::vector<std::uint8_t> holds_;  // for each candidate, whether the boxes themselves overlap
  std::vector<std::uint8_t> held_;   // likewise, in the frame before
  std::size_t holding_ = 0;          // candidates that hold
  std::vector<Pair> begun_;          // candidates that began
  std::vector<Pair> ended_;
  std::vector<Pair> spare_;
  core::Parallel parallel_;
};

}  // namespace broadside::track

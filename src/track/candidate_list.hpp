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
#include "track/staggered_margins.hpp"
#include "track/update_policy.hpp"

namespace broadside::track {

/// Where the events of a frame are written.
struct EventSinks {
  PairSink& begun;
  PairSink& ended;
};

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
  /// Enlarges all boxes of a frame, and finds the candidates. If `events` is not null, `pairs` must know the
  /// pairs of the frame before, and the frame's events are written too; this takes no search for the pairs of
  /// the boxes themselves. Returns the number of tests. Throws LimitPassed, and whatever else ends a search.
  /// Afterwards `pairs` must forget the boxes that it knows.
  std::uint64_t start(const Change<D, Real>& change, const core::Margins<D, Real>& margins,
                      FollowOrFind<D, Real>& pairs, const EventSinks* events);

  /// The same in a first frame, and sorts the candidates at once. Sets `holding` to the pairs that hold,
  /// sorted.
  std::optional<Statistics> prepare(const Change<D, Real>& change, const core::Margins<D, Real>& margins,
                                    FollowOrFind<D, Real>& pairs, std::vector<Pair>& holding);

  /// Sets the margins after prepare(), once it is known how boxes move. Drops candidates that smaller margins
  /// do not make.
  void set_margins(const core::Margins<D, Real>& margins);

  /// Writes the events of a frame. Throws LimitPassed before anything is written.
  Statistics update(const Change<D, Real>& change, FollowOrFind<D, Real>& pairs, PairSink& begun,
                    PairSink& ended);

  /// Counts of the last update.
  const EnlargedFrame& last() const noexcept { return last_; }

  /// Whether there are too many candidates for the pairs that are left.
  bool exceeds_limit() const noexcept { return candidates_.size() > max_candidates(); }

  const core::Margins<D, Real>& margins() const noexcept { return margins_.now(); }
  std::size_t candidate_count() const noexcept { return candidates_.size(); }

  void release() noexcept {
    core::give_back(before_, now_, partly_, flags_, candidates_, holds_, toggled_, begun_, ended_, sorting_,
                    places_);
  }

  std::size_t bytes() const noexcept {
    return core::bytes_of(before_, now_, partly_, left_, flags_, candidates_, holds_, begun_, ended_,
                          sorting_, places_) +
           core::bytes_of(toggled_);
  }

 private:
  std::size_t max_candidates() const noexcept;
  void find_all(const Change<D, Real>& change, const core::Margins<D, Real>& margins,
                FollowOrFind<D, Real>& pairs);
  void select_holding(std::vector<Pair>& holding) const;
  Statistics find_candidates(const Change<D, Real>& change, FollowOrFind<D, Real>& pairs);
  std::optional<Statistics> update_pairs(const Change<D, Real>& change, std::span<const Box<D, Real>> now,
                                         FollowOrFind<D, Real>& pairs, PairSink& begun, PairSink& ended);
  Statistics follow_share(const Change<D, Real>& change, FollowOrFind<D, Real>& pairs);
  void keep_left() noexcept;
  void list_left(const Change<D, Real>& change);
  void find_left(const Change<D, Real>& change);
  void review(const Change<D, Real>& change);
  void leave(std::size_t i);
  void change_candidates(PairSink& ended);
  std::size_t place_of(Pair pair, std::size_t from, std::size_t end) const noexcept;
  void report(const Change<D, Real>& change, PairSink& begun, PairSink& ended);
  void sort_all();
  void test_all(std::span<const Box<D, Real>> boxes, const Workers& workers);

  StaggeredMargins<D, Real> margins_;
  bool is_sorted_ = false;
  bool is_followed_ = false;         // whether the FollowOrFind has all enlarged boxes
  std::size_t followed_ = 0;         // the boxes that it has enlarged until then
  bool takes_shares_ = false;        // whether it should get to have all, since margins shrink
  std::optional<Statistics> found_;  // of the search for the first candidates
  EnlargedFrame last_;
  std::vector<Box<D, Real>> before_;  // those that the FollowOrFind has
  std::vector<Box<D, Real>> now_;     // enlarged boxes
  std::vector<Box<D, Real>> partly_;  // before_ with the next share enlarged, until all are
  std::vector<BoxId> left_;           // boxes that left their enlarged boxes, or whose filter changed
  std::vector<std::uint8_t> flags_;   // for each box, 1 if it is in left_; all 0 between updates
  std::vector<Pair> candidates_;      // sorted from the second frame on
  std::vector<std::uint8_t> holds_;   // for each candidate, whether the boxes themselves overlap
  std::vector<std::vector<std::uint32_t>> toggled_;  // by range: the candidates that began or ceased to hold
  std::size_t holding_ = 0;                          // candidates that hold
  std::vector<Pair> begun_;                          // candidates that began
  std::vector<Pair> ended_;
  std::vector<Pair> sorting_;
  std::vector<std::size_t> places_;  // among the candidates, of those that began
  core::Parallel parallel_;
};

}  // namespace broadside::track

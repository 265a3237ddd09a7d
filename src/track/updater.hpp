// Updater: updates the pairs of a tracker in one of four ways, and explains which one.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "broadside/follower.hpp"

#include "core/number_text.hpp"
#include "track/candidate_limit.hpp"
#include "track/candidate_list.hpp"
#include "track/follow_or_find.hpp"
#include "track/staggered_margins.hpp"
#include "track/update_policy.hpp"

namespace broadside::track {

/// Passes boxes to a FollowOrFind. While many boxes move and hardly any moves far, passes enlarged boxes
/// instead, and tests their pairs, the candidates. If there would be too many candidates, it stops enlarging
/// boxes, processes the frame without margins, and releases the memory.
template <int D, typename Real>
class Updater {
 public:
  explicit Updater(TrackerPlan<D> plan)
      : may_enlarge_(may_enlarge(plan)),
        policy_(std::any_of(plan.structures.begin(), plan.structures.end(), compares_all)),
        pairs_(std::move(plan)) {}

  /// Writes the events of a change, in any order. One may be written more than once. After an exception the
  /// next change must be a rebuild.
  std::optional<Statistics> update(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
    if (is_prepared_ && (change.rebuild || !change.changed.empty())) use_prepared(change);
    was_enlarged_ =
        boxes_ == KnownBoxes::enlarged && !change.rebuild && update_enlarged(change, begun, ended);
    if (was_enlarged_) return statistics_;
    if (may_enlarge_ && change.rebuild && prepare(change, begun)) return statistics_;
    const bool may_enlarge = may_enlarge_ && !change.rebuild;
    const bool knows_pairs = pairs_.knows_pairs();
    const EventSinks events{begun, ended};
    if (may_enlarge && knows_pairs && tries(change) && enlarge(change, &events)) return statistics_;
    update_exactly(change, begun, ended);
    if (statistics_) statistics_->tests += std::exchange(tests_in_vain_, 0);
    if (may_enlarge && !knows_pairs && !pairs_.has_compared_all() && tries(change)) enlarge(change, nullptr);
    return statistics_;
  }

  /// In one sentence, which way the last update took and why; empty if there is only one.
  std::string explanation() const {
    if (!was_enlarged_) return pairs_.explanation();
    const EnlargedFrame& frame = candidates_.last();
    return std::to_string(frame.candidates) + " pairs of boxes enlarged by " +
           core::text_of(std::round(1000 * static_cast<double>(candidates_.margins().relative)) / 10) +
           "% of their shortest side were tested, since only " + std::to_string(frame.left) + " of the " +
           std::to_string(frame.changed) + " boxes that changed left their enlarged boxes";
  }

  /// An index of the last frame's boxes, if one is kept anyway; else null. An index of enlarged boxes would
  /// answer queries wrongly.
  const BoxIndex<D, Real>* box_index() const noexcept {
    return boxes_ == KnownBoxes::exact ? pairs_.box_index() : nullptr;
  }

  std::size_t bytes() const noexcept { return pairs_.bytes() + candidates_.bytes(); }

 private:
  static bool compares_all(const FollowerChoice<D>& structure) { return structure.max_boxes > 0; }

  /// Enlarging needs a tracker that may choose and a structure that does not compare all boxes.
  static bool may_enlarge(const TrackerPlan<D>& plan) {
    return plan.update == Update::automatic &&
           !std::all_of(plan.structures.begin(), plan.structures.end(), compares_all);
  }

  /// Returns false if there would be too many candidates. It has then reported no event of this frame, and
  /// the enlarged boxes are gone.
  bool update_enlarged(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
    try {
      statistics_ = candidates_.update(change, pairs_, begun, ended);
    } catch (const LimitPassed&) {
      policy_.limit_passed();
      stop_enlarging();
      return false;
    }
    if (change.changed.empty()) return true;
    // Fewer candidates are allowed once pairs have ended.
    const bool exceeds_limit = candidates_.exceeds_limit();
    if (exceeds_limit) policy_.limit_passed();
    if (exceeds_limit || !policy_.goes_on(candidates_.last())) stop_enlarging();
    return true;
  }

  /// In a first frame, finds candidates by guessed margins, and the frame's pairs among them: a search that
  /// is made anyway. So boxes that tremble or drift from the second frame on need no search at all, which
  /// would take as long as many frames do. Returns false if it has reported nothing.
  bool prepare(const Change<D, Real>& change, PairSink& begun) {
    if (boxes_ != KnownBoxes::exact || !EnlargePolicy::are_many(change.now.size(), change.now.size()) ||
        std::any_of(change.before.begin(), change.before.end(), is_present<D, Real>))
      return false;
    const auto margins = StaggeredMargins<D, Real>::guessed(change.now);
    if (!margins) return false;
    std::vector<Pair> holding;
    try {
      statistics_ = candidates_.prepare(change, *margins, pairs_, holding);
      is_prepared_ = true;
    } catch (const LimitPassed&) {
      tests_in_vain_ = candidates_.candidate_count();  // those found so far
    } catch (const std::bad_alloc&) {
      policy_.out_of_memory();
    }
    if (!is_prepared_) {
      candidates_.release();
      return false;
    }
    begun.put(holding);
    pairs_.start_with(change, std::move(holding), statistics_);
    if (pairs_.compares_all()) drop_prepared();
    return true;
  }

  /// In the frame after prepare(): uses the candidates if many boxes move and hardly any moves far.
  void use_prepared(const Change<D, Real>& change) {
    const bool are_many = EnlargePolicy::are_many(change.now.size(), change.changed.size());
    const auto margins =
        are_many && !change.rebuild ? StaggeredMargins<D, Real>::suiting(change) : std::nullopt;
    if (!margins) return drop_prepared();
    is_prepared_ = false;
    candidates_.set_margins(*margins);
    pairs_.forget_pairs();
    go_on_enlarged();
  }

  void drop_prepared() noexcept {
    is_prepared_ = false;
    candidates_.release();
  }

  void go_on_enlarged() {
    boxes_ = KnownBoxes::enlarged;
    policy_.started();
  }

  void update_exactly(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
    if (boxes_ == KnownBoxes::exact) {
      statistics_ = pairs_.update(change, begun, ended);
      return;
    }
    candidates_.release();
    pairs_.forget();
    pairs_.limit_pairs(no_limit);
    boxes_ = KnownBoxes::exact;
    Change<D, Real> exact = change;
    exact.rebuild = true;
    statistics_ = pairs_.update(exact, begun, ended);
  }

  bool tries(const Change<D, Real>& change) {
    return policy_.tries(change.now.size(), change.changed.size());
  }

  /// Enlarges the boxes if they moved little enough. If `events` is null, the frame was handled in another
  /// way; else its events are written, or the result is false.
  bool enlarge(const Change<D, Real>& change, const EventSinks* events) {
    const auto margins = StaggeredMargins<D, Real>::suiting(change);
    if (!margins) return false;
    Statistics statistics = events == nullptr ? statistics_.value_or(Statistics{}) : Statistics{};
    try {
      statistics.tests += candidates_.start(change, *margins, pairs_, events);
      pairs_.forget();
      go_on_enlarged();
      statistics_ = statistics;
      return true;
    } catch (const LimitPassed&) {
      statistics.tests += candidates_.candidate_count();  // those found so far
      policy_.limit_passed();
    } catch (const std::bad_alloc&) {
      policy_.out_of_memory();
    } catch (...) {  // thrown by a checkpoint or an executor
      policy_.interrupted();
      stop_enlarging();
      throw;
    }
    stop_enlarging();
    if (events == nullptr)
      statistics_ = statistics;
    else
      tests_in_vain_ = statistics.tests;
    return false;
  }

  /// From the next frame on, pairs are those of the boxes themselves.
  void stop_enlarging() noexcept {
    if (boxes_ == KnownBoxes::enlarged) boxes_ = KnownBoxes::ending;
    candidates_.release();
    if (boxes_ == KnownBoxes::ending) pairs_.forget();
  }

  /// The boxes that `pairs_` knows.
  enum class KnownBoxes : std::uint8_t {
    exact,
    enlarged,
    ending  ///< enlarged boxes of earlier frames: it has to be rebuilt
  };

  bool may_enlarge_;
  EnlargePolicy policy_;
  FollowOrFind<D, Real> pairs_;
  CandidateList<D, Real> candidates_;
  KnownBoxes boxes_ = KnownBoxes::exact;
  bool is_prepared_ = false;         // whether the candidates of the last frame are known, and not used yet
  std::uint64_t tests_in_vain_ = 0;  // of a search for candidates that passed a limit
  bool was_enlarged_ = false;        // whether the last update tested candidates
  std::optional<Statistics> statistics_;
};

}  // namespace broadside::track

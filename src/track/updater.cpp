// Updater.
#include "track/updater.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include "core/lean.hpp"
#include "core/number_text.hpp"
#include "track/candidate_limit.hpp"

namespace broadside::track {
namespace {

template <int D>
bool may_compare_all(const TrackerPlan<D>& plan) {
  return std::ranges::any_of(plan.structures, [](const auto& one) { return one.costs.compares_all(); });
}

}  // namespace

template <int D, typename Real>
Updater<D, Real>::Updater(TrackerPlan<D> plan)
    : may_enlarge_(plan.may_enlarge()), policy_(may_compare_all(plan)), pairs_(std::move(plan)) {}

template <int D, typename Real>
std::optional<Statistics> Updater<D, Real>::update(const Change<D, Real>& change, PairSink& begun,
                                                   PairSink& ended) {
  // Lean builds, which are to be small, do not enlarge boxes.
  if constexpr (core::is_lean) return pairs_.update(change, begun, ended);
  was_enlarged_ = boxes_ == Boxes::enlarged && !change.rebuild && update_enlarged(change, begun, ended);
  if (was_enlarged_) return statistics_;
  update_exactly(change, begun, ended);
  if (may_enlarge_ && !change.rebuild && !pairs_.has_compared_all() &&
      policy_.tries(change.now.size(), change.changed.size()))
    enlarge(change);
  return statistics_;
}

template <int D, typename Real>
void Updater<D, Real>::update_exactly(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
  if (boxes_ == Boxes::exact) {
    statistics_ = pairs_.update(change, begun, ended);
    return;
  }
  candidates_.release();
  pairs_.forget();
  pairs_.limit_pairs(no_limit);
  boxes_ = Boxes::exact;
  Change<D, Real> exact = change;
  exact.rebuild = true;
  statistics_ = pairs_.update(exact, begun, ended);
}

/// Enlarges the boxes after a frame that was handled otherwise, if they moved little enough.
template <int D, typename Real>
void Updater<D, Real>::enlarge(const Change<D, Real>& change) {
  const auto margins = CandidateList<D, Real>::margins_for(change);
  if (!margins) return;
  Statistics statistics = statistics_.value_or(Statistics{});
  bool changes_pairs = false;
  const auto give_up = [&] {
    if (changes_pairs) boxes_ = Boxes::ending;
    stop_enlarging();
  };
  try {
    statistics.tests += candidates_.start(change, *margins, pairs_, changes_pairs);
    boxes_ = Boxes::enlarged;
    policy_.started();
  } catch (const LimitPassed&) {
    statistics.tests += candidates_.candidate_count();  // those that are known
    policy_.limit_passed();
    give_up();
  } catch (const std::bad_alloc&) {
    // The frame itself is whole.
    policy_.out_of_memory();
    give_up();
  } catch (...) {  // thrown by a checkpoint or an executor
    policy_.interrupted();
    give_up();
    throw;
  }
  statistics_ = statistics;
}

/// Returns false if there would be too many candidates. It has then reported no event of this frame, and the
/// enlarged boxes are gone.
template <int D, typename Real>
bool Updater<D, Real>::update_enlarged(const Change<D, Real>& change, PairSink& begun, PairSink& ended) {
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

/// From the next frame on, pairs are those of the boxes themselves.
template <int D, typename Real>
void Updater<D, Real>::stop_enlarging() noexcept {
  if (boxes_ == Boxes::enlarged) boxes_ = Boxes::ending;
  candidates_.release();
  if (boxes_ == Boxes::ending) pairs_.forget();
}

template <int D, typename Real>
std::string Updater<D, Real>::explanation() const {
  if (!was_enlarged_) return pairs_.explanation();
  const EnlargedFrame& frame = candidates_.last();
  return std::to_string(frame.candidates) + " pairs of boxes enlarged by " +
         core::text_of(std::round(1000 * static_cast<double>(candidates_.margins().relative)) / 10) +
         " % of their shortest side were tested, since only " + std::to_string(frame.left) + " of the " +
         std::to_string(frame.changed) + " boxes that changed left their enlarged ones";
}

template class Updater<2, float>;
template class Updater<3, float>;
template class Updater<2, double>;
template class Updater<3, double>;

}  // namespace broadside::track

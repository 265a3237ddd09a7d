// Tracker::State: what every tracker does around bringing its pairs up to date.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "broadside/tracker.hpp"

#include "core/parallel.hpp"
#include "track/frame_states.hpp"
#include "track/ignored_change.hpp"
#include "track/updater.hpp"

namespace broadside {

template <int D, typename Real>
class BROADSIDE_HIDDEN Tracker<D, Real>::State {
 public:
  State(track::TrackerPlan<D> plan, std::size_t threads)
      : workers{.threads = threads}, updater_(std::move(plan)) {}

  /// Throws if anything is wrong with the frame.
  void check(const Frame<D, Real>& frame) const;

  /// Takes a frame. `lists_once`: each changed box is listed once, and is valid or absent.
  std::optional<Statistics> update(const Frame<D, Real>& frame, bool lists_once, PairSink& begun,
                                   PairSink& ended);

  Frame<D, Real> last_frame() const noexcept;
  std::span<const BoxId> quarantined() const noexcept { return frames_.quarantined(); }
  const BoxIndex<D, Real>* box_index() const noexcept { return is_dirty_ ? nullptr : updater_.box_index(); }
  std::string explanation() const { return updater_.explanation(); }
  std::size_t bytes() const noexcept;

  BadInput bad_input = BadInput::reject;
  Workers workers;

 private:
  void find_events(const Change<D, Real>& change);
  void deliver(PairSink& begun, PairSink& ended);

  track::FrameStates<D, Real> frames_;
  track::IgnoredChange ignored_;
  track::Updater<D, Real> updater_;
  std::optional<Statistics> statistics_;
  std::vector<Pair> begun_;
  std::vector<Pair> ended_;
  std::vector<Pair> sorting_;
  core::Parallel parallel_;
  bool is_dirty_ = true;  // the last update did not end, or there was none
};

}  // namespace broadside

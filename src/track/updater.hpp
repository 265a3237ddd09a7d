// Updater: brings the pairs of a tracker up to date in one of four ways, and says in which.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "broadside/follower.hpp"

#include "track/candidate_list.hpp"
#include "track/follow_or_find.hpp"
#include "track/update_policy.hpp"

namespace broadside::track {

/// Lets a FollowOrFind handle the boxes; while many of them move and hardly any far, lets it handle enlarged
/// boxes instead, and tests the candidates. If there would be too many of these, boxes are no longer
/// enlarged, the frame is processed without margins, and the memory is released.
template <int D, typename Real>
class Updater {
 public:
  explicit Updater(TrackerPlan<D> plan);

  /// Writes the events of a change, in any order. One may be written more than once. After an exception the
  /// next change must be a rebuild.
  std::optional<Statistics> update(const Change<D, Real>& change, PairSink& begun, PairSink& ended);

  /// Which way the last update went and why, in a sentence; empty where there is one way.
  std::string explanation() const;

  /// An index of the last frame's boxes, where one is kept anyway; or null. One over enlarged boxes would
  /// answer queries wrongly.
  const BoxIndex<D, Real>* box_index() const noexcept {
    return boxes_ == Boxes::exact ? pairs_.box_index() : nullptr;
  }

  std::size_t bytes() const noexcept { return pairs_.bytes() + candidates_.bytes(); }

 private:
  bool update_enlarged(const Change<D, Real>& change, PairSink& begun, PairSink& ended);
  void update_exactly(const Change<D, Real>& change, PairSink& begun, PairSink& ended);
  void enlarge(const Change<D, Real>& change);
  void stop_enlarging() noexcept;

  /// The boxes that `pairs_` knows.
  enum class Boxes : std::uint8_t {
    exact,
    enlarged,
    ending  ///< enlarged ones of former frames: it has to be rebuilt
  };

  bool may_enlarge_;
  EnlargePolicy policy_;
  FollowOrFind<D, Real> pairs_;
  CandidateList<D, Real> candidates_;
  Boxes boxes_ = Boxes::exact;
  bool was_enlarged_ = false;  // whether the last update tested candidates
  std::optional<Statistics> statistics_;
};

}  // namespace broadside::track

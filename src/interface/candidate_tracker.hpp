// CandidateTracker: a tracker that may also say only which pairs have to be looked at.
#pragma once

#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

namespace broadside::core {

/// A tracker of floats derives from this too where callers can judge its pairs by more than these boxes.
template <int D>
class CandidateTracker {
 public:
  CandidateTracker() = default;
  CandidateTracker(const CandidateTracker&) = delete;
  CandidateTracker& operator=(const CandidateTracker&) = delete;
  virtual ~CandidateTracker() = default;

  /// As an update, but writes the pair of each changed box with every other one that overlaps where it was or
  /// where it is, perhaps more than once.
  virtual Statistics candidates(const Change<D>& change, PairSink& pairs) = 0;
};

}  // namespace broadside::core

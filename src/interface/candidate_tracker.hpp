// CandidateTracker: a tracker that may also say only which pairs have to be looked at.
#pragma once

#include <cstddef>

#include "broadside/finder.hpp"
#include "broadside/tracker.hpp"

namespace broadside::core {

template <int D>
class CandidateTracker : public PairTracker<D> {
 public:
  /// As an update, but writes the pair of each changed box with every other one that overlaps where it was or
  /// where it is, perhaps more than once: for callers that judge pairs by more than these boxes.
  virtual Statistics candidates(const Change<D>& change, PairSink& pairs) = 0;

  /// The bytes that it keeps.
  virtual std::size_t kept_bytes() const noexcept = 0;
};

}  // namespace broadside::core

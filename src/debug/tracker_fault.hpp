// What a tracker reports wrongly, by the definition, and the smallest history in which it does.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "broadside/debug/history.hpp"
#include "broadside/tracker.hpp"

namespace broadside::core {

/// The pairs that began and those that ended, each sorted.
struct EventPairs {
  std::vector<Pair> begun;
  std::vector<Pair> ended;

  friend bool operator==(const EventPairs&, const EventPairs&) = default;
};

/// A pair that was reported wrongly.
struct Fault {
  Pair pair;
  bool began;     ///< as one that began; else as one that ended
  bool reported;  ///< although it did not; else not, although it did
};

/// Such as "reported that the pair (1, 2) began".
std::string text_of(const Fault& fault);

/// The events that lead from the pairs of one frame to those of the next, both sorted.
EventPairs events_between(const std::vector<Pair>& before, const std::vector<Pair>& now);

/// The first pair whose events are not those expected.
std::optional<Fault> fault_of(const EventPairs& events, const EventPairs& expected) noexcept;

/// What a tracker does wrong in a history's last frame. If it throws, that is another failure, and none here.
template <int D, typename Real>
std::optional<Fault> fault_at_the_end(Tracker<D, Real>& tracker, const History<D, Real>& history);

/// The smallest history found in whose last frame what `make` makes is at fault; empty if it is not on this
/// one. Compares about that many pairs of boxes, and no clock is asked: another machine finds the same one.
template <int D, typename Real>
std::optional<History<D, Real>> smallest_fault(History<D, Real> history,
                                               const std::function<Tracker<D, Real>()>& make,
                                               std::uint64_t max_tests);

}  // namespace broadside::core

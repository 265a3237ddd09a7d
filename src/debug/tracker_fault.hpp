// The pairs of a frame by the definition, faults of a tracker, and the smallest history that shows a fault.
#pragma once

#include <algorithm>
#include <cstdint>
#include <exception>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "broadside/debug/history.hpp"
#include "broadside/debug/minimise.hpp"
#include "broadside/sinks.hpp"
#include "broadside/tracker.hpp"

namespace broadside::debug {

using Pairs = std::vector<Pair>;

/// Every pair of present boxes that overlap, accept each other and are not ignored; sorted. n^2 / 2 tests.
template <int D, typename Real>
Pairs pairs_by_definition(const Frame<D, Real>& frame) {
  Pairs pairs;
  const std::span<const Box<D, Real>> boxes = frame.boxes;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!is_present(boxes[i])) continue;
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      if (!overlap(boxes[i], boxes[j]) || !is_present(boxes[j])) continue;
      if (!frame.filters.empty() && !accepts(frame.filters[i], frame.filters[j])) continue;
      const Pair pair{BoxId(i), BoxId(j)};
      if (frame.ignored == nullptr || !frame.ignored->contains(pair)) pairs.push_back(pair);
    }
  }
  return pairs;
}

/// The pairs that began and those that ended, each sorted.
struct EventPairs {
  Pairs begun;
  Pairs ended;

  friend bool operator==(const EventPairs&, const EventPairs&) = default;
};

/// Passes a frame to a tracker, and sets `events` to what it reports.
template <int D, typename Real>
void take_events(Tracker<D, Real>& tracker, const Frame<D, Real>& frame, EventPairs& events) {
  events = {};
  PairCollector begun(events.begun);
  PairCollector ended(events.ended);
  tracker.update(frame, begun, ended);
}

/// A pair that was reported wrongly.
struct WrongEvent {
  Pair pair;
  bool began;     ///< whether the event is a beginning; else an end
  bool reported;  ///< reported but did not happen; else happened but was not reported
};

/// Such as "(1, 2)", and "reported that the pair (1, 2) began".
inline std::string text_of(Pair pair) {
  return "(" + std::to_string(index(pair.first)) + ", " + std::to_string(index(pair.second)) + ")";
}

inline std::string text_of(const WrongEvent& fault) {
  return std::string(fault.reported ? "reported" : "did not report") + " that the pair " +
         text_of(fault.pair) + (fault.began ? " began" : " ended");
}

inline Pairs without(const Pairs& pairs, const Pairs& some) {
  Pairs rest;
  std::set_difference(pairs.begin(), pairs.end(), some.begin(), some.end(), std::back_inserter(rest));
  return rest;
}

/// The events that lead from the pairs of one frame to those of the next, both sorted.
inline EventPairs events_between(const Pairs& before, const Pairs& now) {
  return {without(now, before), without(before, now)};
}

/// The first event that was reported wrongly or twice, or was not reported.
inline std::optional<WrongEvent> first_fault(const Pairs& reported, const Pairs& happened,
                                             bool began) noexcept {
  const auto [found, expected] =
      std::mismatch(reported.begin(), reported.end(), happened.begin(), happened.end());
  if (found == reported.end() && expected == happened.end()) return std::nullopt;
  const bool is_reported = expected == happened.end() || (found != reported.end() && *found < *expected);
  return WrongEvent{is_reported ? *found : *expected, began, is_reported};
}

/// The first pair whose events are not those expected.
inline std::optional<WrongEvent> fault_of(const EventPairs& events, const EventPairs& expected) noexcept {
  const auto began = first_fault(events.begun, expected.begun, true);
  const auto ended = first_fault(events.ended, expected.ended, false);
  if (began && ended) return began->pair <= ended->pair ? began : ended;
  return began ? began : ended;
}

/// The fault of a tracker in a history's last frame. An exception is another failure, and none here.
template <int D, typename Real>
std::optional<WrongEvent> fault_at_the_end(Tracker<D, Real>& tracker, const History<D, Real>& history) {
  try {
    Replay<D, Real> replay(history);
    Pairs held;
    EventPairs events;
    take_events(tracker, replay.frame(), events);
    for (const Step<D, Real>& step : history.steps) {
      const Pairs still = without(held, events.ended);
      held.clear();
      std::set_union(still.begin(), still.end(), events.begun.begin(), events.begun.end(),
                     std::back_inserter(held));
      take_events(tracker, replay.next(step), events);
    }
    return fault_of(events, events_between(held, pairs_by_definition(replay.frame())));
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

/// The smallest history found in whose last frame a tracker from `make` is at fault; empty if none is on
/// `history`. Stops after about `max_tests` tests, not after a time: all machines find the same history.
template <int D, typename Real>
std::optional<History<D, Real>> smallest_fault(History<D, Real> history,
                                               const std::function<Tracker<D, Real>()>& make,
                                               std::uint64_t max_tests) {
  std::uint64_t tests = 0;
  const auto fails = [&](const History<D, Real>& some) {
    std::uint64_t changes = some.boxes.size();
    for (const Step<D, Real>& step : some.steps) changes += step.changed.size();
    const std::uint64_t places = places_of(some);
    // The tracker's own tests are unknown; assumes a hundred per change.
    tests += places * places / 2 + 100 * changes;
    Tracker<D, Real> tracker = make();
    return fault_at_the_end(tracker, some).has_value();
  };
  Replay<D, Real> replay(history);
  for (const Step<D, Real>& step : history.steps) replay.next(step);
  History<D, Real> alone = history_of(replay.frame());
  if (fails(alone))
    history = std::move(alone);
  else if (!fails(history))
    return std::nullopt;
  minimise(history, fails, [&] { return tests > max_tests; });
  return history;
}

}  // namespace broadside::debug

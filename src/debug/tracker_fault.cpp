// What a tracker reports wrongly, by the definition, and the smallest history in which it does.
#include "debug/tracker_fault.hpp"

#include <algorithm>
#include <exception>
#include <iterator>
#include <utility>

#include "broadside/debug/minimise.hpp"
#include "broadside/sinks.hpp"

#include "debug/definition.hpp"

namespace broadside::core {
namespace {

using Pairs = std::vector<Pair>;

Pairs without(const Pairs& pairs, const Pairs& some) {
  Pairs rest;
  std::ranges::set_difference(pairs, some, std::back_inserter(rest));
  return rest;
}

/// The first event that was reported and did not happen, or the other way round, or was reported twice.
std::optional<Fault> first_fault(const Pairs& reported, const Pairs& happened, bool began) noexcept {
  const auto [found, expected] = std::ranges::mismatch(reported, happened);
  if (found == reported.end() && expected == happened.end()) return std::nullopt;
  const bool is_reported = expected == happened.end() || (found != reported.end() && *found < *expected);
  return Fault{is_reported ? *found : *expected, began, is_reported};
}

/// Has a tracker take a frame, and sets `events` to what it reports.
template <int D, typename Real>
void take_events(Tracker<D, Real>& tracker, const Frame<D, Real>& frame, EventPairs& events) {
  events = {};
  PairCollector begun(events.begun);
  PairCollector ended(events.ended);
  tracker.update(frame, begun, ended);
}

}  // namespace

std::string text_of(const Fault& fault) {
  return std::string(fault.reported ? "reported" : "did not report") + " that the pair (" +
         std::to_string(index(fault.pair.first)) + ", " + std::to_string(index(fault.pair.second)) + ") " +
         (fault.began ? "began" : "ended");
}

EventPairs events_between(const Pairs& before, const Pairs& now) {
  return {without(now, before), without(before, now)};
}

std::optional<Fault> fault_of(const EventPairs& events, const EventPairs& expected) noexcept {
  const auto began = first_fault(events.begun, expected.begun, true);
  const auto ended = first_fault(events.ended, expected.ended, false);
  if (began && ended) return began->pair <= ended->pair ? began : ended;
  return began ? began : ended;
}

template <int D, typename Real>
std::optional<Fault> fault_at_the_end(Tracker<D, Real>& tracker, const History<D, Real>& history) {
  try {
    Replay<D, Real> replay(history);
    Pairs held;
    EventPairs events;
    take_events(tracker, replay.frame(), events);
    for (const Step<D, Real>& step : history.steps) {
      const Pairs still = without(held, events.ended);
      held.clear();
      std::ranges::set_union(still, events.begun, std::back_inserter(held));
      take_events(tracker, replay.next(step), events);
    }
    return fault_of(events, events_between(held, pairs_by_definition(replay.frame())));
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

template <int D, typename Real>
std::optional<History<D, Real>> smallest_fault(History<D, Real> history,
                                               const std::function<Tracker<D, Real>()>& make,
                                               std::uint64_t max_tests) {
  std::uint64_t tests = 0;
  const auto fails = [&](const History<D, Real>& some) {
    std::uint64_t changes = some.boxes.size();
    for (const Step<D, Real>& step : some.steps) changes += step.changed.size();
    const std::uint64_t places = places_of(some);
    // What a tracker does is not known: as if it took a hundred tests a change.
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

template std::optional<Fault> fault_at_the_end(Tracker<2>&, const History<2>&);
template std::optional<Fault> fault_at_the_end(Tracker<3>&, const History<3>&);
template std::optional<Fault> fault_at_the_end(Tracker<2, double>&, const History<2, double>&);
template std::optional<Fault> fault_at_the_end(Tracker<3, double>&, const History<3, double>&);
template std::optional<History<2>> smallest_fault(History<2>, const std::function<Tracker<2>()>&,
                                                  std::uint64_t);
template std::optional<History<3>> smallest_fault(History<3>, const std::function<Tracker<3>()>&,
                                                  std::uint64_t);
template std::optional<History<2, double>> smallest_fault(History<2, double>,
                                                          const std::function<Tracker<2, double>()>&,
                                                          std::uint64_t);
template std::optional<History<3, double>> smallest_fault(History<3, double>,
                                                          const std::function<Tracker<3, double>()>&,
                                                          std::uint64_t);

}  // namespace broadside::core

// The events that a history must give, frame by frame, and their hash.
#include "lab/measure/expected_events.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "broadside/sinks.hpp"

namespace broadside::lab {
namespace {

std::vector<Pair> without(std::span<const Pair> pairs, std::span<const Pair> others) {
  std::vector<Pair> rest;
  std::ranges::set_difference(pairs, others, std::back_inserter(rest));
  return rest;
}

/// Calls `visit` with the boxes of each frame and what changed.
template <int D, typename Real, typename Visit>
void replay(const History<D, Real>& history, const Visit& visit) {
  std::vector<Box<D, Real>> boxes = history.boxes;
  visit(Frame<D, Real>{boxes, {}});
  for (const Step<D, Real>& step : history.steps) {
    apply(step, boxes);
    visit(Frame<D, Real>{boxes, step.changed});
  }
}

template <int D, typename Real>
ExpectedEvents events_by_definition(const History<D, Real>& history) {
  ExpectedEvents expected;
  std::vector<Pair> before;
  replay(history, [&](const Frame<D, Real>& frame) {
    std::vector<Pair> now = reference_pairs<D, Real>(frame.boxes);
    expected.frames.push_back({without(now, before), without(before, now)});
    before = std::move(now);
  });
  return expected;
}

}  // namespace

template <int D, typename Real>
ExpectedEvents expected_events(const Reference& reference, const History<D, Real>& history) {
  if (reference.is_definition()) return events_by_definition(history);
  ExpectedEvents expected;
  DiffTracker<D, Real> tracker(reference.finder<D, Real>());
  std::vector<Pair> pairs;
  std::vector<Box<D, Real>> last;
  replay(history, [&](const Frame<D, Real>& frame) {
    Events events;
    PairCollector begun(events.begun);
    PairCollector ended(events.ended);
    tracker.update(frame, begun, ended);
    const std::vector<Pair> rest = without(pairs, events.ended);
    pairs.clear();
    std::ranges::merge(rest, events.begun, std::back_inserter(pairs));
    expected.frames.push_back(std::move(events));
    if (expected.frames.size() == history.steps.size() + 1)
      last.assign(frame.boxes.begin(), frame.boxes.end());
  });
  if (auto divergence = check_sample<D, Real>(last, pairs)) {
    expected.fault =
        explained<D, Real>(*std::move(divergence), reference.text(), "reference:", history.steps.size(), last)
            .text;
  }
  return expected;
}

void EventHasher::add(const Events& events) noexcept {
  // One step of a polynomial a list: the place in the history counts, the order in the list does not.
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15U;
  hash_ = (hash_ + hash_of(events.begun)) * odd + 1;
  hash_ = (hash_ + hash_of(events.ended)) * odd + 1;
}

template <int D, typename Real>
std::string difference(const Events& found, const Events& expected, std::string_view name, std::size_t frame,
                       BoxSpan<D, Real> boxes) {
  if (found == expected) return {};
  const bool begun_differs = found.begun != expected.begun;
  const std::vector<Pair>& list = begun_differs ? found.begun : found.ended;
  auto divergence = compare_pairs(list, begun_differs ? expected.begun : expected.ended);
  if (!divergence) {
    const Pair unsorted = *std::ranges::is_sorted_until(list);
    divergence = Divergence{Divergence::Kind::extra, unsorted, frame, "events are not sorted by id"};
  }
  return explained<D, Real>(*std::move(divergence), name, begun_differs ? "begun:" : "ended:", frame, boxes)
      .text;
}

template ExpectedEvents expected_events(const Reference&, const History<2>&);
template ExpectedEvents expected_events(const Reference&, const History<3>&);
template ExpectedEvents expected_events(const Reference&, const History<2, double>&);
template ExpectedEvents expected_events(const Reference&, const History<3, double>&);
template std::string difference<2, float>(const Events&, const Events&, std::string_view, std::size_t,
                                          BoxSpan<2, float>);
template std::string difference<3, float>(const Events&, const Events&, std::string_view, std::size_t,
                                          BoxSpan<3, float>);
template std::string difference<2, double>(const Events&, const Events&, std::string_view, std::size_t,
                                           BoxSpan<2, double>);
template std::string difference<3, double>(const Events&, const Events&, std::string_view, std::size_t,
                                           BoxSpan<3, double>);

}  // namespace broadside::lab

// The expected events of a history, frame by frame, and their hash.
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

/// Calls `visit` with the boxes of each frame and the places that changed.
template <int D, typename Real, typename Visit>
void replay(const History<D, Real>& history, const Visit& visit) {
  std::vector<Box<D, Real>> boxes = history.boxes;
  visit(Frame<D, Real>{boxes, {}});
  for (const Step<D, Real>& step : history.steps) {
    apply(step, boxes);
    visit(Frame<D, Real>{boxes, step.changed});
  }
}

/// Marks the places below `size` that may differ from the previous frame, which had `before` boxes.
template <int D, typename Real>
std::vector<bool> changes_of(const Frame<D, Real>& frame, std::size_t before) {
  std::vector<bool> changes(std::max(frame.boxes.size(), before), false);
  for (const BoxId id : frame.changed) changes[index(id)] = true;
  // Boxes that are new, or were removed at the array's end, need not be listed.
  for (std::size_t i = std::min(frame.boxes.size(), before); i < changes.size(); ++i) changes[i] = true;
  return changes;
}

/// The pairs of a frame by brute force, given those of the previous frame: the overlap of two unchanged boxes
/// is unchanged, so only changed boxes are tested, each against all.
template <int D, typename Real>
std::vector<Pair> pairs_after(const Frame<D, Real>& frame, std::size_t boxes_before,
                              std::span<const Pair> before) {
  const std::vector<bool> changes = changes_of(frame, boxes_before);
  std::vector<std::size_t> changed;
  for (std::size_t i = 0; i < frame.boxes.size(); ++i) {
    if (changes[i]) changed.push_back(i);
  }
  if (2 * changed.size() >= frame.boxes.size()) return reference_pairs<D, Real>(frame.boxes);
  std::vector<Pair> stayed;
  std::ranges::copy_if(before, std::back_inserter(stayed), [&](Pair pair) {
    return !changes[index(pair.first)] && !changes[index(pair.second)];
  });
  std::vector<Pair> now;
  std::ranges::merge(stayed, reference_pairs_of<D, Real>(frame.boxes, changed), std::back_inserter(now));
  return now;
}

template <int D, typename Real>
ExpectedEvents events_by_definition(const History<D, Real>& history) {
  ExpectedEvents expected;
  std::vector<Pair> before;
  std::size_t boxes_before = 0;
  replay(history, [&](const Frame<D, Real>& frame) {
    std::vector<Pair> now = pairs_after(frame, boxes_before, before);
    expected.frames.push_back({without(now, before), without(before, now)});
    before = std::move(now);
    boxes_before = frame.boxes.size();
  });
  return expected;
}

}  // namespace

template <int D, typename Real>
double tests_by_definition(const History<D, Real>& history) {
  double tests = 0;
  std::size_t before = 0;
  replay(history, [&](const Frame<D, Real>& frame) {
    const auto boxes = static_cast<double>(frame.boxes.size());
    const auto changed = static_cast<double>(std::ranges::count(changes_of(frame, before), true));
    tests += std::min(changed, boxes / 2) * boxes;
    before = frame.boxes.size();
  });
  return tests;
}

template <int D, typename Real>
ExpectedEvents expected_events(const Reference& reference, const History<D, Real>& history,
                               const std::function<void()>& asks) {
  if (reference.is_definition()) return events_by_definition(history);
  ExpectedEvents expected;
  std::vector<Pair> pairs;
  replay(history, [&](const Frame<D, Real>& frame) {
    const std::vector<Pair> before = std::exchange(pairs, reference.pairs<D, Real>(frame.boxes, asks));
    const std::size_t number = expected.frames.size();
    expected.frames.push_back({without(pairs, before), without(before, pairs)});
    // Samples different boxes in each frame.
    auto divergence =
        expected.fault.empty() ? check_sample<D, Real>(frame.boxes, pairs, number + 1) : std::nullopt;
    if (divergence) {
      expected.fault =
          explained<D, Real>(*std::move(divergence), reference.text(), "reference:", number, frame.boxes)
              .text;
    }
  });
  return expected;
}

void EventHasher::add(const FrameEvents& events) noexcept {
  // One step of a polynomial per list: the hash depends on the position in the history, but not on the order
  // within a list.
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15U;
  hash_ = (hash_ + hash_of(events.begun)) * odd + 1;
  hash_ = (hash_ + hash_of(events.ended)) * odd + 1;
}

template <int D, typename Real>
std::string difference(const FrameEvents& found, const FrameEvents& expected, std::string_view name,
                       std::size_t frame, BoxSpan<D, Real> boxes) {
  if (found == expected) return {};
  const bool begun_differs = found.begun != expected.begun;
  const std::vector<Pair>& list = begun_differs ? found.begun : found.ended;
  auto divergence = compare_pairs(list, begun_differs ? expected.begun : expected.ended);
  if (!divergence) {
    const Pair unsorted = *std::ranges::is_sorted_until(list);
    divergence = PairDivergence{PairDivergence::Kind::extra, unsorted, frame, "events are not sorted by id"};
  }
  return explained<D, Real>(*std::move(divergence), name, begun_differs ? "begun:" : "ended:", frame, boxes)
      .text;
}

template double tests_by_definition(const History<2>&);
template double tests_by_definition(const History<3>&);
template double tests_by_definition(const History<2, double>&);
template double tests_by_definition(const History<3, double>&);
template ExpectedEvents expected_events(const Reference&, const History<2>&, const std::function<void()>&);
template ExpectedEvents expected_events(const Reference&, const History<3>&, const std::function<void()>&);
template ExpectedEvents expected_events(const Reference&, const History<2, double>&,
                                        const std::function<void()>&);
template ExpectedEvents expected_events(const Reference&, const History<3, double>&,
                                        const std::function<void()>&);
template std::string difference<2, float>(const FrameEvents&, const FrameEvents&, std::string_view,
                                          std::size_t, BoxSpan<2, float>);
template std::string difference<3, float>(const FrameEvents&, const FrameEvents&, std::string_view,
                                          std::size_t, BoxSpan<3, float>);
template std::string difference<2, double>(const FrameEvents&, const FrameEvents&, std::string_view,
                                           std::size_t, BoxSpan<2, double>);
template std::string difference<3, double>(const FrameEvents&, const FrameEvents&, std::string_view,
                                           std::size_t, BoxSpan<3, double>);

}  // namespace broadside::lab

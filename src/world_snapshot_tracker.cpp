// World: the way from what its tracker knows to what the tracker of a snapshot knew.
#include <algorithm>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "broadside/sinks.hpp"
#include "broadside/world.hpp"

#include "core/snapshot_check.hpp"
#include "world_state.hpp"

namespace broadside {
namespace {

using core::difference;
using core::expect;
using Pairs = std::vector<Pair>;

}  // namespace

template <int D, typename Real>
Frame<D, Real> World<D, Real>::State::LastFrame::frame() const noexcept {
  return {boxes, {}, filters, has_ignored ? &ignored : nullptr, {}};
}

/// Whether it can tell the pairs that its tracker has found.
template <int D, typename Real>
bool World<D, Real>::State::knows_candidates() const noexcept {
  return is_refining || options.keep_pairs;
}

/// Those pairs, sorted.
template <int D, typename Real>
std::vector<Pair> World<D, Real>::State::known_candidates() const {
  Pairs pairs;
  if (is_refining) {
    pairs = graph_pairs([](const core::PairGraph::Mark&) { return true; });
  } else {
    const std::lock_guard lock(reading);
    current.merge(generations);
    is_current = true;
    for (const HandlePair& pair : current.pairs())
      pairs.push_back({BoxId{pair.first.slot}, BoxId{pair.second.slot}});
  }
  return difference(difference(pairs, candidates.begun), candidates.ended);
}

/// Hands the tracker a frame in which only what differs from its last one is listed. Returns the events: the
/// pairs that hold in one of the two, sorted.
template <int D, typename Real>
std::vector<Pair> World<D, Real>::State::lead(PairTracker<D, Real>& tracker, const LastFrame& to) {
  const Frame<D, Real> from = tracker.last_frame();
  Frame<D, Real> frame = to.frame();
  std::vector<BoxId> places;
  for (std::uint32_t i = 0; i < std::min(from.boxes.size(), frame.boxes.size()); ++i) {
    const bool filters_differ =
        !from.filters.empty() && !frame.filters.empty() && from.filters[i] != frame.filters[i];
    if (from.boxes[i] != frame.boxes[i] || filters_differ) places.push_back(BoxId{i});
  }
  frame.changed = places;
  Pairs toggled;
  const auto add_missing = [&toggled](const IgnoredPairs* set, const IgnoredPairs* other) {
    if (set == nullptr || other == nullptr) return;
    set->for_each([&](Pair pair) {
      if (!other->contains(pair)) toggled.push_back(pair);
    });
  };
  add_missing(from.ignored, frame.ignored);
  add_missing(frame.ignored, from.ignored);
  frame.ignored_changed = toggled;
  Pairs begun_pairs;
  Pairs ended_pairs;
  PairCollector begun_sink(begun_pairs);
  PairCollector ended_sink(ended_pairs);
  tracker.update(frame, begun_sink, ended_sink);
  return difference(begun_pairs, ended_pairs);
}

/// Takes over the other world's tracker and leads it to the frame that this one's had taken last, or leaves
/// it as it is and throws.
template <int D, typename Real>
void World<D, Real>::State::take_tracker(State& other, const LastFrame& last) {
  const auto check = [&](const Pairs& pairs) {
    expect(!knows_candidates() || known_candidates() == pairs, "its pairs are not those of its boxes");
  };
  if (is_own_tracker && options.algorithm != other.options.algorithm) {
    std::unique_ptr<PairTracker<D, Real>> made = make_own_tracker(options);
    made->set_workers(other.tracker->workers());
    check(lead(*made, last));
    tracker = std::move(made);
    return;
  }
  const Frame<D, Real> was = other.tracker->last_frame();
  LastFrame before;
  before.boxes.assign(was.boxes.begin(), was.boxes.end());
  before.filters.assign(was.filters.begin(), was.filters.end());
  before.has_ignored = was.ignored != nullptr;
  if (before.has_ignored) before.ignored = *was.ignored;
  try {
    Pairs known;
    if (other.knows_candidates())
      known = other.known_candidates();
    else
      lead(*other.tracker, LastFrame{});
    check(difference(known, lead(*other.tracker, last)));
  } catch (...) {
    lead(*other.tracker, before);
    throw;
  }
  tracker = std::move(other.tracker);
}

template class World<2, float>;
template class World<2, double>;
template class World<3, float>;
template class World<3, double>;

}  // namespace broadside
